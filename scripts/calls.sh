#!/bin/sh
# Checks that calls go one way, by the symbols of a build's object files: a file of src calls functions
# (and reads data) of its own folder and of folders that scripts/layers.txt names for it, and no files
# of one folder call each other in a circle. Prints each call that does not, and each circle.
#   scripts/calls.sh LIST...
# A LIST is a text file that names object files, one a line. The path of an object ends in the path of
# its source, as in .../src/image/map.c.o; where there is no src/ in it, in the target's folder.
set -eu
table=$(dirname "$0")/layers.txt
# shellcheck disable=SC2016 # the dollars are awk's
found=$(
    cat "$@" | tr '\n' '\0' | xargs -0 nm -P -A | awk -v table="$table" '
    BEGIN {
        while ((getline line < table) > 0)
            if (line !~ /^#/ && split(line, half, ": ") == 2)
                may[half[1]] = " " half[2] " "
    }
    # The path of the source, from src on where there is one: "src/image/map.c", else "cli/bake.c".
    function source_of(object) {
        sub(/\.o(bj)?$/, "", object)
        if (match(object, /(^|\/)src\/[^\/]*\/[^\/]*$/)) {
            object = substr(object, RSTART)
            sub(/^\//, "", object)
            return object
        }
        sub(/CMakeFiles\/[^\/]*\.dir\//, "", object)
        count = split(object, part, "/")
        return count > 1 ? part[count - 1] "/" part[count] : object
    }
    function layer_of(file,    part) {
        split(file, part, "/")
        return part[1] == "src" ? part[2] : part[1]
    }
    # Lines are "OBJECT: SYMBOL TYPE ...".
    {
        object = $1
        sub(/:$/, "", object)
        if (!(object in file_of)) {
            file_of[object] = source_of(object)
            files[++file_count] = file_of[object]
        }
        if ($3 == "U")
            wants[file_of[object]] = wants[file_of[object]] " " $2
        else if ($3 ~ /^[TDBRCV]$/)
            home[$2] = file_of[object]
    }
    # In the order of their names.
    function print_circle(circle, size,    i, j, swap, text) {
        for (i = 1; i <= size; i++)
            for (j = i + 1; j <= size; j++)
                if (circle[j] < circle[i]) {
                    swap = circle[i]
                    circle[i] = circle[j]
                    circle[j] = swap
                }
        for (i = 1; i <= size; i++)
            text = text " " circle[i]
        print "a circle of calls:" text
    }
    # Tarjan: the strongly connected files, along calls inside one folder.
    function visit(f,    i, count, to, other, circle, size) {
        place[f] = low[f] = ++placed
        stack[++depth] = f
        on[f] = 1
        count = split(near[f], to, " ")
        for (i = 1; i <= count; i++) {
            other = to[i]
            if (!(other in place)) {
                visit(other)
                if (low[other] < low[f])
                    low[f] = low[other]
            } else if (on[other] && place[other] < low[f])
                low[f] = place[other]
        }
        if (low[f] != place[f])
            return
        size = 0
        do {
            other = stack[depth--]
            on[other] = 0
            circle[++size] = other
        } while (other != f)
        if (size > 1)
            print_circle(circle, size)
    }
    END {
        if (!file_count)
            print "no object files"
        for (i = 1; i <= file_count; i++) {
            from = files[i]
            count = split(wants[from], symbol, " ")
            for (j = 1; j <= count; j++) {
                to = home[symbol[j]]
                if (to == "" || to == from)
                    continue
                here = layer_of(from)
                there = layer_of(to)
                if (here in may && there in may && index(may[here], " " there " ") == 0)
                    print from ": " here " may not call " symbol[j] " of " to
                if (here == there && !((from, to) in seen)) {
                    seen[from, to] = 1
                    near[from] = near[from] " " to
                    why[from, to] = symbol[j]
                }
            }
        }
        for (i = 1; i <= file_count; i++)
            if (!(files[i] in place))
                visit(files[i])
    }'
)
[ -z "$found" ] || { printf '%s\n' "$found"; exit 1; }

#!/bin/sh
# Checks that includes go one way through the layers. Prints file:line of every one that does not.
#   scripts/layers.sh [ROOT]
set -eu
table=$(cd "$(dirname "$0")" && pwd)/layers.txt
cd "${1:-$(dirname "$0")/..}"

# shellcheck disable=SC2016 # the dollars are awk's
status=$(
    find src cli bench examples viewer web -name '*.[ch]' -o -name '*.inl' 2>/dev/null | sort |
        xargs awk -v table="$table" '
    BEGIN {
        while ((getline line < table) > 0)
            if (line !~ /^#/ && split(line, half, ": ") == 2)
                may[half[1]] = half[2]
        public["kiln/kiln.h"]
        public["kiln/brdf.h"]
        public["kiln/course.h"]
        public["kiln/check.h"]
    }
    /^[ \t]*#[ \t]*include/ {
        name = $0
        sub(/^[^"<]*["<]/, "", name)
        sub(/[">].*$/, "", name)
        split(FILENAME, path, "/")
        split(name, wanted, "/")
        system_header = $0 ~ /</
        if (path[1] == "src" && !system_header) {
            if (!(path[2] in may))
                print FILENAME ":" FNR ": src/" path[2] " is not in the table of layers"
            else if (index(" " may[path[2]] " ", " " wanted[1] " ") == 0 || name !~ /\//)
                print FILENAME ":" FNR ": " path[2] " may not include \"" name "\""
        }
        if (path[1] != "src" && (!system_header && name ~ /\// || wanted[1] == "kiln" && !(name in public)))
            print FILENAME ":" FNR ": " path[1] " may include <kiln/...> only, not \"" name "\""
    }'
)
[ -z "$status" ] || { printf '%s\n' "$status"; exit 1; }

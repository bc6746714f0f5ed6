#!/bin/sh
# The script of calls finds nothing in this build, and finds each call and each circle that is planted.
#   calls.sh CC LIST...
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
cc=$1
shift
"$root/scripts/calls.sh" "$@"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# plant FILE DEFINES CALLS: an object of a file that defines one function, which calls another.
plant() {
    mkdir -p "$work/objects/$(dirname "$1")"
    printf 'int %s(void);\nint %s(void);\nint %s(void)\n{\n    return %s();\n}\n' \
        "$2" "$3" "$2" "$3" >"$work/planted.c"
    "$cc" -c "$work/planted.c" -o "$work/objects/$1.o"
}
# check: runs the script on what is planted so far.
check() {
    find "$work/objects" -name '*.o' >"$work/list"
    "$root/scripts/calls.sh" "$work/list" >"$work/said"
}
named() {
    if check; then
        echo "not found: $1"
        exit 1
    fi
    grep -qx "$1" "$work/said" || { echo "not named: $1"; cat "$work/said"; exit 1; }
    rm -r "$work/objects"
}

# Up a layer, and beside.
plant src/image/a.c ki_a ki_b
plant src/sphere/b.c ki_b ki_none
named 'src/image/a.c: image may not call ki_b of src/sphere/b.c'
plant src/codec/a.c ki_a ki_b
plant src/brdf/b.c ki_b ki_none
named 'src/codec/a.c: codec may not call ki_b of src/brdf/b.c'

# Round in a folder of the library, by way of a third file, and in the command.
plant src/codec/a.c ki_a ki_b
plant src/codec/b.c ki_b ki_c
plant src/codec/c.c ki_c ki_a
named 'a circle of calls: src/codec/a.c src/codec/b.c src/codec/c.c'
plant cli/CMakeFiles/kiln_cli.dir/a.c cli_a cli_b
plant cli/CMakeFiles/kiln_cli.dir/b.c cli_b cli_a
named 'a circle of calls: cli/a.c cli/b.c'

# And what is allowed passes.
plant src/sphere/a.c ki_a ki_b
plant src/sphere/b.c ki_b ki_c
plant src/image/c.c ki_c getpid
check
# No object is no proof.
: >"$work/list"
if "$root/scripts/calls.sh" "$work/list" >"$work/said" 2>&1; then
    echo "nothing was checked, and it passed"
    exit 1
fi

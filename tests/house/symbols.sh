#!/bin/sh
# The symbols script finds nothing in the libraries, and a static function that is named as one of the C
# library's is found.
#   tests/house/symbols.sh libkiln.a libkiln.so
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
"$root/scripts/symbols.sh" "$1" "$2"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
printf 'static kiln_result write(int to)\n{\n}\nstatic const float *row(int y)\n{\n}\n' >"$work/a.c"
if "$root/scripts/symbols.sh" "$1" "$2" "$work" >"$work/said"; then
    echo "not found: a static function named write"
    exit 1
fi
[ "$(tail -n 1 "$work/said")" = write ] || { cat "$work/said"; exit 1; }

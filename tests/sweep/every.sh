#!/bin/sh
# Checks that the sweep calls every public function: each name after KILN_API in the headers stands, with an
# opening parenthesis, in a file of this folder.
#   every.sh HEADERS
set -eu
sweep=$(dirname "$0")
names=$(cat "$1/kiln.h" "$1/brdf.h" "$1/course.h" "$1/check.h" | tr '\n' ' ' |
    grep -o 'KILN_API [^;(]*kiln_[a-z0-9_]*(' | grep -o 'kiln_[a-z0-9_]*($' | sort -u)
count=0
missing=
for name in $names; do
    count=$((count + 1))
    grep -qF -- "$name" "$sweep"/*.c || missing="$missing $name"
done
[ "$count" -gt 100 ] || { echo "only $count functions were found in $1"; exit 1; }
[ -z "$missing" ] || { echo "the sweep does not call:$missing"; exit 1; }
echo "$count functions"

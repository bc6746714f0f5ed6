#!/bin/sh
# Compares the table of folders in CONTRIBUTING.md with the folders: each folder at the top and under src/
# has a row, and each row names a folder. Prints each difference.
#   scripts/map.sh [ROOT]
set -eu
cd "${1:-$(dirname "$0")/..}"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# shellcheck disable=SC2016 # the backquotes are Markdown's
sed -n 's/^| `\([a-z/]*\/\)` |.*/\1/p' CONTRIBUTING.md | sort >"$work/all"
sort -u "$work/all" >"$work/rows"
for folder in */ src/*/; do
    case $folder in
    build*/) ;;
    *) [ ! -d "$folder" ] || echo "$folder" ;;
    esac
done | sort >"$work/folders"
comm -13 "$work/rows" "$work/folders" | sed 's/$/: has no row in CONTRIBUTING.md/' >"$work/said"
comm -23 "$work/rows" "$work/folders" | sed 's/$/: has a row in CONTRIBUTING.md, but is no folder/' >>"$work/said"
uniq -d "$work/all" | sed 's/$/: has two rows in CONTRIBUTING.md/' >>"$work/said"
cat "$work/said"
[ ! -s "$work/said" ]

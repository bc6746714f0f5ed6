#!/bin/sh
# The map of folders in CONTRIBUTING.md is true, and scripts/map.sh finds a planted folder without a row,
# a row without a folder, and a row that stands twice.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
"$root/scripts/map.sh"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# The tree has the folders of the table, and nothing else.
mkdir "$work/tree"
cp "$root/CONTRIBUTING.md" "$work/tree"
# shellcheck disable=SC2016 # the backquotes are Markdown's
sed -n 's/^| `\([a-z/]*\/\)` |.*/\1/p' "$root/CONTRIBUTING.md" >"$work/rows"
[ "$(wc -l <"$work/rows")" -ge 20 ] || { echo "CONTRIBUTING.md has $(wc -l <"$work/rows") rows of folders"; exit 1; }
while read -r folder; do mkdir -p "$work/tree/$folder"; done <"$work/rows"
"$root/scripts/map.sh" "$work/tree"

# finds WANTED: the script fails and prints this one line.
finds() {
    if "$root/scripts/map.sh" "$work/tree" >"$work/said"; then
        echo "not found: $1"
        exit 1
    fi
    [ "$(cat "$work/said")" = "$1" ] || { echo "wanted: $1"; cat "$work/said"; exit 1; }
}
mkdir "$work/tree/planted"
finds "planted/: has no row in CONTRIBUTING.md"
rmdir "$work/tree/planted"
mkdir "$work/tree/src/planted"
finds "src/planted/: has no row in CONTRIBUTING.md"
rmdir "$work/tree/src/planted" "$work/tree/src/base"
finds "src/base/: has a row in CONTRIBUTING.md, but is no folder"
mkdir "$work/tree/src/base"
# shellcheck disable=SC2016 # the backquotes are Markdown's
echo '| `src/base/` | again |' >>"$work/tree/CONTRIBUTING.md"
finds "src/base/: has two rows in CONTRIBUTING.md"

#!/bin/sh
# ./do docs makes pages without a warning, whose links all lead somewhere; a broken link is found. ./do web --build
# makes the page as files.
#   pages.sh SOURCE
set -eu
source=$1
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$source"

./do docs "$work/docs" >"$work/said" 2>&1 || { cat "$work/said"; exit 1; }
! grep -i warning "$work/said"
python3 "$here/links.py" "$work/docs" 5000
for name in docs/engines/three.html docs/theory/spectral.html CHANGELOG.html api/kiln_8h.html api/structkiln__map.html; do
    [ -s "$work/docs/$name" ] || { echo "there is no $name"; exit 1; }
done
grep -q 'prefers-color-scheme: dark' "$work/docs/style.css"
grep -q 'Steps over one character of UTF-8 text' "$work/docs/api/kiln_8h.html"
# Two planted faults.
mkdir "$work/planted"
echo '<p id="a"><a href="b.html#a">one</a>' >"$work/planted/a.html"
echo '<p id="b"><a href="a.html#a">two</a><a href="c.html">three</a>' >"$work/planted/b.html"
if python3 "$here/links.py" "$work/planted" >"$work/said"; then exit 1; fi
[ "$(grep -c 'no such anchor\|not there' "$work/said")" = 2 ] || { cat "$work/said"; exit 1; }

./do web --build "$work/page" >"$work/said" 2>&1 || { cat "$work/said"; exit 1; }
diff -r build/wasm/site "$work/page"
python3 "$here/links.py" "$work/page"

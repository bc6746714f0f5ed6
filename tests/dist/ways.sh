#!/bin/sh
# The ways to get kiln that README.md lists, typed in empty folders: every ```sh block of its section "Get it" makes a
# city.ktx2, and all of these files are the same.
#   ways.sh SOURCE KILN WORK
set -eu
source=$1
kiln=$2
die() { echo "FAILED: $*"; exit 1; }
mkdir -p "$3"
work=$(mktemp -d "$(cd "$3" && pwd)/ways.XXXXXX")
trap 'rm -rf --one-file-system "$work"' EXIT
trap 'exit 130' INT TERM HUP
export dist="$source/build/dist"
cd "$work"

awk '
    /^## / { here = $0 == "## Get it" }
    here && /^```sh$/ { to = "way" ++n; next }
    /^```/ { to = ""; next }
    to { print >to }
' "$source/README.md"
[ -s way4 ] && [ ! -e way5 ] || die "README.md has $(find . -name 'way*' | wc -l) blocks of commands on ways to get kiln, not 4"

# pip installs into an environment of this folder, with the system's numpy.
/usr/bin/python3 -m venv --system-site-packages venv
PATH=$work/venv/bin:$PATH

"$kiln" bake -q "$source/build/data/blender/city.exr" --for three -o wanted.ktx2 2>/dev/null
for way in 1 2 3 4; do
    mkdir $way
    cp "$source/build/data/blender/city.exr" $way/
    start=$(date +%s)
    (cd $way && sh -eu "../way$way" >said 2>&1) || { cat $way/said; die "way $way: $(cat way$way)"; }
    echo "way $way: $(($(date +%s) - start)) s, $(wc -l <way$way) commands"
    cmp "$way/city.ktx2" wanted.ktx2 || die "way $way makes another city.ktx2"
done

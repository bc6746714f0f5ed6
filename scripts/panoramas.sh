#!/bin/sh
# Puts eight real panoramas (Debian's blender-data, CC0, 1024 x 512 EXR) into a folder.
#   scripts/panoramas.sh [FOLDER]      build/data/blender by default; nothing is done when it is full
set -eu
cd "$(dirname "$0")/.."
folder=${1:-build/data/blender}
names="city courtyard forest interior night studio sunrise sunset"

whole=yes
for name in $names; do
    [ -s "$folder/$name.exr" ] || whole=no
done
[ $whole = no ] || exit 0

work=$folder/work.$$
trap 'rm -rf "$work"' EXIT
mkdir -p "$work"
if ! (cd "$work" && apt-get -q download blender-data) >"$work/log" 2>&1; then
    cat "$work/log" >&2
    echo "panoramas: 'apt-get download blender-data' failed (is 'apt-get update' needed?)" >&2
    exit 1
fi
dpkg -x "$work"/blender-data_*.deb "$work"
for name in $names; do
    mv "$work/usr/share/blender/datafiles/studiolights/world/$name.exr" "$folder/$name.exr"
done

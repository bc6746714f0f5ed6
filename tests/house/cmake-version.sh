#!/bin/sh
# Every CMake file asks for the version that the root's CMakeLists.txt asks for, since a file that asks for a
# later one fails in the middle of a build. The presets have a format that this version reads: CMake 3.21 was
# the first to read version 3. Fails on a planted file, too.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
version=$(sed -n 's/^cmake_minimum_required(VERSION \([0-9.]*\))$/\1/p' "$root/CMakeLists.txt")
[ -n "$version" ] || { echo "CMakeLists.txt asks for no version"; exit 1; }

# others TREE: prints the lines that ask for another version.
others() {
    find "$1" \( -name node_modules -o -name build -o -name .git \) -prune -o \
        \( -name CMakeLists.txt -o -name '*.cmake' \) -exec grep -n 'cmake_minimum_required(' /dev/null {} + |
        grep -vF "(VERSION $version)" || true
}
found=$(others "$root")
[ -z "$found" ] || { echo "other versions than $version:"; echo "$found"; exit 1; }
grep -q '^    "version": 3,$' "$root/CMakePresets.json" || { echo "CMakePresets.json: not of version 3"; exit 1; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/scripts"
echo "cmake_minimum_required(VERSION $version)" >"$work/CMakeLists.txt"
[ -z "$(others "$work")" ] || { echo "found where there is none"; exit 1; }
echo "cmake_minimum_required(VERSION $version.1)" >"$work/scripts/planted.cmake"
[ -n "$(others "$work")" ] || { echo "a planted file is not found"; exit 1; }

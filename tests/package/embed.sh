#!/bin/sh
# Builds a project with kiln inside, by add_subdirectory and by FetchContent: only the library is built, nothing
# of kiln's installed. Nothing is optimised, so that the build is short. The second way finds the objects of the
# first and compiles what it compiles otherwise.
#   embed.sh SOURCE
set -eu
source=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

for fetch in OFF ON; do
    rm -f "$work/build/embed"
    {
        cmake -S "$source/tests/package/embed" -B "$work/build" -G Ninja -DFETCH=$fetch \
            -DKILN_SOURCE="$source" -DCMAKE_BUILD_TYPE=Debug -DKILN_KERNEL_FLAGS=-O0 &&
            cmake --build "$work/build" -j 1 && cmake --install "$work/build" --prefix "$work/installed"
    } >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
    "$work/build/embed"
    built=$(find "$work/build" -name 'libkiln*' | wc -l)
    [ "$built" = 1 ] || { echo "$built libraries were built, not one"; exit 1; }
    for target in kiln_cli kiln_viewer test_map bench demo; do
        ! ninja -C "$work/build" -t query "$target" >/dev/null 2>&1 || { echo "$target is a target"; exit 1; }
    done
    [ ! -e "$work/installed" ] || { echo "installed:"; find "$work/installed" -type f; exit 1; }
    grep -c '^\[' "$work/log" | sed "s/^/FETCH=$fetch: commands of the build: /"
done

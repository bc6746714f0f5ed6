#!/bin/sh
# Builds kiln for another machine or by another compiler and holds it to the golden hashes.
#   cross.sh SOURCE PRESET [COMPILER]
set -eu
source=$1
preset=$2
compiler=${3:-}
here=$(cd "$(dirname "$0")" && pwd)
build=$source/build/$preset${compiler:+-$compiler}
log=$build.log
[ -z "$compiler" ] || export CC="$compiler"

if [ "$preset" = mingw ]; then
    # Windows' registry and drives, in the build's folder.
    export WINEPREFIX="$build/wine" WINEDEBUG=-all LC_ALL=C.UTF-8
    mkdir -p "$build"
    trap '"$(command -v wineserver64 || command -v wineserver || echo /usr/lib/wine/wineserver64)" -k 2>/dev/null || true' EXIT
fi

# Every build is compiled at -O3, as users have it, but for musl: its compiler is the one of the tests' own build, and
# only the C library differs. There the kernels alone are compiled at -O3, which takes half of the time.
case $preset in
musl) set -- -DCMAKE_C_FLAGS_RELEASE="-O1 -DNDEBUG" ;;
*) set -- ;;
esac

cd "$source"
{ cmake --preset "$preset" -B "$build" "$@" && cmake --build "$build" -j 1; } >"$log" 2>&1 ||
    { tail -n 60 "$log"; exit 1; }
ctest --test-dir "$build" --output-on-failure -R '^golden$' --no-tests=error
[ ! -e "$here/$preset.sh" ] || sh "$here/$preset.sh" "$build" "$source"

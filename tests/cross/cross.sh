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

# The kernels, whose bits the golden hashes are mostly made of, are always compiled at -O3, as users have them.
# The rest is compiled at -O1, which takes half of the time, where another test compiles the same sources at -O3
# by the same family of compilers for the same family of processors: for musl and gcc-11 the tests' own build by
# gcc, for i686 the same and mingw's.
case $preset$compiler in
musl | i686 | portablegcc-11) set -- -DCMAKE_C_FLAGS_RELEASE="-O1 -DNDEBUG" ;;
*) set -- ;;
esac

cd "$source"
{ cmake --preset "$preset" -B "$build" "$@" && cmake --build "$build" -j 1; } >"$log" 2>&1 ||
    { tail -n 60 "$log"; exit 1; }
ctest --test-dir "$build" --output-on-failure -R '^golden$' --no-tests=error
[ ! -e "$here/$preset.sh" ] || sh "$here/$preset.sh" "$build" "$source"

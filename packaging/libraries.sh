#!/bin/sh
# Compiles zstd, libdeflate and libjpeg-turbo as archives for one system, so that programs for this system need no
# other file.
#   packaging/libraries.sh SOURCES SYSTEM PREFIX
# SOURCES is the folder that packaging/sources.sh fills. SYSTEM is linux-x86_64, linux-aarch64 (both with musl) or
# windows-x86_64. Out: PREFIX/lib, PREFIX/include, and PREFIX/lib/pkgconfig, by which CMake finds the libraries; for
# linux-aarch64 also PREFIX/bin/musl-gcc, since Debian has musl for the machine's own processor only.
set -eu
sources=$(cd "$1" && pwd)
system=$2
mkdir -p "$3"
prefix=$(cd "$3" && pwd)
work=$prefix/work
jobs=$(nproc 2>/dev/null || echo 2)
rm -rf "$work"
mkdir -p "$work" "$prefix/include" "$prefix/lib/pkgconfig"

# quietly COMMAND...: what it prints is shown if it fails.
quietly() { "$@" >"$work/log" 2>&1 || { tail -n 60 "$work/log" >&2; exit 1; }; }

version_of() { sed -n '1s/.*(\([^)]*\)).*/\1/p' "$sources/$1/debian/changelog"; }

case $system in
linux-x86_64) cc=musl-gcc ar=ar processor=x86_64 name=Linux ;;
linux-aarch64) cc=$prefix/bin/musl-gcc ar=aarch64-linux-gnu-ar processor=aarch64 name=Linux ;;
windows-x86_64) cc=x86_64-w64-mingw32-gcc ar=x86_64-w64-mingw32-ar processor=x86_64 name=Windows ;;
*) echo "libraries: '$system' is no system that is known" >&2; exit 2 ;;
esac
# No path of this machine goes into an object.
flags="-O2 -DNDEBUG -fPIC -ffile-prefix-map=$sources=. -ffile-prefix-map=$work=."

# compile NAME FILE...: PREFIX/lib/libNAME.a of C files whose names differ by their paths, with the flags $extra.
compile() {
    archive=$prefix/lib/lib$1.a
    shift
    mkdir -p "$work/objects"
    # shellcheck disable=SC2016 # the inner shell's variables
    printf '%s\n' "$@" | cc=$cc flags="$flags $extra" to=$work/objects xargs -n 1 -P "$jobs" sh -c \
        '$cc $flags -c "$0" -o "$to/$(echo "$0" | tr / -).o" || exit 255'
    $ar rcsD "$archive" "$work/objects"/*.o
    rm -rf "$work/objects"
}

# describe MODULE LIBRARY VERSION: what pkg-config tells CMake.
describe() {
    printf 'Name: %s\nDescription: %s\nVersion: %s\nLibs: -L%s -l%s\nCflags: -I%s\n' "$1" "$1" "$3" "$prefix/lib" \
        "$2" "$prefix/include" >"$prefix/lib/pkgconfig/$1.pc"
}

if [ "$system" = linux-aarch64 ]; then
    mkdir "$work/musl"
    cd "$work/musl"
    quietly "$sources/musl/configure" --prefix="$prefix" --target=aarch64-linux-gnu CC=aarch64-linux-gnu-gcc \
        CFLAGS="-O2 -ffile-prefix-map=$sources=." --disable-shared --enable-wrapper=gcc
    quietly make -j "$jobs" install
fi

cd "$sources/libzstd"
extra="-Ilib -DZSTD_DISABLE_ASM=1"
compile zstd lib/common/*.c lib/compress/*.c lib/decompress/*.c
cp lib/zstd.h lib/zstd_errors.h "$prefix/include/"
describe libzstd zstd "$(version_of libzstd)"

cd "$sources/libdeflate"
extra=-I.
# shellcheck disable=SC2046 # names without spaces
compile deflate $(find lib -name '*.c' | LC_ALL=C sort)
cp libdeflate.h "$prefix/include/"
describe libdeflate deflate "$(version_of libdeflate)"

# Without its assembly, which gives the same samples faster and needs an assembler more.
quietly cmake -S "$sources/libjpeg-turbo" -B "$work/jpeg" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_SYSTEM_NAME=$name -DCMAKE_SYSTEM_PROCESSOR=$processor -DCMAKE_C_COMPILER="$cc" \
    -DCMAKE_AR="$(command -v $ar)" -DCMAKE_C_FLAGS="-fPIC -ffile-prefix-map=$sources=. -ffile-prefix-map=$work=." \
    -DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY -DCMAKE_INSTALL_PREFIX="$prefix" \
    -DENABLE_SHARED=OFF -DENABLE_STATIC=ON -DWITH_TURBOJPEG=OFF -DWITH_SIMD=OFF
quietly cmake --build "$work/jpeg" --target jpeg-static -j "$jobs"
cp "$work/jpeg/libjpeg.a" "$prefix/lib/"
for header in jpeglib jmorecfg jerror; do
    cp "$(find "$sources/libjpeg-turbo" -name "$header.h" | head -n 1)" "$prefix/include/"
done
cp "$work/jpeg/jconfig.h" "$prefix/include/"
describe libjpeg jpeg "$(version_of libjpeg-turbo)"
rm -rf "$work"

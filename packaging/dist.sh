#!/bin/sh
# Makes what is handed out to users, into build/dist: see docs/downloads.md. Everything is made of the files of the
# last commit, so that the source archive and the programs belong together, and the same commit gives the same bytes.
#   packaging/dist.sh
# The date of all files is the commit's. The folder build/dist-work holds the builds, build/sources the sources of the
# libraries that are linked.
set -eu
cd "$(dirname "$0")/.."
fail() { printf 'dist: %s\n' "$*" >&2; exit 1; }
say() { printf '== %s\n' "$*"; }
umask 022
unset CMAKE_C_COMPILER_LAUNCHER CFLAGS LDFLAGS
export LC_ALL=C TZ=UTC

case $PWD in
*[!A-Za-z0-9/._+-]*) fail "the path '$PWD' has a character that the settings of compilers cannot hold: move the clone" ;;
esac
git rev-parse HEAD >/dev/null 2>&1 || fail "the source archive is made by git: this folder is no clone"
[ -z "$(git status --porcelain)" ] || echo "dist: files that are not committed are left out"
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH
top=$PWD
out=$top/build/dist
work=$top/build/dist-work
rm -rf "$out" "$work"
mkdir -p "$out" "$work"

# quietly COMMAND...: what it prints is shown if it fails.
quietly() { "$@" >"$work/log" 2>&1 || { tail -n 60 "$work/log" >&2; fail "failed: $*"; }; }

version=$(git show HEAD:CMakeLists.txt | sed -n 's/^project(kiln VERSION \([0-9.]*\).*/\1/p')
name=kiln-$version
source=$work/$name
say "source"
git archive --format=tar --prefix="$name/" HEAD | gzip -n9 >"$out/$name.tar.gz"
tar -x -z -f "$out/$name.tar.gz" -C "$work"
packaging/sources.sh build/sources
# No path of this machine goes into an object.
export CFLAGS="-ffile-prefix-map=$source=."

# configure BUILD [-D...]: the command by itself, in a folder of $work.
configure() {
    build=$work/$1
    shift
    (cd "$source" && quietly cmake -B "$build" "$@" -DKILN_TESTS=OFF -DKILN_GOLDEN=OFF -DKILN_BENCH=OFF \
        -DKILN_EXAMPLES=OFF)
}

# program SYSTEM PRESET [-D...]: the command as one file, in $work/SYSTEM/bin.
program() {
    say "$1"
    system=$1
    preset=$2
    shift 2
    quietly packaging/libraries.sh build/sources "$system" "$work/libraries-$system"
    export PKG_CONFIG_LIBDIR="$work/libraries-$system/lib/pkgconfig" KILN_MUSL_GCC="$work/libraries-$system/bin/musl-gcc"
    configure "$system" --preset "$preset" -DKILN_ZSTD=ON -DKILN_DEFLATE=ON -DKILN_JPEG=ON "$@"
    unset PKG_CONFIG_LIBDIR KILN_MUSL_GCC
    quietly cmake --build "$work/$system" --target kiln_cli
}

# gather SYSTEM PROGRAM STRIP LICENCE...: the folder of one system's archive, whose path is printed.
gather() {
    folder=$work/archives/$name-$1
    mkdir -p "$folder"
    "$3" -s -o "$folder/$2" "$work/$1/bin/$2"
    built=$1
    shift 3
    "$source/packaging/licences.sh" "$top/build/sources" "$@" zstd=libzstd libdeflate=libdeflate \
        libjpeg-turbo=libjpeg-turbo >"$folder/LICENSES.txt" || fail "no licences for $built"
    chmod 755 "$folder"/kiln*
    echo "$folder"
}

# pack FOLDER: FOLDER.tar.gz in $out.
pack() {
    (cd "$(dirname "$1")" && tar --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$SOURCE_DATE_EPOCH" \
        --format=ustar -c "$(basename "$1")") | gzip -n9 >"$out/$(basename "$1").tar.gz"
}

program linux-x86_64 musl
pack "$(gather linux-x86_64 kiln strip musl=musl "GCC's runtime library:$(gcc -print-libgcc-file-name)")"
program linux-aarch64 aarch64 --toolchain "$source/cmake/aarch64-musl.cmake"
pack "$(gather linux-aarch64 kiln aarch64-linux-gnu-strip musl=musl \
    "GCC's runtime library:$(aarch64-linux-gnu-gcc -print-libgcc-file-name)")"
program windows-x86_64 mingw -DCMAKE_EXE_LINKER_FLAGS=-Wl,--no-insert-timestamp
folder=$(gather windows-x86_64 kiln.exe x86_64-w64-mingw32-strip \
    "mingw-w64:$(x86_64-w64-mingw32-gcc -print-file-name=libmingw32.a)" \
    "GCC's runtime library:$(x86_64-w64-mingw32-gcc -print-libgcc-file-name)")
python3 packaging/zip.py "$folder" "$out/$(basename "$folder").zip" "$SOURCE_DATE_EPOCH"

say "Debian package and Python wheel"
configure system --preset release -DCMAKE_INSTALL_PREFIX=/usr -DKILN_PYTHON=ON
quietly cmake --build "$work/system"
quietly packaging/deb.sh "$work/system" "$out"
cp "$work/system/python/$(cat "$work/system/python/wheel.txt")" "$out/"

say "npm package"
(cd "$source" && quietly ./do npm && cp "build/npm/$(cat build/npm/name.txt)" "$out/")

say "checksums"
(cd "$out" && sha256sum -- * >"$work/SHA256SUMS" && mv "$work/SHA256SUMS" . && cat SHA256SUMS)

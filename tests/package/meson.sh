#!/bin/sh
# A project of Meson's with kiln inside, by the lines of docs/embedding.md: the lines configure, each source is
# to be compiled for its own instruction set and no other, and the program links and bakes. To compile the
# library again would take most of a minute, which is why LIBRARY, from CMake's own build, takes the place of
# the library that Meson would make.
#   meson.sh SOURCE LIBRARY
set -eu
source=$1
library=$2
command -v meson >/dev/null || { echo "meson is missing: install meson"; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "$1"; cat "$2"; exit 1; }

mkdir "$work/subprojects"
ln -s "$source" "$work/subprojects/kiln"
cp "$source/tests/package/consumer/main.c" "$work/main.c"
{
    echo "project('embed', 'c', default_options: ['c_std=c17', 'buildtype=debug'])"
    awk '/^```meson$/ { inside = 1; next } /^```$/ { inside = 0 } inside' "$source/docs/embedding.md"
    echo "executable('embed', 'main.c', dependencies: kiln)"
} >"$work/meson.build"
meson setup "$work/build" "$work" >"$work/log" 2>&1 || fail "Meson does not configure kiln:" "$work/log"

cd "$work/build"
ninja -t commands embed >"$work/commands"
grep -e ' -c .*/src/[^ ]*\.c$' "$work/commands" >"$work/sources" || fail "no sources:" "$work/commands"
[ "$(wc -l <"$work/sources")" -gt 100 ] || fail "too few sources:" "$work/sources"
for set in avx2 avx512; do
    ! grep -e "-m${set}" "$work/sources" | grep -v "_$set\.c\$" >"$work/wrong" ||
        fail "compiled for $set too:" "$work/wrong"
done
if [ "$(uname -m)" = x86_64 ]; then
    grep -q -e '-mavx512f .*_avx512\.c$' "$work/sources" || fail "no kernel for AVX-512:" "$work/sources"
fi

ninja embed.p/main.c.o >"$work/log" 2>&1 || fail "the program does not compile:" "$work/log"
cp "$library" subprojects/kiln/libkiln_static.a
tail -n 1 "$work/commands" | sh -e >"$work/log" 2>&1 || fail "the program does not link:" "$work/log"
./embed

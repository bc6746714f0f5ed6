#!/bin/sh
# The command in Windows, as wine is: bakes, puts a file in the place of another, and knows names that no
# code page holds. cross.sh has set WINEPREFIX.
#   mingw.sh BUILD_FOLDER SOURCE
set -eu
wine=$(command -v wine64 || echo /usr/lib/wine/wine64)
work=$1/windows
rm -rf "$work"
mkdir -p "$work"
cd "$work"
kiln() { "$wine" ../bin/kiln.exe "$@"; }

kiln sky -q -o sky.exr --size 32
kiln bake sky.exr -q -o cube.ktx2 --size 16
first=$(cksum <cube.ktx2)
kiln bake sky.exr -q -o cube.ktx2 --size 32
[ "$(cksum <cube.ktx2)" != "$first" ]
kiln bake sky.exr -q -o cube.ktx2 --size 16
[ "$(cksum <cube.ktx2)" = "$first" ]

mkdir 'Höhle 洞'
kiln bake sky.exr -q -o 'Höhle 洞\würfel 立方.ktx2' --size 16
[ "$(cksum <'Höhle 洞/würfel 立方.ktx2')" = "$first" ]
kiln info 'Höhle 洞/würfel 立方.ktx2' >told
grep -q 'würfel 立方.ktx2' told
# Six faces in a folder that is searched, written and read.
kiln bake sky.exr -q -o 'Höhle 洞/sides/' --size 16 --levels 1
kiln bake 'Höhle 洞/sides' -q -o again.ktx2 --size 16
# A batch: the same bytes, by a manifest with the system's own separators, and kept the second time.
printf '%s\n' '{"input": "sky.exr", "output": "H\u00f6hle 洞\\{name}.ktx2", "size": 16}' >list.jsonl
kiln batch list.jsonl >told
[ "$(cksum <'Höhle 洞/sky.ktx2')" = "$first" ]
kiln batch list.jsonl | grep -q '^1 environment: 0 baked, 1 kept;'
kiln batch 'Höhle 洞' -o 'x{name}.ktx2' --size 8 2>said && exit 1
grep -q 'there is no picture in this folder' said
# Nothing of a temporary name is left, and a failure says why.
[ -z "$(find . -name '*.tmp')" ]
if kiln bake missing.exr -q -o x.ktx2 2>said; then exit 1; fi
grep -q 'missing.exr' said

# A program that asks the DLL.
x86_64-w64-mingw32-gcc -std=c17 -DKILN_SHARED -I"$2/include" "$2/tests/package/consumer/main.c" \
    -o consumer.exe ../libkiln.dll.a
cp ../bin/libkiln.dll .
"$wine" consumer.exe

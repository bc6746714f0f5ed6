#!/bin/sh
# The source code that kiln writes for tables compiles without a warning, as C and as C++, and says
# what kiln_table_lookup does; its GLSL is valid.
#   check.sh WRITE_PROGRAM
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$1" "$work"
cd "$work"
warnings="-Wall -Wextra -Wpedantic -Wconversion -Wdouble-promotion -Wshadow -Werror"
# shellcheck disable=SC2086 # flags are words
cc -std=c99 -O1 $warnings main.c -o c -lm
./c
if command -v c++ >/dev/null; then
    cp main.c main.cpp
    # shellcheck disable=SC2086
    c++ -std=c++11 -O0 $warnings main.cpp -o cpp -lm
    ./cpp
fi
if ! command -v glslangValidator >/dev/null; then
    echo "glslangValidator is missing: install glslang-tools"
    exit 1
fi
count=0
for table in t*_lookup.glsl; do
    name=${table%_lookup.glsl}
    third=
    sampler=sampler2D
    grep -q sampler3D "$table" && sampler=sampler3D
    arguments='p.x, p.y'
    grep -q '_lookup(.*float nov' "$table" || arguments=p.y
    grep -q '_lookup(.*float \(ior\|f0\)' "$table" && third=', p.z'
    {
        printf '#version 300 es\nprecision highp float;\nuniform highp %s table;\nin vec3 p;\nout vec4 color;\n' $sampler
        cat "$table" "$name.glsl"
        printf 'void main()\n{\n    color = vec4(0.0);\n'
        printf '    color.%s = %s_lookup(table, %s%s) + %s_lookup(%s%s);\n}\n' \
            "$(sed -n 's/^\(float\|vec[234]\) .*_lookup(.*/\1/p' "$table" | sed 's/float/r/; s/vec2/rg/; s/vec3/rgb/; s/vec4/rgba/')" \
            "$name" "$arguments" "$third" "$name" "$arguments" "$third"
    } >"$name.frag"
    count=$((count + 1))
done
glslangValidator ./*.frag >log || { grep -v '^\./' log; exit 1; }
echo "$count shaders"

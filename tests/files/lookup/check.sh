#!/bin/sh
# The source code that kiln writes for tables compiles without a warning, as C and as C++, and says
# what kiln_table_lookup does; its GLSL is valid.
#   check.sh WRITE_PROGRAM
set -eu
# shellcheck source=compile.sh
. "$(dirname "$0")/compile.sh"
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

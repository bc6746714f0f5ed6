#!/bin/sh
# The source code that kiln writes for tables of lobes compiles without a warning, as C and as C++,
# and says what kiln_table_lookup does; its GLSL is valid.
#   lobes.sh WRITE_PROGRAM
set -eu
# shellcheck source=compile.sh
. "$(dirname "$0")/compile.sh"
for taps in 1 2 3; do
    {
        printf '#version 300 es\nprecision highp float;\nuniform highp sampler3D table;\n'
        printf 'uniform highp samplerCube levels;\nuniform vec3 sh[9];\nin vec3 n, v;\nout vec4 color;\n'
        cat l${taps}_lookup.glsl
        printf 'void main()\n{\n    color = vec4(l%d_reflect(table, levels, sh, n, v, 0.5), 1.0);\n}\n' $taps
    } >$taps.frag
done
glslangValidator ./*.frag >log || { grep -v '^\./' log; exit 1; }

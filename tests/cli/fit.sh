#!/bin/sh
# kiln fit: what is written compiles, and errs by as much as its comment says.
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"

flags="-std=c17 -O1 -Wall -Wextra -Wpedantic -Wconversion -Wdouble-promotion -Wshadow -Werror"

# Random points, even and toward the corner (0, 0), as floats print; and both ends.
awk 'BEGIN {
    srand(5); print "0 0\n0 1\n1 0\n1 1"
    for (i = 0; i < 3000; i++) { r = rand(); m = rand(); if (i % 2) { m *= r * r * r * r; r *= r }
        printf "%.7g %.7g\n", r, m }
}' >log/points
cut -d' ' -f1 log/points >log/roughness

# reads(TYPE): a program that evaluates the function of a header at lines of "roughness mu".
program() {
    cat <<C
#include "$1"
#include <stdio.h>
int main(void)
{
    double r, m = 0;
    while (scanf("%lf$2", &r$3) == $4) {
        $5
    }
    return 0;
}
C
}

# worst COMMENTED < pairs: the largest difference must not exceed what the comment says by a fiftieth.
worst() {
    checks=$((checks + 1))
    awk -v most="$1" '{ d = $1 - $2; if (d < 0) d = -d; if (d > worst) worst = d }
        END { print worst; exit !(NR > 1000 && worst > most / 2 && worst <= most * 1.02) }' >log/worst ||
        die "the error is $(cat log/worst), the comment says $1"
}
said() { sed -n 's/.*max error \([0-9.e-]*\),.*/\1/p' "$1"; }

# In two variables.
for g in smith smith-uncorrelated schlick-k2 schlick-text; do
    expect 0 "" fit e --g $g --error 1e-2 -o e.h
    grep -q 'coefficients, max error 0.00[0-9]*, RMS' log/out || die "no summary"
    program e.h " %lf" ", &m" 2 'printf("%.9g\n", (double)kiln_e((float)m, (float)r));' >e.c
    # shellcheck disable=SC2086 # several words
    cc $flags e.c -o e -lm || die "the C of e.h"
    ./e <log/points >log/fit
    "$KILN" eval e --g $g <log/points >log/exact
    paste -d' ' log/fit log/exact | worst "$(said e.h)"
done

# The same function in GLSL, read as C.
expect 0 "" fit e --g schlick-text --error 1e-2 -o e.glsl --json
node -e '
    const r = JSON.parse(require("fs").readFileSync("log/out", "utf8"));
    process.exit(r.quantity === "e" && r.g === "schlick-text" && r.coefficients > 10 &&
        r.max_error <= 1e-2 && r.rms_error < r.max_error && r.parts.length === 1 ? 0 : 1);' ||
    die "JSON"
{ echo "#include <math.h>" && sed 's/highp float/double/g' e.glsl; } >e_glsl.h
program e_glsl.h " %lf" ", &m" 2 'printf("%.9g\n", kiln_e(m, r));' >g.c
cc g.c -o g -lm || die "the GLSL of e.glsl"
./g <log/points >log/glsl
checks=$((checks + 1))
paste log/fit log/glsl | awk '{ d = $1 - $2; if (d > 1e-5 || d < -1e-5) { print; exit 1 } }' ||
    die "C and GLSL differ"

# In one, and with two values; a name of its own.
expect 0 "" fit eavg --error 1e-4 -o average.h --name "my_average" -q
[ ! -s log/out ] || die "quiet work says something"
program average.h "" "" 1 'printf("%.9g\n", (double)my_average((float)(r + m)));' >a.c
# shellcheck disable=SC2086 # several words
cc $flags a.c -o a -lm || die "the C of average.h"
./a <log/roughness >log/fit
"$KILN" eval eavg <log/roughness >log/exact
paste -d' ' log/fit log/exact | worst "$(said average.h)"

expect 0 "" fit dfg --error 0.05 --form rational -o dfg.h
program dfg.h " %lf" ", &m" 2 'float ab[2]; kiln_dfg((float)m, (float)r, ab);
        printf("%.9g\n%.9g\n", (double)ab[0], (double)ab[1]);' >d.c
# shellcheck disable=SC2086 # several words
cc $flags d.c -o d -lm || die "the C of dfg.h"
./d <log/points >log/fit
"$KILN" eval a <log/points >log/a
"$KILN" eval b <log/points >log/b
paste -d'\n' log/a log/b >log/exact
paste -d' ' log/fit log/exact | worst "$(said dfg.h)"

# GLSL ES 3.00 by the reference compiler, where there is one.
expect 0 "" fit dfg --error 0.05 -o dfg.glsl
expect 0 "" fit eavg --error 1e-3 -o eavg.glsl
expect 0 "" fit sheen --roughness-min 0.5 --error 0.01 -o sheen.glsl
if command -v glslangValidator >log/which; then
    {
        echo "#version 300 es"
        echo "precision highp float; in vec2 uv; out vec4 color;"
        cat e.glsl dfg.glsl eavg.glsl sheen.glsl
        echo "void main() { color = vec4(kiln_dfg(uv.x, uv.y) * kiln_e_average(uv.y),"
        echo "    kiln_e(uv.x, uv.y), kiln_sheen(uv.x, uv.y)); }"
    } >all.frag
    glslangValidator all.frag >log/out || die "the GLSL"
    checks=$((checks + 1))
    rm all.frag
fi

# What cannot be reached is said, and nothing is written.
rm -f ./*.glsl ./*.[ch] e g a d
expect 1 "no function with up to 16 coefficients has an error of 0.01 or less; the best" fit e -o e.h \
    --max-coefficients 16 --error 0.01
expect 1 "no function with up to 2 coefficients comes near an error of 1e-05" fit e -o e.h \
    --max-coefficients 2 --error 1e-5
[ -z "$(find . -type f -not -path "./log/*")" ] || die "something was written"
expect 1 "there is no folder nowhere" fit e -o nowhere/e.h
passed

#!/bin/sh
# docs/embedding.md and the examples keep their word: every piece of C compiles and runs, the examples run,
# and the options that the page names are the build's.
#   embedding.sh SOURCE_FOLDER BUILD_FOLDER
set -eu
source=$1
build=$2
page=$source/docs/embedding.md
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

compile() {
    cc -std=c17 -D_POSIX_C_SOURCE=200809L -Wall -Wextra -Wpedantic -Werror -I "$source/include" "$1.c" \
        -o "$1" -L "$build" -lkiln -lm -Wl,-rpath,"$build"
}

# Every ```c block is the body of a function.
awk '
    /^```c$/ { n++; to = "piece" n ".c"
        print "#include <kiln/kiln.h>\n#include <stdio.h>" >to
        print "static kiln_result piece(kiln_context *context, kiln_error *error)\n{" >to
        next }
    /^```$/ && to { print "}" >to
        print "int main(void)\n{\n    kiln_context *context;\n    kiln_error error = {0};" >to
        print "    if (kiln_context_create(NULL, &context, &error))\n        return 1;" >to
        print "    kiln_result result = piece(context, &error);" >to
        print "    if (result)\n        printf(\"%s\\n\", error.message);" >to
        print "    size_t held;\n    kiln_context_memory(context, &held, NULL);" >to
        print "    kiln_context_destroy(context);\n    return result || held;\n}" >to
        to = ""; next }
    to { print >to }
' "$page"
n=0
while [ -e piece$((n + 1)).c ]; do
    n=$((n + 1))
    compile piece$n
    ./piece$n >said || { echo "piece $n of the page fails:"; cat said piece$n.c; exit 1; }
done
[ $n -ge 5 ] || { echo "docs/embedding.md has $n pieces of C only"; exit 1; }
[ "$(cat said)" = "cube size is -3, it must be 1 to 32768" ] || { echo "the last says:"; cat said; exit 1; }
[ -s env.ktx2 ] || { echo "the first piece wrote no env.ktx2"; exit 1; }

for example in bake memory probe; do
    cp "$source/examples/$example.c" .
    compile $example
done
"$build/bin/kiln" sky -q --size 64 -o sky.exr
./bake sky.exr three.ktx2 three >said
grep -q '^three.ktx2: 6 levels from 256 texels on, 1 file, 0 values cut off at 65408$' said ||
    { cat said; exit 1; }
./bake sky.exr faces/ >said
grep -q '54 files' said && [ -s faces/px_0.exr ] || { cat said; ls faces; exit 1; }
if ./bake sky.exr x.ktx2 nothing 2>/dev/null; then exit 1; fi
./memory >said
grep -q 'and sky.ktx2 in' said || { cat said; exit 1; }
# A lamp at -Z, +X, +Z and -X: the light leans to where the lamp is.
./probe >said
awk '{ x = $7 + 0; z = $9 + 0; a = (NR - 1) % 4
       good = a == 0 ? z < -.5 : a == 1 ? x > .5 : a == 2 ? z > .5 : x < -.5
       if (!good) { print "the light does not follow the lamp:"; print; bad = 1 } }
     END { exit bad || NR != 4 }' said || { cat said; exit 1; }

# Options that the page names are the build's.
grep -o 'KILN_[A-Z]*`' "$page" | tr -d '\140' | sort -u | while read -r name; do
    case $name in KILN_ERROR*) continue ;; esac
    grep -rq "option($name \|optional(${name#KILN_} " "$source/CMakeLists.txt" ||
        { echo "docs/embedding.md names $name, which is no option"; exit 1; }
done
echo "$n pieces and three examples"

#!/bin/sh
# The README keeps its word: its program compiles and runs, its commands print what it says.
#   readme.sh SOURCE_FOLDER BUILD_FOLDER KILN
set -eu
source=$1
build=$2
kiln=$3
readme=$source/README.md
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cp "$source/build/data/blender/city.exr" .
mkdir bin
ln -s "$kiln" bin/kiln
PATH=$work/bin:$PATH

# Blocks: the program in the first ```c, commands and what they print in every ```console.
awk '
    /^```c$/ && !program { program = 1; to = "program.c"; next }
    /^```console$/ { console = 1; next }
    /^```/ { to = ""; console = 0; next }
    console && /^\$ / { n++; print substr($0, 3) >("command" n); printf "" >("wanted" n); next }
    console { print >("wanted" n); next }
    to { print >to }
' "$readme"

[ -s program.c ] || { echo "README.md has no program"; exit 1; }
lines=$(sed -n '/^{/,/^}/p' program.c | grep -cv '^[{}]')
[ "$lines" -le 12 ] || { echo "the program's body has $lines lines, not twelve"; exit 1; }
cc -std=c17 -Wall -Wextra -Wpedantic -Werror -I "$source/include" program.c -o program \
    -L "$build" -lkiln -Wl,-rpath,"$build"
./program
kiln info city.ktx2 | grep -q '9 levels'
rm city.ktx2

# Times, and the name of the instruction set, are the machine's own.
plain() { sed -e 's/[0-9.]* s$/N s/' -e 's/^\(  seconds *\).*/\1N/' -e 's/^\(  memory *\).*/\1N/' "$1"; }
n=1
while [ -e command$n ]; do
    sh ./command$n >said 2>&1 || { echo "\$ $(cat command$n): exit $?"; cat said; exit 1; }
    plain said >a
    plain wanted$n >b
    diff b a >difference || {
        echo "\$ $(cat command$n): README.md's lines and the command's differ:"
        cat difference
        exit 1
    }
    n=$((n + 1))
done
[ $n -gt 3 ] || { echo "README.md has $((n - 1)) commands only"; exit 1; }

# What it names is there.
grep -o '](\([^)#]*\))' "$readme" | sed 's/^](//; s/)$//' | grep -v '^https\?:' | sort -u |
    while read -r name; do
        [ -e "$source/$name" ] || { echo "README.md names $name, which is not there"; exit 1; }
    done
echo "the program and $((n - 1)) commands"

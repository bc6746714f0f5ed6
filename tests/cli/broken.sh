#!/bin/sh
# Inputs that are not usable and outputs that cannot be written: a sentence, exit 1, and what was
# there before is still there.
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"

expect 0 "" sky -o sky.exr --size 32 -q
expect 0 "" sky -o sky.hdr --size 32 -q
expect 0 "" bake sky.exr -o cube.ktx2 --size 8 --exposure -8
zstd=--zstd
[ "${KILN_ZSTD:-ON}" = ON ] || zstd= # of a build without zstd
expect 0 "" bake sky.exr -o zcube.ktx2 --size 8 --exposure -8 $zstd
expect 0 "" bake sky.exr -o cube.dds --size 8 --exposure -8
expect 0 "" tables --method textbook -o table.png --size 16 --samples 4
files="sky.exr sky.hdr cube.ktx2 zcube.ktx2 cube.dds table.png"

echo before >out.ktx2
: >empty.exr
echo "not a picture" >text.exr
mkdir folder
expect 1 "missing.exr" bake missing.exr -o out.ktx2
expect 1 "empty.exr" bake empty.exr -o out.ktx2
expect 1 "text.exr" bake text.exr -o out.ktx2
expect 1 "folder" bake folder -o out.ktx2
expect 1 "pattern_" bake 'pattern_%s.exr' -o out.ktx2
expect 1 "table.png" bake table.png -o out.ktx2
expect 1 "missing.exr" info missing.exr
expect 1 "text.exr" info text.exr

# Every file cut short, at many lengths.
for file in $files; do
    size=$(wc -c <"$file")
    for part in 1 4 11 12 13 30 50 70 90 99; do
        head -c $((size * part / 100)) "$file" >short.bin
        expect 1 "^kiln: short.bin" bake short.bin -o out.ktx2 --size 4
    done
done
# And with bytes changed: it may be read or refused, but must not crash.
i=0
for file in $files; do
    size=$(wc -c <"$file")
    for part in 2 5 8 13 21 34 55 89; do
        at=$((size * part / 100))
        cp "$file" short.bin
        i=$((i + 37))
        printf '%b' "\\0$(printf '%o' $((i % 256)))" | dd of=short.bin bs=1 seek=$at conv=notrunc 2>log/dd
        got=0
        "$KILN" bake short.bin -o changed.ktx2 --size 4 -q >log/out 2>log/err || got=$?
        [ $got -le 1 ] || die "$file with byte $at changed: exit $got"
        rm -f changed.ktx2
    done
done
rm short.bin

# shellcheck disable=SC2086 # $files are words
only $files out.ktx2 empty.exr text.exr
echo before | cmp - out.ktx2 || die "out.ktx2 was touched"

# Outputs.
if [ "$(id -u)" != 0 ]; then
    mkdir closed && chmod a-w closed
    expect 1 "closed/out.ktx2" bake sky.exr -o closed/out.ktx2
fi
(
    ulimit -f 8
    expect 1 "out.ktx2" bake sky.exr -o out.ktx2 --size 64 --exposure -8
)
# Address space for some of 256 threads, whose stacks take 2 MB each: the work goes on with these, though the
# little that is left may not be enough for the bake.
got=0
# shellcheck disable=SC3045 # the shells of Debian, dash and bash, have -v
(ulimit -v 450000 && "$KILN" bake sky.exr -o few.ktx2 --size 8 --exposure -8 --threads 256) >log/out 2>log/err || got=$?
grep -q "^kiln: note: [0-9]* of 256 threads work, the system starts no more$" log/err || die "no note on threads"
[ $got = 0 ] || grep -q "^kiln: out of memory" log/err || die "too few threads: exit $got"
rm -f few.ktx2
# shellcheck disable=SC2086
only $files out.ktx2 empty.exr text.exr
echo before | cmp - out.ktx2 || die "out.ktx2 was touched"
if [ -e /dev/full ]; then
    got=0
    "$KILN" info sky.exr >/dev/full 2>log/err || got=$?
    [ $got = 1 ] && grep -q 'standard output' log/err || die "/dev/full: exit $got"
fi
# shellcheck disable=SC2086
# A reader that stops reading is no failure worth a sentence.
"$KILN" info $files 2>log/err | head -n 1 >log/out
[ ! -s log/err ] || die "SIGPIPE"
passed

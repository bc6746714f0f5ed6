#!/bin/sh
# kiln render --error in an environment: the figures of every way to look reflections up, which need
# three tables of lobes and take some seconds of processor time.
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"

expect 0 "" sky -o sky.exr --size 32
expect 0 "" render sky.exr -o a.png --error --alone --size 32x18 --samples 1 --noise 0.3 --bake-size 64
grep -q 'error RMS' log/out || die "no error is told"
# The sun of the sky is bright in all bands, where bent reflections may be better than one lookup.
awk '$1 == "all" { exit !($5 < $4 && $8 < $6) }' log/out ||
    die "bent is not better than straight, or three not better than one: $(cat log/out)"
expect 0 "" render sky.exr -o a.png --reflections one --size 64x36 --samples 1 --bake-size 64
expect 0 "" render sky.exr -o b.png --reflections one --size 64x36 --samples 1 --bake-size 64
same a.png b.png
expect 0 "" render sky.exr -o b.png --reflections bent --size 64x36 --samples 1 --bake-size 64
cmp -s a.png b.png && die "--reflections changes nothing"
passed

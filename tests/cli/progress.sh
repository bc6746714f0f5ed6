#!/bin/sh
# Progress is drawn on a terminal, for long work, and cleaned away; nowhere else.
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"

expect 0 "" sky -o sky.exr --size 64 -q
long="bake sky.exr -o out.ktx2 --exposure -8 --method textbook --samples 8000 --size 32 --threads 1"
short="bake sky.exr -o out.ktx2 --exposure -8 --size 16"
return=$(printf '\r')

# Runs on a pseudo-terminal; what appears there goes to log/out.
on_terminal() { script -q -e -c "'$KILN' $1" /dev/null </dev/null >log/out; }

on_terminal "$long --quiet"
[ ! -s log/out ] || die "quiet work says something"
on_terminal "$long"
grep -q ' [0-9]* %' log/out || die "no progress on a terminal"
# The last thing before the summary is an empty line and a return.
grep -q " $return""out.ktx2: " log/out || die "the line is not cleaned away"
# Unless the machine is so busy that short work is long.
on_terminal "$short"
grep -q ' 0\.[0-4][0-9] s' log/out && grep -q '%' log/out && die "progress for short work"

# shellcheck disable=SC2086 # several words
expect 0 "" $long
checks=$((checks + 3))
passed

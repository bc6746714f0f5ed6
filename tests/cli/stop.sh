#!/bin/sh
# Signals in the middle of the work: exit 130 or 143 and nothing left behind.
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"

expect 0 "" sky -o sky.exr --size 128 -q
export long="--method textbook --samples 5000 --size 256"

# stop SIGNAL CODE AFTER kiln-arguments...: sends the signal when the command AFTER succeeds.
stop() {
    signal=$1
    code=$2
    after=$3
    shift 3
    checks=$((checks + 1))
    # A shell starts background work with SIGINT ignored; env undoes that.
    env --default-signal=INT,TERM,HUP "$KILN" "$@" >log/out 2>log/err &
    pid=$!
    until $after; do
        kill -0 $pid 2>/dev/null || die "kiln $*: ended too soon"
    done
    kill -s "$signal" $pid || die "kiln $*: ended too soon"
    got=0
    wait $pid || got=$?
    [ $got = "$code" ] || die "kiln $*: exit $got after $signal, not $code"
    [ ! -s log/err ] || die "kiln $*: says something after $signal"
    only sky.exr
}
moment() { sleep 0.3; }
temporary() { ls ./*.tmp >log/ls 2>&1; }

# shellcheck disable=SC2086 # $long is several words
{
    stop INT 130 moment bake sky.exr -o out.ktx2 $long
    stop TERM 143 moment bake sky.exr -o out.ktx2 $long
    stop HUP 129 moment bake sky.exr -o out.ktx2 $long --threads 1
    stop INT 130 moment bake sky.exr -o out.ktx2 --size 2048 --format rgba32f
    stop INT 130 moment tables --method textbook -o out.exr --size 1024 --samples 2000
    stop INT 130 moment tables --assignment -o out --size 1024
    [ ! -e out ] || die "a folder with nothing in it"
}
# While the file is being written.
stop INT 130 temporary bake sky.exr -o out.ktx2 --size 1024 --levels 1 --format rgba32f
stop TERM 143 temporary bake sky.exr -o 'out_%s.exr' --size 1024 --levels 1 --format rgba32f

# Waiting for input that does not come.
mkfifo pipe
sleep 5 >pipe &
sleeper=$!
env --default-signal=INT "$KILN" bake - -o out.ktx2 <pipe >log/out 2>log/err &
pid=$!
sleep 0.3
kill -s INT $pid
got=0
wait $pid || got=$?
kill $sleeper
[ $got = 130 ] || die "waiting for standard input: exit $got"
rm pipe
only sky.exr

# What nohup ignores stays ignored.
(trap '' HUP && exec "$KILN" bake sky.exr -o out.ktx2 -q --exposure -8 --method textbook --size 64 \
    --samples 5000) &
pid=$!
sleep 0.3
kill -s HUP $pid
wait $pid || die "SIGHUP was ignored on entry, but stopped the work"
passed

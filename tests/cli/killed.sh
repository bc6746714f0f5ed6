#!/bin/sh
# A set of files that `kiln bake` overwrites: the command is killed at 200 moments, runs beside another writer of the
# same set, and meets a limit on the size of files. Each file is at all times one of the two skies' files, byte by byte.
# shellcheck source=lib.sh disable=SC2086 # $options and $set are several words
. "$(dirname "$0")/lib.sh"

MOMENTS=200
ROUNDS=8

# 24 faces, 6 faces of irradiance and harmonics. The irradiance is the largest part, so that a limit on the size of files
# can fail after the levels were written.
export options="--size 8 --levels 4 --irradiance-size 16 --threads 1 -q"
export set="-o set/ --irradiance set/i.exr --sh set/s.json"
# sums FOLDER: a line with checksum, size and name for each file that is not a temporary one.
sums() { (cd "$1" && cksum ./*.exr ./*.json) }
# Every file is whole, and of one of the two skies.
all_whole() {
    checks=$((checks + 1))
    sums set >log/now
    [ "$(wc -l <log/now)" = 31 ] || die "$1: $(wc -l <log/now) files, not 31"
    ! grep -vxF -f log/both log/now || die "$1: a file is not whole"
}
# The set is that of sky a or that of sky b, and nothing else is in the folder.
one_set() {
    all_whole "$1"
    cmp -s log/now log/a || cmp -s log/now log/b || die "$1: files of both skies"
    [ "$(find set -type f | wc -l)" = 31 ] || die "$1: files are left: $(ls set)"
}

expect 0 "" sky -o a.exr --size 16 -q
expect 0 "" sky -o b.exr --size 16 --elevation 70 -q
mkdir set
for sky in a b; do
    expect 0 "" bake $sky.exr $options $set
    sums set >log/$sky
done
cat log/a log/b | sort -u >log/both
[ "$(wc -l <log/both)" = 62 ] || die "some files of the two skies are alike"
one_set "one writer"

# The moments lie evenly over a span of time, in 40 steps. How long a run takes changes with what else the machine does,
# so the span follows: a run that had ended before its moment makes the span a tenth shorter, a run that is killed makes
# the span longer by a twenty-fifth. About 7 in 10 runs are killed then, whatever the machine does.
start=$(date +%s%N)
expect 0 "" bake a.exr $options $set
span=$((($(date +%s%N) - start) / 1000))
alive=0
caught=0
moment=0
while [ $moment -lt $MOMENTS ]; do
    [ $((moment % 2)) = 0 ] && sky=b || sky=a
    "$KILN" bake $sky.exr $options $set &
    pid=$!
    delay=$((moment * 7 % 40 * span / 40))
    sleep "$(printf '%d.%06d' $((delay / 1000000)) $((delay % 1000000)))"
    if kill -KILL $pid 2>log/kill; then
        alive=$((alive + 1))
        span=$((span + span / 25))
    else
        span=$((span - span / 10))
    fi
    wait $pid 2>log/wait || true
    [ $((moment % 4)) != 0 ] || all_whole "moment $moment"
    for left in set/kiln-*.tmp; do
        [ ! -e "$left" ] || caught=$((caught + 1))
        break
    done
    moment=$((moment + 1))
done
[ $alive -gt $((MOMENTS / 4)) ] || die "only $alive of $MOMENTS runs were killed"
[ $caught -gt $((MOMENTS / 20)) ] || die "only $caught of $MOMENTS moments left temporary files"
echo "$alive of $MOMENTS runs were killed, $caught left temporary files"
expect 0 "" bake a.exr $options $set
one_set "after $MOMENTS kills"
cmp log/now log/a || die "the last run wrote another set"

# Two writers at once.
round=0
while [ $round -lt $ROUNDS ]; do
    "$KILN" bake a.exr $options $set &
    first=$!
    "$KILN" bake b.exr $options $set || die "round $round: the second writer failed"
    wait $first || die "round $round: the first writer failed"
    one_set "round $round"
    round=$((round + 1))
done

# A limit on the size of files stands for a full disk: 0 blocks fail in the levels, 2 in the irradiance.
expect 0 "" bake a.exr $options $set
for pair in 0-px_0.exr 2-i_px.exr; do
    blocks=${pair%%-*}
    file=${pair#*-}
    got=0
    # The shell's limit holds for its own files too, so the sentence comes through a pipe.
    message=$( (ulimit -f $blocks && "$KILN" bake b.exr $options $set) 2>&1) || got=$?
    case $got-$message in
    "1-kiln: set/$file: cannot write "*" bytes: "*) ;;
    *) die "$blocks blocks: exit $got: $message" ;;
    esac
    one_set "$blocks blocks"
    cmp log/now log/a || die "$blocks blocks: the old set is not there"
done
passed

#!/bin/sh
# `kiln batch` is killed with SIGKILL at 50 moments. The next run bakes what is missing, and all files are, byte by byte,
# those of a run that nothing disturbed.
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"

MOMENTS=50
ENVIRONMENTS=8

mkdir in want out
elevation=0
while [ $elevation -lt $ENVIRONMENTS ]; do
    "$KILN" sky -o in/sky$elevation.exr --size 16 --elevation $((5 * elevation + 2)) -q || die "no sky"
    elevation=$((elevation + 1))
done
# batch FOLDER: each environment becomes a cube, six faces of irradiance and harmonics.
batch() {
    exec "$KILN" batch in -o "$1/{name}.ktx2" --irradiance "$1/{name}_i.exr" --irradiance-size 4 --sh "$1/{name}.json" \
        --size 8 --exposure -8 -q -j2
}
(batch want) || die "the undisturbed run failed"
[ "$(find want -type f -not -path '*/.kiln/*' | wc -l)" = $((8 * ENVIRONMENTS)) ] || die "files are missing: $(ls want)"

# The span over which the moments lie follows the length of a run, as in killed.sh.
start=$(date +%s%N)
(batch want)
span=$((($(date +%s%N) - start) / 1000 + 20000))
alive=0
left=0
partly=0
moment=0
while [ $moment -lt $MOMENTS ]; do
    [ $((moment % 5)) != 0 ] || rm -rf out/* out/.kiln
    (batch out) &
    pid=$!
    delay=$((moment * 7 % 25 * span / 25))
    sleep "$(printf '%d.%06d' $((delay / 1000000)) $((delay % 1000000)))"
    if kill -KILL $pid 2>log/kill; then
        alive=$((alive + 1))
        span=$((span + span / 10))
    else
        span=$((span - span / 10))
    fi
    wait $pid 2>log/wait || true
    have=$(find out -name '*.ktx2' | wc -l)
    [ "$have" = 0 ] || [ "$have" = $ENVIRONMENTS ] || partly=$((partly + 1))
    set -- out/kiln-*.tmp
    [ ! -e "$1" ] || left=$((left + 1))
    # Whatever is there under its name is whole.
    LC_ALL=C diff -r -q -x .kiln out want >log/diff || true
    ! grep -v '^Only in want: \|^Only in out: kiln-.*\.tmp$' log/diff || die "moment $moment: a file is not whole"
    # Now and then the next run is not killed.
    if [ $((moment % 5)) = 4 ]; then
        (batch out) || die "moment $moment: the next run failed"
        diff -r -x .kiln want out >log/diff || die "moment $moment: other files than those of an undisturbed run"
        checks=$((checks + 1))
    fi
    moment=$((moment + 1))
done
echo "$alive of $MOMENTS runs were killed, $partly left a part of the files, $left left temporary files"
[ $alive -gt $((MOMENTS / 4)) ] || die "only $alive of $MOMENTS runs were killed"
[ $partly -gt $((MOMENTS / 25)) ] || die "only $partly of $MOMENTS moments left a part of the files"
expect 0 "" batch in -o "out/{name}.ktx2" --irradiance "out/{name}_i.exr" --irradiance-size 4 --sh "out/{name}.json" \
    --size 8 --exposure -8
grep -q "^$ENVIRONMENTS environments: 0 baked, $ENVIRONMENTS kept" log/out || die "the last run baked something: $(cat log/out)"

# A signal that asks to stop: exit 143, whole files only, and the next run bakes what is missing.
rm -rf out/* out/.kiln
env --default-signal=TERM "$KILN" batch in -o "out/{name}.ktx2" --size 128 --exposure -8 -q -j1 &
pid=$!
until [ "$(find out -name '*.ktx2' | wc -l)" -ge 2 ]; do
    kill -0 $pid 2>log/kill || die "the batch ended before the signal"
done
kill -TERM $pid
got=0
wait $pid || got=$?
[ $got = 143 ] || die "after SIGTERM: exit $got"
! find out -name '*.tmp' | grep . || die "temporary files are left after SIGTERM"
have=$(find out -name '*.ktx2' | wc -l)
[ "$have" -lt $ENVIRONMENTS ] || die "SIGTERM came too late"
expect 0 "" batch in -o "out/{name}.ktx2" --size 128 --exposure -8
grep -q "^$ENVIRONMENTS environments: $((ENVIRONMENTS - have)) baked, $have kept" log/out || die "after SIGTERM: $(cat log/out)"
checks=$((checks + 4))
passed

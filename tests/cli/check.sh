#!/bin/sh
# kiln check: right and wrong files, exit codes, JSON and the picture.
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"

expect 0 "" sky -o sky.exr --size 64 --elevation 30 --azimuth 50 --quiet
expect 0 "" bake sky.exr -o right.ktx2 --size 32 --levels 4 --format rgba32f --sh sh.json -q
expect 0 "" bake sky.exr -o mirrored.ktx2 --size 32 --levels 4 --format rgba32f --mirror -q
expect 0 "" tables --table dfg --size 32 -o table.exr -q

expect 0 "" check sky.exr right.ktx2 sh.json
grep -q '^right.ktx2: right, the largest error of a level is ' log/out || die "right levels"
grep -q '^sh.json: right, 3 bands of harmonics with an error of ' log/out || die "right harmonics"
grep -q '  note   the axes are those of kiln' log/out || die "the axes"
expect 0 "" check --table table.exr
grep -q 'note   the channels hold A, B, 0, of ggx with the masking smith' log/out || die "the table"

# A wrong file: exit code 1, a sentence, and the report on standard output.
wrong() {
    checks=$((checks + 1))
    got=0
    "$KILN" check "$@" >log/out 2>log/err || got=$?
    [ $got = 1 ] || die "kiln check $*: exit $got, not 1"
    grep -q '^kiln: 1 of 1 file is wrong$' log/err || die "kiln check $*: the sentence"
}
wrong sky.exr mirrored.ktx2
grep -q '^mirrored.ktx2: WRONG' log/out || die "a mirrored file"
grep -q 'WRONG  the environment is mirrored: left and right are swapped' log/out || die "the mirror"
wrong sky.exr right.ktx2 --for filament -q
[ ! -s log/out ] || die "--quiet prints"

# Levels that are tuned for an engine are not exact, and right; a fault in them is still found.
expect 0 "" bake sky.exr -o tuned.ktx2 --for three -q
expect 0 "" check sky.exr tuned.ktx2
grep -q '^tuned.ktx2: right, tuned for three$' log/out || die "tuned levels"
grep -q 'note   the levels are not exact, and right because three shows less error' log/out || die "the reason"
expect 0 "" bake sky.exr -o tuned.ktx2 --for three --mirror -q
wrong sky.exr tuned.ktx2 --for three
grep -q 'WRONG  the environment is mirrored' log/out || die "the mirror of tuned levels"

# A tolerance below the rounding of halfs, and above.
expect 0 "" bake sky.exr -o half.ktx2 --size 32 --levels 4 -q
expect 0 "" check sky.exr half.ktx2 --tolerance 0.001
wrong sky.exr half.ktx2 --tolerance 0.00001
grep -q '^half.ktx2: WRONG, the largest error of a level is 0.0' log/out || die "the tolerance"

! "$KILN" check sky.exr right.ktx2 none.ktx2 --json >log/out 2>log/err || die "a missing file"
grep -q '^kiln: none.ktx2: ' log/err || die "the sentence about a missing file"
[ "$(wc -l <log/err)" = 1 ] || die "one sentence about a missing file"
node -e '
    const [right, none] = JSON.parse(require("fs").readFileSync("log/out"));
    const [first, second] = right.levels.levels;
    const good = right.path === "right.ktx2" && right.levels.right && right.levels.worst < 1e-4 &&
        first.size === 32 && first.roughness === 0 && second.size === 16 && second.proof < 1e-5 &&
        second.proof_texels === 16 && right.harmonics.right && right.harmonics.bands.length === 3 &&
        none.error.includes("none.ktx2");
    process.exit(good ? 0 : 1);' || die "JSON"

expect 0 "" check sky.exr half.ktx2 --picture errors.png -q
expect 0 "" info errors.png --json
grep -q '"width":	256' log/out || die "the width of the picture"
grep -q '"height":	512' log/out || die "the height of the picture"

expect 2 "no input is named" check
expect 2 "no file to check is named" check sky.exr
expect 2 "right.ktx2 has 4 levels, and sky.exr is a panorama: name the panorama first" check right.ktx2 sky.exr
checks=$((checks + 1))
"$KILN" check - right.ktx2 -q <sky.exr || die "a panorama on standard input"
expect 2 "no table is named" check --table
expect 2 "takes neither --for nor --picture" check --table table.exr --for three
expect 2 "picture a.exr: must end in .png" check sky.exr half.ktx2 --picture a.exr
expect 2 "takes one file to check, 2 are named" check sky.exr half.ktx2 right.ktx2 --picture a.png
expect 2 "tolerance is -1" check sky.exr half.ktx2 --tolerance -1
only sky.exr right.ktx2 mirrored.ktx2 half.ktx2 sh.json table.exr tuned.ktx2 errors.png
passed

#!/bin/sh
# Bakes that work: what is written, where, and that it says the same by every way.
good=$(cd "$(dirname "$0")/../files/good" && pwd)
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"

expect 0 "" sky -o sky.exr --size 64 --elevation 20 --quiet
[ ! -s log/out ] || die "quiet is not quiet"
export small="--size 16 --exposure -8"

# shellcheck disable=SC2086 # $small is several words
{
    expect 0 "" bake sky.exr -o a.ktx2 $small
    [ "$(wc -l <log/out)" = 1 ] || die "one line says what was done"
    only sky.exr a.ktx2
    # By standard input, another number of threads, and over a file that is there.
    "$KILN" bake - -o b.ktx2 $small -q <sky.exr || die "standard input"
    same a.ktx2 b.ktx2
    expect 0 "" bake sky.exr -o b.ktx2 $small -q --threads 3
    same a.ktx2 b.ktx2
    cp sky.exr -- -sky.exr
    expect 0 "" bake $small -q -o b.ktx2 -- -sky.exr
    same a.ktx2 b.ktx2
    rm -- -sky.exr b.ktx2 a.ktx2

    # --zstd without a level does not take the next word for one.
    if [ "${KILN_ZSTD:-ON}" = ON ]; then
        expect 0 "" bake $small --zstd sky.exr -o z.ktx2
        expect 0 "" bake $small --zstd=3 sky.exr -o y.ktx2
        same y.ktx2 z.ktx2
        rm y.ktx2 z.ktx2
    else
        expect 1 "z.ktx2: this build of kiln has no zstd, which" bake $small --zstd sky.exr -o z.ktx2
        [ ! -e z.ktx2 ] || die "a refused file is there"
    fi

    # Everything at once, with a report that is JSON and tells the truth.
    expect 0 "" bake sky.exr -o a.ktx2 $small --irradiance d.ktx2 --irradiance-size 8 \
        --sh sh.json --sh-bands 4 --sh-irradiance --sh-window 6 --mirror --rotate -30 --json
    node -e '
        const report = JSON.parse(require("fs").readFileSync("log/out", "utf8"));
        const wanted = [16, 8, 4, 2, 1];
        const good = report.output.file_count === 3 && report.output.level_count === 5 &&
            report.input.width === 128 && report.input.height === 64 &&
            report.input.shape === "panorama" && report.output.shape === "cube" &&
            report.output.levels.every((l, i) => l.size === wanted[i] && l.roughness === i / 4) &&
            report.degree > 0 && report.seconds.total > 0 && report.peak_memory.process > 0;
        const sh = JSON.parse(require("fs").readFileSync("sh.json", "utf8"));
        process.exit(good && sh ? 0 : 1);' || die "the report"
    only sky.exr a.ktx2 d.ktx2 sh.json
    expect 0 "" info --json a.ktx2 d.ktx2 sky.exr
    node -e '
        const [a, d, sky] = JSON.parse(require("fs").readFileSync("log/out", "utf8"));
        const good = a.format === "ktx2" && a.width === 16 && a.level_count === 5 &&
            a.face_count === 6 && a.roughness.length === 5 && a.roughness[1] === 0.25 &&
            a.sh_radiance.length === 16 && a.sh_radiance[0].length === 3 &&
            d.width === 8 && d.level_count === 1 && sky.format === "exr" && sky.width === 128 &&
            sky.layout === "panorama";
        process.exit(good ? 0 : 1);' || die "info"
    expect 0 "" info a.ktx2
    grep -q '5 levels' log/out || die "info in words"
    # The layers of an EXR file, and one of them by its name.
    expect 0 "" info --json "$good/dwaa-layers.exr"
    node -e '
        const [a] = JSON.parse(require("fs").readFileSync("log/out", "utf8"));
        const wanted = [["A", "B, G, R", false], ["", "B, G, R, Y, Z", true],
            ["left", "A, B, G, R", false]];
        process.exit(a.part_count === 1 && a.layer_count === 3 && a.layers.every((l, i) =>
            l.name === wanted[i][0] && l.channels === wanted[i][1] && l.picture === wanted[i][2])
            ? 0 : 1);' || die "layers"
    expect 0 "layer left (channels R, G, B), one of 3 layers, is the picture" \
        bake "$good/dwaa-layers.exr" -o e.ktx2 --layout panorama --layer left --size 16
    expect 1 "has no picture or channel named right" \
        bake "$good/dwaa-layers.exr" -o d.ktx2 --layout panorama --layer right --size 16
    # Irradiance of a cube, and beside a level that needs fewer degrees than the cosine.
    expect 0 "" bake a.ktx2 -o e.ktx2 -q --size 16 --irradiance d.ktx2
    expect 0 "" bake sky.exr -o e.ktx2 -q --size 16 --roughness 0.5 --irradiance d.ktx2
    rm a.ktx2 d.ktx2 e.ktx2 sh.json

    # Six faces, by pattern, as a folder, in any order: the same cube.
    expect 0 "" bake sky.exr -o 'face_%s.exr' $small --levels 1 --format rgba32f -q
    only sky.exr face_px.exr face_nx.exr face_py.exr face_ny.exr face_pz.exr face_nz.exr
    expect 0 "" bake 'face_%s.exr' -o a.dds --size 8
    expect 0 "" bake face_nx.exr face_ny.exr face_nz.exr face_px.exr face_py.exr face_pz.exr \
        -o b.dds --size 8
    same a.dds b.dds
    expect 0 "" bake 'face_{face}.exr' -o b.dds --size 8
    same a.dds b.dds
    mkdir folder
    for face in px nx py ny pz nz; do mv face_$face.exr folder/$face.exr; done
    expect 0 "" bake folder -o b.dds --size 8
    same a.dds b.dds
    i=0
    for face in px nx py ny pz nz; do mv folder/$face.exr $i.exr && i=$((i + 1)); done
    expect 0 "" bake 0.exr 1.exr 2.exr 3.exr 4.exr 5.exr -o b.dds --size 8
    same a.dds b.dds
    expect 1 "must be square" bake sky.exr sky.exr sky.exr sky.exr sky.exr sky.exr -o b.dds
    rm ./[0-5].exr ./*.dds

    # Panoramas, one file a level, by the textbook and exactly.
    for method in exact textbook; do
        expect 0 "" bake sky.exr -o "$method"'_%d.hdr' --shape panorama --method $method \
            --size 16 --levels 2 --exposure -8
    done
    only sky.exr exact_0.hdr exact_1.hdr textbook_0.hdr textbook_1.hdr
    rm ./*.hdr
    expect 0 "" bake sky.exr -o t.ktx2 $small --method textbook --lobe lambert --phi-steps 20 \
        --theta-steps 10
    expect 0 "" bake sky.exr -o t.ktx2 $small --lobe charlie --roughness 0.2,0.5
    expect 0 "" bake sky.exr -o t.ktx2 $small --lobe phong --format rgb9e5 --verbose
    grep -q 'level 4 .* size 1 ' log/out || die "verbose names the levels"
    rm t.ktx2

    # Light beyond what halves hold is cut off, and said to be.
    expect 0 "kiln: warning: t.ktx2: .* above 65504 .* --exposure 5 keeps" bake sky.exr -o t.ktx2 \
        --size 16 --exposure 10
    expect 0 "" bake sky.exr -o t.ktx2 --size 16 --exposure 10 --quiet
    expect 0 "" bake sky.exr -o t.ktx2 --size 16 --exposure 10 --format rgba32f
    rm t.ktx2

    # Texels that are negative, infinite or not a number, behind the 148 bytes of the header of a cube
    # of floats.
    expect 0 "" bake sky.exr -o odd.dds --format rgba32f --size 2 --levels 1
    put() { printf "$2" | dd of=odd.dds bs=1 seek=$((148 + 16 * $1)) conv=notrunc 2>/dev/null; }
    put 0 '\000\000\172\304' # -1000
    put 5 '\000\000\200\177' # infinity
    put 9 '\000\000\300\177' # not a number
    expect 0 "^kiln: warning: odd.dds: 1 of 24 texels is infinite and became 65504$" \
        bake odd.dds -o t.ktx2 --size 4 --json
    for line in "warning: odd.dds: 1 of 24 texels is not a number and became the mean of the texels around" \
        "note: odd.dds: 1 of 24 texels is negative and kept, with 1.[0-9]* % of the light" \
        "warning: t.ktx2: [0-9]* of 378 values were negative, with [0-9.]* % of the light, and became 0"; do
        grep -q "^kiln: $line$" log/err || die "no line of standard error says: $line"
    done
    for member in '"texel_count":	24' '"infinite_count":	1' '"nan_count":	1' '"negative_count":	1'; do
        grep -q "$member" log/out || die "--json has no $member"
    done
    grep -q '"notes":.*infinite.*not a number.*negative and kept' log/out || die "--json has the notes"
    expect 0 "is negative and became 0" bake odd.dds -o z.ktx2 --size 4 --negative zero
    if grep -q "z.ktx2" log/err; then die "nothing is cut off of a source without negative texels"; fi
    expect 0 "" bake odd.dds -o q.ktx2 --size 4 --quiet
    same t.ktx2 q.ktx2
    if cmp -s t.ktx2 z.ktx2; then die "--negative has no effect"; fi
    expect 2 "--negative is 'drop', it must be" bake odd.dds -o t.ktx2 --negative drop
    rm odd.dds ./*.ktx2
}

# Standard output holds the bytes of the file and nothing else.
expect 0 "" bake sky.exr -o a.ktx2 --size 16
"$KILN" bake sky.exr -o - --size 16 >b.ktx2 2>log/err || die "standard output"
same a.ktx2 b.ktx2
expect 0 "" bake sky.exr -o a.dds --size 16
"$KILN" bake sky.exr -o -.dds --size 16 | cat >b.dds
same a.dds b.dds
expect 0 "" bake sky.exr -o a.hdr --size 16 --shape panorama --levels 1
"$KILN" bake sky.exr -o -.hdr --size 16 --shape panorama --levels 1 >b.hdr
same a.hdr b.hdr
"$KILN" bake sky.exr -o - --size 16 --exposure 20 >b.ktx2 2>log/err || die "cut off"
grep -q '^kiln: warning: standard output: [0-9]* values above 65504 ' log/err || die "the output's name"
if [ -e /dev/full ]; then
    code=0
    "$KILN" bake sky.exr -o - --size 16 >/dev/full 2>log/err || code=$?
    [ $code = 1 ] || die "a full device gives exit code $code"
    grep -q "standard output: " log/err || die "a full device is not named"
fi

# Several environments: each is written, a failure gives exit code 1 and does not stop the others.
mkdir in out
"$KILN" sky -o in/low.v2.exr --size 16 --elevation 5 -q
cp sky.exr in/sky.exr
echo nothing >in/bad.exr
expect 0 "" bake in/sky.exr in/low.v2.exr -o 'out/{name}.ktx2' --size 16 --sh 'out/{name}.json'
same a.ktx2 out/sky.ktx2
[ -s out/low.v2.ktx2 ] && [ -s out/low.v2.json ] || die "the second environment is missing"
rm out/*
code=0
"$KILN" bake in/bad.exr in/sky.exr -o 'out/{name}.ktx2' --size 16 >log/out 2>log/err || code=$?
[ $code = 1 ] || die "a failed input gives exit code $code"
grep -q "^kiln: in/bad.exr: " log/err || die "the failed input is not named"
same a.ktx2 out/sky.ktx2
[ "$(wc -l <log/out)" = 1 ] || die "one line for each environment"
# The name of a folder and of a pattern of faces.
mkdir in/hall
expect 0 "" bake sky.exr -o in/hall/ --size 8 --levels 1
expect 0 "" bake sky.exr -o 'in/yard_%s.exr' --size 8 --levels 1
expect 0 "" bake in/hall 'in/yard_{face}.exr' -o 'out/{name}.ktx2' --size 8
same out/hall.ktx2 out/yard.ktx2
for nameless in . .. in/..; do
    expect 2 "^kiln: $nameless has no name that could take the place of {name}" \
        bake "$nameless" -o 'out/{name}.ktx2'
done
# Folders and patterns of faces are described as cubes.
for faces in in/hall 'in/yard_{face}.exr'; do
    expect 0 "" info "$faces"
    grep -q '^  layout       cube, 8 x 8, 6 faces, 3 channels$' log/out || die "$faces: layout"
    expect 0 "" info --json "$faces"
    grep -q "\"byte_count\":[[:space:]]$(cat in/hall/*.exr | wc -c)," log/out || die "$faces: bytes"
done
expect 1 "^kiln: log: holds no six faces" info log
# A cube that no memory can hold is refused before the work. This one has 103 GB.
memory=$(sed -n 's/^MemTotal: *\([0-9]*\) kB$/\1/p' /proc/meminfo)
if [ "${memory:-100000000}" -lt 90000000 ]; then
    expect 1 "^kiln: --size 32768: the levels take 103 GB of memory, and kiln may use .*; choose a smaller size" \
        bake sky.exr -o out/big.ktx2 --size 32768
fi
rm -r in out ./*.ktx2 ./*.dds ./*.hdr

expect 0 "" tables --method textbook -o t.exr --size 16 --samples 16
expect 0 "" tables --method textbook -o t.png --size 16 --samples 16 -q
only sky.exr t.exr t.png
passed

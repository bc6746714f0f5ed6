#!/bin/sh
# kiln batch: files equal to those of kiln bake, what is baked again after which change, the words about wrong
# manifests, parts of a list, and the rule for make.
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"

# outcome LINE-OF-COUNTS kiln-arguments...: a batch that succeeds with these counts in its summary.
outcome() {
    want=$1
    shift
    checks=$((checks + 1))
    "$KILN" batch "$@" >log/out 2>log/err || die "kiln batch $*: exit $?"
    ! grep -v '^kiln: note: ' log/err || die "kiln batch $*: says more than notes"
    grep -q "environments*: $want; " log/out || die "kiln batch $*: not '$want'"
}
# refused CODE SENTENCE LINE: a manifest of one line after an empty one.
refused() {
    code=$1
    sentence=$2
    printf '\n%s\n' "$3" >wrong.jsonl
    expect "$code" "$sentence" batch wrong.jsonl
}
bake() { "$KILN" bake "$@" -q || die "kiln bake $*"; }

mkdir in out want
for elevation in 10 30 50; do
    expect 0 "" sky -o in/sky$elevation.exr --size 32 --elevation $elevation -q
done
cp in/sky50.exr 'in/a $# name.exr'
# Two environments whose files have one size.
mkdir more
for elevation in 30 50; do
    bake in/sky$elevation.exr -o more/cube$elevation.dds --size 16 --levels 1 --exposure -8
done
mv more/cube30.dds more/cube.dds

# A folder, and a pattern, to files equal to those of kiln bake.
options="--size 16 --exposure -8 --levels 3"
# shellcheck disable=SC2086 # several words
{
    outcome "4 baked, 0 kept" in -o 'out/{name}.ktx2' $options
    for name in sky10 sky30 sky50 'a $# name'; do
        bake "in/$name.exr" -o "want/$name.ktx2" $options
        same "want/$name.ktx2" "out/$name.ktx2"
    done
    outcome "0 baked, 4 kept" in -o 'out/{name}.ktx2' $options
    outcome "0 baked, 3 kept" 'in/sky*.exr' -o 'out/{name}.ktx2' $options
    outcome "0 baked, 1 kept" 'in/sky?0.exr' -o 'out/{name}.ktx2' $options --shard 3/3
}

# Folders of outputs are created where they are missing: not by a dry run, and only those of a part's own files.
for name in a/b/1 a/b/2 a/c/3; do
    echo "{\"input\": \"in/sky10.exr\", \"output\": \"tree/$name.ktx2\", \"size\": 8, \"sh\": \"tree/sh/$name.json\"}"
done >tree.jsonl
"$KILN" batch tree.jsonl --dry-run >log/out || die "a dry run of a tree"
[ ! -e tree ] || die "a dry run creates folders"
outcome "1 baked, 0 kept, 6 folders created" tree.jsonl --shard 3/3
[ ! -e tree/a/b ] || die "a part of a batch creates the folders of another part"
outcome "2 baked, 1 kept, 2 folders created" tree.jsonl --depfile tree.d
grep -q 'tree/sh/a/b/2.json' tree.d || die "the rule for make leaves a file out"
same tree/a/b/1.ktx2 tree/a/c/3.ktx2
outcome "0 baked, 3 kept" tree.jsonl

# A manifest: each kind of option, and every kind of file that a bake writes.
cat >list.jsonl <<'LIST'
{"input": "in/sky10.exr", "output": "out/three.ktx2", "for": "three", "tune": "none", "size": 64}
{"input": "more/cube.dds", "output": "out/ex.dds", "exposure": 1.5, "rotate": [30, 10, 0], "sh": "out/sh.json",
 "sh-bands": 2, "levels": 2}

{"input": ["in/sky10.exr", "in/sky30.exr"], "output": "out/s_{name}_%d.hdr", "shape": "panorama", "size": 8}
{"input": "in/sky50.exr", "output": "out\/\u007a.ktx2", "zstd": true, "mirror": true, "size": 8, "exposure": null,
 "irradiance": "out/faces/", "irradiance-size": 4}
{"input": "in/sky50.exr", "output": "out/lights.ktx2", "sun": "extract", "lights-file": "out/lights.json",
 "mirror": false}
LIST
mkdir out/faces want/faces
outcome "6 baked, 0 kept" list.jsonl --exposure -8 --size 16 --mirror
bake in/sky10.exr -o want/three.ktx2 --for three --tune none --size 64 --mirror --exposure -8
bake more/cube.dds -o want/ex.dds --exposure 1.5 --rotate 30,10,0 --sh want/sh.json --sh-bands 2 --levels 2 \
    --size 16 --mirror
for name in sky10 sky30; do
    bake in/$name.exr -o "want/s_${name}_%d.hdr" --shape panorama --size 8 --exposure -8 --mirror
done
bake in/sky50.exr -o want/z.ktx2 --zstd --mirror --size 8 --irradiance want/faces/ --irradiance-size 4
bake in/sky50.exr -o want/lights.ktx2 --sun extract --lights-file want/lights.json --size 16 --exposure -8
diff -r -x .kiln want out >log/diff || die "the batch's files are not those of kiln bake"
checks=$((checks + 1))
outcome "0 baked, 6 kept" list.jsonl --exposure -8 --size 16 --mirror

# What is baked again. The content decides, not the time.
again() {
    outcome "0 to be baked, 6 kept" list.jsonl --exposure -8 --size 16 --mirror -n
    eval "$1"
    outcome "$2 to be baked, $((6 - $2)) kept" list.jsonl --exposure -8 --size 16 --mirror --dry-run
    [ "$2" = 0 ] || grep -q "$3" log/out || die "after '$1': not $3"
    outcome "$2 baked, $((6 - $2)) kept" list.jsonl --exposure -8 --size 16 --mirror
    diff -r -x .kiln want out >log/diff || die "after '$1': other files"
}
again "touch in/sky10.exr" 0
again "cp in/sky10.exr log/x; cp log/x in/sky10.exr" 0
again "rm out/sh.json" 1 "out/ex.dds: .*a written file is missing"
again "cp out/three.ktx2 out/z.ktx2" 1 "out/z.ktx2: .*a written file is missing or has changed"
again "printf X | dd of=out/faces/py.exr bs=1 seek=600 conv=notrunc 2>log/dd" 1 "out/z.ktx2: .*has changed"
again "printf x >out/.kiln/ex.dds.record" 1 "out/ex.dds: .*another version"
again "rm out/.kiln/s_sky10_%d.hdr.record" 1 "s_sky10_%d.hdr: .*no record"
again "sed -i 's/^kiln .*/kiln 0.0.1/' out/.kiln/*.record" 6 "another version of kiln"
# Another sky, with the size and the time that the file has had.
cp -p more/cube.dds log/kept
[ "$(wc -c <more/cube50.dds)" = "$(wc -c <log/kept)" ] || die "the two cubes' files have two sizes"
cat more/cube50.dds >more/cube.dds
touch -r log/kept more/cube.dds
outcome "1 baked, 5 kept" list.jsonl --exposure -8 --size 16 --mirror
bake more/cube50.dds -o log/ex.dds --exposure 1.5 --rotate 30,10,0 --levels 2 --size 16 --mirror
same log/ex.dds out/ex.dds
cp -p log/kept more/cube.dds
outcome "1 baked, 5 kept" list.jsonl --exposure -8 --size 16 --mirror
diff -r -x .kiln want out >log/diff || die "the first cube's files are not back"
# A run that was killed after the files and before the record, and an input that is again what it was.
cp out/.kiln/ex.dds.record log/record
cp more/cube50.dds more/cube.dds
outcome "1 baked, 5 kept" list.jsonl --exposure -8 --size 16 --mirror
cp -p log/kept more/cube.dds
cp log/record out/.kiln/ex.dds.record
outcome "1 baked, 5 kept" list.jsonl --exposure -8 --size 16 --mirror
diff -r -x .kiln want out >log/diff || die "files of the other cube were kept"
outcome "6 baked, 0 kept" list.jsonl --exposure -8 --size 16 --mirror --force
outcome "4 baked, 2 kept" list.jsonl --exposure -8 --size 16

# The command line's words, and wrong manifests.
refused 1 '^kiln: wrong.jsonl, line 2: --size is .x., it must be a whole number' \
    '{"input": "in/sky10.exr", "output": "o.ktx2", "size": "x"}'
refused 1 '^kiln: wrong.jsonl, line 2: "sise": no such option of bake, .*size' \
    '{"input": "in/sky10.exr", "output": "o.ktx2", "sise": 8}'
refused 1 '^kiln: wrong.jsonl, line 2: "size" is given twice$' \
    '{"input": "in/sky10.exr", "output": "o.ktx2", "size": 8, "size": 9}'
refused 1 '^kiln: wrong.jsonl, line 2: "threads" is for the whole batch' \
    '{"input": "in/sky10.exr", "output": "o.ktx2", "threads": 8}'
refused 1 '^kiln: wrong.jsonl, line 2: "input" is missing$' '{"output": "o.ktx2"}'
refused 1 '^kiln: wrong.jsonl, line 2: no output: name it by -o OUT$' '{"input": "in/sky10.exr"}'
refused 1 '^kiln: wrong.jsonl, line 2: "mirror" must be true or false$' \
    '{"input": "in/sky10.exr", "output": "o.ktx2", "mirror": 1}'
refused 1 '^kiln: wrong.jsonl, line 2: "size" needs a value$' \
    '{"input": "in/sky10.exr", "output": "o.ktx2", "size": true}'
refused 1 '^kiln: wrong.jsonl, line 2: a text does not end' '{"input": "in/sky10.exr'
refused 1 '^kiln: wrong.jsonl, line 2: a line must be an object' '["in/sky10.exr"]'
refused 1 '^kiln: wrong.jsonl, line 2: an object does not end' '{"input": "a" "output": "b"}'
refused 1 '^kiln: wrong.jsonl, line 2: a value is missing' '{"input": }'
refused 1 '^kiln: wrong.jsonl, line 2: a number is not one' '{"size": 1-2}'
refused 1 '^kiln: wrong.jsonl, line 2: a text has a code' '{"input": "\ud800x"}'
refused 1 '^kiln: wrong.jsonl, line 2: in/none\*: there is no such picture$' \
    '{"input": "in/none*", "output": "{name}.ktx2"}'
refused 1 '^kiln: wrong.jsonl, line 2: --output -: a batch writes files' \
    '{"input": "in/sky10.exr", "output": "-.dds"}'
refused 1 '^kiln: in/sky10.exr and in/sky30.exr would both be written to o.ktx2$' \
    '{"input": ["in/sky10.exr"], "output": "o.ktx2"} {"input": "in/sky30.exr", "output": "o.ktx2"}'
refused 1 '^kiln: p.exr is read and written by one batch' \
    '{"input": "in/sky10.exr", "output": "p.exr", "shape": "panorama", "levels": 1}
    {"input": "p.exr", "output": "q.ktx2"}'
refused 1 '^kiln: in/sky10.exr/a/o.ktx2: the folder in/sky10.exr is a file$' \
    '{"input": "in/sky30.exr", "output": "in/sky10.exr/a/o.ktx2"}'
expect 1 '^kiln: none.jsonl: cannot be read' batch none.jsonl
expect 2 '^kiln: no input is named' batch
expect 2 '^kiln: manifests and pictures cannot be mixed' batch list.jsonl in/sky10.exr -o o.ktx2
expect 2 "^kiln: --shard is '0/3', it must be I/N" batch list.jsonl --shard 0/3
expect 2 "^kiln: --shard is '4/3', it must be I/N" batch list.jsonl --shard 4/3
expect 2 "^kiln: --verbose: no such option" batch list.jsonl --verbose
expect 2 "^kiln: --size is given twice" batch list.jsonl --size 8 --size 9
expect 2 "^kiln: --size is '0', it must\|^kiln: --size is 0, it must" batch in/sky10.exr -o o.ktx2 --size 0
rm -f wrong.jsonl

# One that cannot be read: the batch ends, or goes on with --keep-going; the others' files are whole.
printf 'no picture' >in/bad.exr
# shellcheck disable=SC2086 # several words
{
    rm -r out/* out/.kiln
    cp -r in log/bad
    got=0
    "$KILN" batch log/bad -o 'out/{name}.ktx2' $options -j1 -k >log/out 2>log/err || got=$?
    [ $got = 1 ] || die "--keep-going with a picture that is none: exit $got"
    grep -q '5 environments: 4 baked, 0 kept, 1 failed;' log/out || die "--keep-going: other counts"
    [ "$(grep -c '^kiln: log/bad/bad.exr: ' log/err)" = 1 ] || die "no sentence about the bad picture"
    same want/sky10.ktx2 out/sky10.ktx2
    rm -r out/* out/.kiln
    got=0
    "$KILN" batch log/bad/bad.exr log/bad/sky*.exr log/bad/sky*.exr -o 'out/{name}.ktx2' $options >log/out 2>log/err ||
        got=$?
    [ $got = 1 ] || die "the same picture twice: exit $got"
    grep -q 'would both be written' log/err || die "the same picture twice is not refused"
    got=0
    "$KILN" batch log/bad/bad.exr log/bad/sky*.exr -o 'out/{name}.ktx2' $options -j1 --json >log/out 2>log/err || got=$?
    [ $got = 1 ] || die "a picture that is none: exit $got"
    grep -q '"outcome": "failed", "output": "out/bad.ktx2", "error": "log/bad/bad.exr: ' log/out || die "no JSON of a failure"
    outcome "1 baked, 0 kept" in/sky10.exr -o 'out/{name}.ktx2' $options --force
    checks=$((checks + 5))
}

# Parts: each environment in one part, all in all, and the reports are JSON.
rm -rf out/* out/.kiln
rm in/bad.exr
for part in 1 2 3; do
    expect 0 "" batch in -o 'out/{name}.ktx2' --size 16 --exposure -8 --levels 3 --shard $part/3 --json
    cat log/out >>log/lines
done
[ "$(grep -c '"outcome": "baked"' log/lines)" = 4 ] || die "the parts are not the whole"
for name in sky10 sky30 sky50 'a $# name'; do
    same "want/$name.ktx2" "out/$name.ktx2"
done
if command -v python3 >log/which; then
    python3 -c '
import json
lines = [json.loads(line) for line in open("log/lines")]
assert [s["summary"]["baked"] for s in lines if "summary" in s] == [2, 1, 1], lines
assert sorted(s["output"]["path"] for s in lines if s.get("outcome") == "baked")[1] == "out/sky10.ktx2", lines
' || die "the report is not the JSON that was meant"
    checks=$((checks + 1))
fi

# The rule for make: one bakes again when an input is newer than the stamp, as make says.
cat >Makefile <<'MAKE'
all.stamp:
	"$(KILN)" batch in -o 'out/{name}.ktx2' --size 16 --exposure -8 --levels 3 --depfile all.d --stamp all.stamp
-include all.d
MAKE
if command -v make >log/which; then
    KILN=$KILN make all.stamp >log/make || die "make: $(cat log/make)"
    grep -q '4 environments: 0 baked, 4 kept' log/make || die "make did not run the batch"
    grep -qF 'in/a\ $$\#\ name.exr' all.d || die "the rule's names are not make's"
    KILN=$KILN make all.stamp | grep -q 'up to date' || die "make runs the batch again"
    sleep 0.02
    cat in/sky30.exr >'in/a $# name.exr'
    KILN=$KILN make all.stamp >log/make || die "make: $(cat log/make)"
    grep -q '4 environments: 1 baked, 3 kept' log/make || die "make does not see that an input changed"
    checks=$((checks + 5))
fi
expect 0 "" batch in/sky10.exr -o 'out/{name}.ktx2' --size 16 --exposure -8 --levels 3 --depfile all.d
[ "$(tr -d '\\\n' <all.d | tr -s ' ')" = " out/sky10.ktx2: in/sky10.exr in/sky10.exr" ] || die "a rule without a stamp: $(cat all.d)"

# Memory: bakes wait for each other, and one that needs more than there is says so.
outcome "4 baked, 0 kept" in -o 'out/{name}.ktx2' --size 64 --exposure -8 --memory 64 -j4
for name in sky10 sky30; do
    bake in/$name.exr -o want/m.ktx2 --size 64 --exposure -8
    same want/m.ktx2 out/$name.ktx2
done
got=0
"$KILN" batch in/sky10.exr -o 'out/{name}.ktx2' --size 2048 --format rgba32f --memory 64 -q >log/out 2>log/err || got=$?
[ "$got-$(grep -c '^kiln: out of memory: ' log/err)" = 1-1 ] || die "more memory than there is: exit $got"
checks=$((checks + 1))
passed

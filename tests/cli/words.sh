#!/bin/sh
# How options are written, and what is said about words that are none.
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"

# sky is quick: its report names the rows, which tell what was read.
rows() {
    want=$1
    shift
    expect 0 "" sky "$@"
    grep -q "^sky.exr: panorama of $((2 * want)) x $want," log/out || die "kiln sky $*: not $want rows"
}
rows 16 -o sky.exr --size 16
rows 16 -o sky.exr --size=16
rows 16 --size=16 -osky.exr
rows 16 -o=sky.exr --size 16
rows 16 --output=sky.exr --size 16
rows 512 -o sky.exr
# A value may begin with a hyphen, by both ways.
rows 16 -o sky.exr --size 16 --elevation -5 --azimuth=-3.5
# Letters together, the last of which may have a value.
expect 0 "" sky --size 16 -qo sky.exr
[ ! -s log/out ] || die "-qo is not -q -o"
expect 0 "" sky --size 16 -qosky.exr
[ ! -s log/out ] || die "-qosky.exr is not -q -o sky.exr"
# -j is --threads.
expect 0 "" bake sky.exr -o one.ktx2 --size 8 --exposure -8 -q -j1
expect 0 "" bake sky.exr -o two.ktx2 --size 8 --exposure -8 -q -j 2
same one.ktx2 two.ktx2
expect 2 "threads is 0, it must be from 1 to 256" bake sky.exr -o one.ktx2 -j0
rm one.ktx2 two.ktx2
# Options may follow other words; after -- there are none.
expect 0 "" info sky.exr --json
cp sky.exr -- --json
expect 0 "" info -- --json
grep -qx -- '--json' log/out || die "-- does not end the options"
rm -- --json

expect 2 "size is given twice" sky -o sky.exr --size 16 --size 16
expect 2 "output is given twice" sky -o sky.exr --output sky.exr
expect 2 "quiet takes no value" sky -o sky.exr --quiet=yes
expect 2 "^kiln: -o needs a value" sky -o
expect 2 "^kiln: --size needs a value" sky -o sky.exr --size
expect 2 "size is '', it must be a whole number" sky -o sky.exr --size=
mkdir faces
expect 1 "^kiln: faces: holds no six faces; name the files px nx py ny pz nz or right" info faces
rmdir faces
# Words that are empty, as "$FILE" is where FILE was never set.
expect 2 "^kiln: --output is empty, it must name a file or folder$" sky -o ""
expect 2 "^kiln: --output is empty, it must name a file or folder$" bake sky.exr --output=
expect 2 "^kiln: --sh is empty, it must name a file or folder$" bake sky.exr -o a.ktx2 --sh ""
expect 2 "^kiln: word 1 after 'bake' is empty$" bake "" -o a.ktx2
expect 2 "^kiln: word 2 after 'info' is empty$" info sky.exr ""
expect 2 "^kiln: word 2 after 'eval' is empty$" eval e "" --mu 1 --roughness 1
expect 2 "^kiln: -x: no such option" sky -o sky.exr -qx
expect 2 "^kiln: -x: no such option" sky -o sky.exr -x
expect 2 "^kiln: -5: no such option" sky -o sky.exr -5
# No abbreviations.
expect 2 "^kiln: --siz: no such option, did you mean --size?" sky -o sky.exr --siz 16
# --help wins where it stands before what is wrong, alone and among letters.
expect 0 "" sky --size 16 --help --frob
expect 0 "" sky -qh

# Suggestions: an edit away, swapped letters, capitals, a beginning, and none for what is far.
meant() {
    suggestion=$1
    shift
    expect 2 "did you mean $suggestion?\$" "$@"
}
meant bake bkae
meant bake help bak
meant tables table
meant engines Engines
meant --size bake in.exr -o out.ktx2 --sise 64
meant --size bake in.exr -o out.ktx2 --sise=64
meant --irradiance bake in.exr -o out.ktx2 --iradiance d.ktx2
meant three bake in.exr -o out.ktx2 --for threejs
meant babylon bake in.exr -o out.env --for babylonjs
meant filament tables -o dfg.inc --for filment
meant panorama bake in.exr -o out.exr --shape panoramic
meant lambert bake in.exr -o out.exr --lobe lamber
meant soft bake in.exr -o out.ktx2 --for three --tune sotf
meant schlick-k2 eval e --g schlick-k
meant eavg eval evag
meant dfg fit dgf -o out.h
meant playcanvas engines playcanva
meant fish completions fihs
for far in frobnicate x; do
    "$KILN" $far >log/out 2>log/err && die "$far is a command"
    ! grep -q 'did you mean' log/err || die "$far: a suggestion for what is far"
    "$KILN" bake in.exr -o out.ktx2 --$far >log/out 2>log/err && die "--$far is an option"
    ! grep -q 'did you mean' log/err || die "--$far: a suggestion for what is far"
done
# The option that has gone is not suggested.
"$KILN" bake in.exr -o out.ktx2 --fi >log/out 2>log/err && die "--fi is an option"
! grep -q -- '--fit' log/err || die "--fit is suggested"

# A picture without a command, and a file of an engine without its name.
expect 2 "x.hdr: no such command, use 'kiln bake x.hdr -o OUT'" x.hdr
expect 2 "sky.exr: no such command, use 'kiln bake sky.exr -o OUT'" sky.exr
expect 2 "output x.env: .env is a file for Babylon.js 5 to 9, .env, add --for babylon$" bake sky.exr -o x.env
expect 2 "output x.glb: .glb is a file for glTF .*, add --for gltf$" bake sky.exr -o x.glb
expect 2 "irradiance x.env: must end in" bake sky.exr -o x.ktx2 --irradiance x.env

# Endings in capitals are endings.
expect 0 "" sky -o B.EXR --size 16
expect 0 "" bake sky.exr -o A.KTX2 --size 8 --exposure -8 --irradiance D.Dds --sh H.JSON -q
expect 0 "" bake sky.exr -o 'F_%s.HDR' --size 4 --levels 1 --exposure -8 -q
expect 0 "" info --json A.KTX2 D.Dds F_px.HDR B.EXR
node -e '
    const files = JSON.parse(require("fs").readFileSync("log/out", "utf8"));
    const formats = files.map(f => f.format).join();
    if (formats !== "ktx2,dds,hdr,exr") throw new Error(formats);
    JSON.parse(require("fs").readFileSync("H.JSON", "utf8"));' || die "endings in capitals"
expect 0 "" tables -o T.PNG --size 4 -q
expect 0 "" tables -o T.H --size 4 -q
expect 0 "" fit eavg -o E.GLSL --error 0.01 -q
expect 0 "" bake sky.exr --for three -o T.KTX2 --size 16 --exposure -8 -q

# One engine in full: its levels are those of the file that is baked for it.
expect 0 "" engines three
grep -q 'level 5 .* size 8 .* roughness 1$' log/out || die "engines three: no levels"
grep -q 'level 1 .* size 128 .* roughness 0.1056$' log/out || die "engines three: the roughness"
grep -q 'docs/engines/three.md' log/out || die "engines three: no page"
! grep -q babylon log/out || die "engines three names babylon"
for engine in three-cubeuv filament; do
    expect 0 "" engines $engine
    sed -n 's/^  *level .* size \([0-9]*\) *roughness \(.*\)/\1 \2/p' log/out >log/levels
    case $engine in three-cubeuv) out=L.exr ;; *) out=L ;; esac
    expect 0 "" bake sky.exr --for $engine -o $out --exposure -8 --tune none --json
    node -e '
        const { output } = JSON.parse(require("fs").readFileSync("log/out", "utf8"));
        for (const l of output.levels) console.log(l.size, +l.roughness.toPrecision(4));' >log/baked
    same log/levels log/baked
done
for engine in $("$KILN" engines --json | node -e '
    JSON.parse(require("fs").readFileSync(0, "utf8")).forEach(e => console.log(e.name))'); do
    expect 0 "" engines "$engine"
    page=$(sed -n 's|.*\(docs/engines/.*\)|\1|p' log/out)
    [ -s "$(dirname "$0")/../../$page" ] || die "engines $engine: there is no $page"
    expect 0 "" engines "$engine" --json
    node -e 'const [e, ...more] = JSON.parse(require("fs").readFileSync("log/out", "utf8"));
        process.exit(e.name === process.argv[1] && !more.length ? 0 : 1)' "$engine" || die "$engine"
done

# JSON stays JSON whatever a file's name holds.
name=$(printf 'a"b\\c\td\001\377\303\244\355\240\200.exr')
cp sky.exr "$name"
expect 0 "" info --json "$name"
node -e '
    const bytes = require("fs").readFileSync("log/out");
    const text = new TextDecoder("utf-8", { fatal: true }).decode(bytes);
    const path = JSON.parse(text)[0].path, want = "a\"b\\c\td\u0001\ufffd\u00e4\ufffd\ufffd\ufffd.exr";
    if (path !== want) throw new Error(JSON.stringify(path));' || die "a name in JSON"
rm "$name"
passed

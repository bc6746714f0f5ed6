#!/bin/sh
# The exact tables: every kind in every format, what is said of them, and what is refused.
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"

# One line says what was done; kiln info says the same of the file.
expect 0 "" tables -o e.ktx2 --size 16x8 --axis grazing --corners --g schlick-k2
[ "$(wc -l <log/out)" = 1 ] || die "one line says what was done"
grep -q '^e.ktx2: e, ggx, schlick-k2, 16 x 8, grazing axis, texels at corners' log/out ||
    die "the line is another"
expect 0 "" info e.ktx2
grep -q 'kind=e d=ggx g=schlick-k2 .*axis=grazing corners=1 complement=0 flip=0 size=16x8' log/out ||
    die "kiln info does not say what the table is"
only e.ktx2

# The same bytes on another number of threads.
cp e.ktx2 first.ktx2
expect 0 "" tables -o e.ktx2 --size 16x8 --axis grazing --corners --g schlick-k2 --threads 3 -q
[ ! -s log/out ] || die "quiet is not quiet"
same first.ktx2 e.ktx2
rm e.ktx2 first.ktx2

# Every kind, small.
for kind in e eavg dfg dfg-multiscatter; do
    expect 0 "" tables --table $kind -o $kind.exr --size 8 -q
done
expect 0 "" tables --table sheen -o sheen.exr --size 4 --sheen estevez -q
expect 0 "" tables --table e-dielectric -o dielectric.ktx2 --size 4x4x3 -q
expect 0 "" tables --table glass -o glass.ktx2 --size 2x2x2 -q
expect 0 "" tables --table e-walk --axis grazing -o walk.ktx2 --size 4x4x2 --paths 64 -q
only e.exr eavg.exr dfg.exr dfg-multiscatter.exr sheen.exr dielectric.ktx2 glass.ktx2 walk.ktx2
rm ./*.exr ./*.ktx2

# The numbers are the integrals: half of them below, and turned over.
expect 0 "" tables -o up.raw --size 4 --format f32 -q
expect 0 "" tables -o down.raw --size 4 --format f32 --flip -q
expect 0 "" eval e --roughness 0.125 --mu 0.625
node -e '
    const fs = require("fs"), read = name => new Float32Array(new Uint8Array(fs.readFileSync(name)).buffer);
    const up = read("up.raw"), down = read("down.raw"), e = +fs.readFileSync("log/out", "utf8");
    if (up.length !== 16 || Math.abs(up[2] - e) > 1e-7 || down[14] !== up[2])
        throw new Error(`${up[2]} and ${down[14]}, not ${e}`);
' || die "the table holds other numbers"
rm up.raw down.raw

# A table, its mean and the code that reads it, with a report.
expect 0 "" tables -o t.ktx2 --size 8 --axis grazing --corners --average mean.ktx2 --lookup --json
node -e '
    const r = JSON.parse(require("fs").readFileSync("log/out", "utf8"));
    if (!(r.output === "t.ktx2" && r.table === "e" && r.width === 8 && r.depth === 1 &&
          r.axis === "grazing" && r.corners && r.average === "mean.ktx2" && r.lookup.length === 2))
        throw new Error(JSON.stringify(r));
' || die "the report does not tell what was done"
only t.ktx2 mean.ktx2 t_lookup.h t_lookup.glsl
rm t.ktx2 mean.ktx2 t_lookup.h t_lookup.glsl

# A table of lobes for an engine's levels, with its picture and code.
expect 0 "" tables --table lobes -o l.ktx2 --size 4 --taps 2 --for babylon --lookup --error e.png --json
node -e '
    const r = JSON.parse(require("fs").readFileSync("log/out", "utf8"));
    const levels = r.roughness;
    if (!(r.table === "lobes" && r.taps === 2 && r.depth === 3 && r.lookup.length === 3 && r.error === "e.png" &&
          levels.length > 3 && levels.at(-1) === 1 && levels.every((x, i) => !i || x > levels[i - 1])))
        throw new Error(JSON.stringify(r));
' || die "the report does not tell what was done"
only l.ktx2 e.png l_lookup.h l_lookup.glsl l_lookup.wgsl
expect 0 "" info l.ktx2
grep -q "kind=lobes .*taps=2 levels=" log/out || die "info does not show the levels"
rm l.ktx2 e.png l_lookup.h l_lookup.glsl l_lookup.wgsl
expect 2 "not for --table dfg" tables --table dfg -o out.ktx2 --taps 2
expect 2 "not for --table lobes" tables --table lobes -o out.ktx2 --axis sqrt
expect 2 "must be f16 or f32" tables --table lobes -o out.png --format u16
expect 2 "increasing roughness of each level" tables --table lobes -o out.ktx2 --levels 0,0.3,0.2
expect 2 "decides the roughness of each level" tables --table lobes -o out.ktx2 --for three --levels 0,1
expect 2 "filters the environment itself" tables --table lobes -o out.ktx2 --for godot
expect 2 "must end in .png" tables --table lobes -o out.ktx2 --error e.exr
expect 2 "kiln has tables for babylon and filament" tables -o out.png --for three
expect 1 "below 0 and above 1" tables --table lobes -o out.png --size 4

expect 2 "no output" tables --table dfg
expect 2 "must end in" tables -o out.tga
expect 2 "a .png file has no format f16" tables -o out.png --format f16
expect 2 "only .ktx2 files are compressed by zstd" tables -o out.png --zstd=3
expect 2 "a .exr file has no format u8" tables -o out.ktx2 --format u8 --average mean.exr
expect 2 "it must be e, eavg" tables -o out.ktx2 --table energy
expect 2 "it must be N, WxH or WxHxD" tables -o out.ktx2 --size 4x
expect 2 "it must be N, WxH or WxHxD" tables -o out.ktx2 --size 4097
expect 2 "linear, sqrt, cbrt or grazing" tables -o out.ktx2 --axis log
expect 2 "not for --table dfg" tables -o out.ktx2 --table dfg --complement
expect 2 "not for --table dfg" tables -o out.ktx2 --table dfg --average mean.ktx2
expect 2 "not for --table e-walk" tables -o out.ktx2 --table e-walk --g schlick-k2
expect 2 "not for --table e-walk: its axis is grazing" tables -o out.ktx2 --table e-walk --axis linear
expect 2 "not for --table e" tables -o out.ktx2 --paths 64
expect 2 "is not sampled" tables -o out.ktx2 --samples 64
expect 2 "not for --method textbook" tables -o out.exr --method textbook --axis sqrt
expect 2 "not for --assignment" tables -o dir --assignment --axis sqrt
expect 1 "it must be 1" tables -o out.ktx2 --size 8x8x8
expect 1 "there is no folder nowhere" tables -o nowhere/out.ktx2
expect 1 "there is no folder nowhere" tables -o out.ktx2 --average nowhere/mean.ktx2
[ -z "$(find . -type f -not -path './log/*')" ] || die "what failed has left files"
passed

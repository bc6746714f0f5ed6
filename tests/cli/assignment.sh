#!/bin/sh
# kiln tables --assignment: what is written, which way up, and what is refused.
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"

pictures="Emu_MC.png Emu_MC_unclamped.png Emu_IS.png Emu_split_sum.png Emu_exact.png
    one_minus_Emu_IS.png Eavg.png Eavg_MC.png Eavg_exact.png error_Emu_MC.png
    error_Emu_MC_unclamped.png error_Emu_IS.png error_Emu_split_sum.png error_Eavg.png
    error_Eavg_MC.png error_legend.png"

# in_folder DIR: every file is there, and no other.
in_folder() {
    set -- "$1" "$1/report.md"
    for picture in $pictures; do set -- "$@" "$1/$picture"; done
    shift
    only "$@"
}

expect 0 "" tables --assignment -o images
grep -q '^images: 17 files, 128 x 128, 1024 samples, schlick-k2' log/out || die "first line"
grep -q 'Emu_IS  *1\.09e-02' log/out || die "figures"
in_folder images

# Again: the same bytes, and nothing said.
mv images first
expect 0 "" tables --assignment -o images/ -q
[ ! -s log/out ] || die "quiet, but it spoke"
for file in $pictures report.md; do same "first/$file" "images/$file"; done
# Into a folder that is there.
expect 0 "" tables --assignment -o images -q
same first/Emu_MC.png images/Emu_MC.png
rm -r first

for picture in $pictures; do
    expect 0 "" info "images/$picture"
    case $picture in
    error_legend.png) size='320 x 20' ;;
    *) size='128 x 128' ;;
    esac
    grep -q "$size" log/out || die "$picture: not $size"
done

# Bytes of the pictures themselves, decoded by another than kiln: PNG of 8 bits, three channels.
cat >log/png.js <<'JS'
const fs = require('fs'), zlib = require('zlib');
module.exports = path => {
  const data = fs.readFileSync(path), parts = [];
  let width = 0, height = 0;
  for (let at = 8; at < data.length; at += 12 + data.readUInt32BE(at)) {
    const body = data.subarray(at + 8, at + 8 + data.readUInt32BE(at));
    const kind = data.toString('latin1', at + 4, at + 8);
    if (kind === 'IHDR') {
      [width, height] = [body.readUInt32BE(0), body.readUInt32BE(4)];
      if (body[8] !== 8 || body[9] !== 2) throw new Error(path + ': not 8 bits of RGB');
    }
    if (kind === 'IDAT') parts.push(body);
  }
  const raw = zlib.inflateSync(Buffer.concat(parts)), stride = 3 * width, out = [];
  for (let y = 0; y < height; y++) {
    const row = new Uint8Array(stride), up = y ? out[y - 1] : new Uint8Array(stride);
    for (let i = 0; i < stride; i++) {
      const a = i < 3 ? 0 : row[i - 3], b = up[i], c = i < 3 ? 0 : up[i - 3], p = a + b - c;
      const near = Math.abs(p - a) <= Math.abs(p - b) && Math.abs(p - a) <= Math.abs(p - c) ? a
        : Math.abs(p - b) <= Math.abs(p - c) ? b : c;
      row[i] = raw[y * (stride + 1) + 1 + i] +
        [0, a, b, (a + b) >> 1, near][raw[y * (stride + 1)]];
    }
    out.push(row);
  }
  return { size: width, at: (x, y) => out[y][3 * x], rgb: (x, y) => [...out[y].slice(3 * x, 3 * x + 3)] };
};
JS
cat >log/check.js <<'JS'
const png = require('./png.js'), assert = require('assert');
const [, , folder, exactly] = process.argv;
const open = name => png(`${folder}/${name}.png`), last = 127;
const exact = open('Emu_exact'), is = open('Emu_IS'), mc = open('Emu_MC');
// E falls with roughness and, at the top, from grazing to straight on: 1 - ln 2 = .307 there.
assert(Math.abs(exact.at(last, 0) - 255 * 0.309) <= 2, `top right is ${exact.at(last, 0)}`);
assert(exact.at(0, 0) > exact.at(last, 0));
assert(exact.at(last, last) >= 251);
// The sampled one stays within 0.011 and the cut.
for (const picture of [is, open('Emu_split_sum')])
  for (let y = 0; y <= last; y++)
    for (let x = 0; x <= last; x++) {
      assert(Math.abs(picture.at(x, y) - exact.at(x, y)) <= 4, `${x} ${y}`);
      const [r, g, b] = picture.rgb(x, y);
      assert(r === g && g === b);
    }
// The dark band lies at the bottom.
assert(mc.at(64, last) === 0 && Math.abs(mc.at(64, 0) - exact.at(64, 0)) <= 6);
// Figure 3: turned over, and 1 - E. Both are cut, so that they add up to 254, or 255.
const one = open('one_minus_Emu_IS');
for (let y = 0; y <= last; y++)
  for (let x = 0; x <= last; x++) {
    const sum = one.at(x, last - y) + is.at(x, y);
    assert(sum === 254 || sum === 255 || is.at(x, y) === 255, `${x} ${y}: ${sum}`);
  }
// Averages: rows of one value, falling with roughness; .380 at the top.
for (const name of ['Eavg', 'Eavg_exact', 'Eavg_MC']) {
  const average = open(name);
  assert(Math.abs(average.at(0, 0) - 96) <= 1, `${name} has ${average.at(0, 0)} at the top`);
  for (let y = 0; y <= last; y++) {
    for (let x = 1; x <= last; x++) assert(average.at(x, y) === average.at(0, y));
    if (y && name !== 'Eavg_MC') assert(average.at(0, y) >= average.at(0, y - 1));
  }
}
// Texels that the integral itself fixes: floor(255 E).
for (const [x, y, byte] of JSON.parse(exactly)) assert(exact.at(x, y) === byte, `${x} ${y}`);
JS
# Computed one by one: column 12 is mu = 12.5 / 128, row 3 is roughness 124.5 / 128.
exactly=
for at in "12 3" "100 64" "0 127" "127 127" "64 100"; do
    x=${at% *} y=${at#* }
    value=$("$KILN" eval e --g schlick-k2 --mu "$(awk "BEGIN { print ($x + .5) / 128 }")" \
        --roughness "$(awk "BEGIN { print (127.5 - $y) / 128 }")")
    exactly="$exactly${exactly:+, }[$x, $y, $(awk "BEGIN { print int(255 * $value) }")]"
done
node log/check.js images "[$exactly]" || die "the pictures"
checks=$((checks + 1))
grep -q '^| 0.1523 | 0.9402 | ' images/report.md || die "the report's dark band"
rm -r images

# The other k, for programs.
expect 0 "" tables --assignment -o text --g schlick-text --size 32 --samples 64 --json
node -e '
const r = JSON.parse(require("fs").readFileSync("log/out", "utf8"));
const table = name => r.tables.find(t => t.name === name);
if (r.g !== "schlick-text" || r.size !== 32 || r.samples !== 64 || r.files !== 17) process.exit(1);
if (Math.abs(r.mirror_average - 0.84569) > 1e-5) process.exit(2);
if (!(table("Emu_IS").rms < 0.01 && table("Emu_MC").mean < -0.05)) process.exit(3);
if ("max" in table("Emu_exact")) process.exit(4);
' || die "the report as JSON"
in_folder text
rm -r text

# Refused, with nothing made.
expect 2 "no output: name a folder" tables --assignment
expect 2 "leave --method out" tables --assignment --method textbook -o d
expect 2 "takes no input" tables --assignment in.exr -o d
expect 2 "schlick-k2 or schlick-text" tables --assignment -o d --g smith
expect 2 "from 2 to 1024" tables --assignment -o d --size 1025
expect 2 "from 1 to 1048576" tables --assignment -o d --samples 0
expect 2 "output is empty" tables --assignment -o ''
expect 1 "there is no folder nowhere" tables --assignment -o nowhere/d
expect 1 "there is no folder nowhere" tables --assignment -o nowhere/d/
touch file
expect 1 "file: is a file" tables --assignment -o file
expect 1 "file/d: Not a directory" tables --assignment -o file/d
rm file
[ "$(ls)" = log ] || die "something was made"

# A picture that cannot be replaced is named, and those before it are whole.
mkdir -p d/Emu_IS.png
expect 1 "d/Emu_IS.png" tables --assignment -o d --size 8 --samples 4
[ ! -e d/report.md ] || die "a report of a failure"
rm -r d
# So is a report.
mkdir -p d/report.md/full
expect 1 "d/report.md" tables --assignment -o d --size 8 --samples 4
[ ! -e d/.report.md.part ] || die "half a report"
rm -r d
passed

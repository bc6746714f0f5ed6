// Compares how kiln decodes UASTC HDR with two other decoders: node check.mjs TRANSCODER FOLDER
// In: the folder of Basis Universal's transcoder (npm three, examples/jsm/libs/basis), and a folder with blocks.ktx2
// (one picture), blocks.rgb (its texels as kiln decodes them, floats) and blocks.modes (number of the mode of each
// block), which uastc_write.c wrote. The transcoder's half floats and, where the program astcenc is installed, astcenc's
// are kiln's; the transcoder's ASTC blocks are the file's; its BC6H blocks stay near.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';

const [libraries, folder] = process.argv.slice(2);
const code = fs.readFileSync(path.join(libraries, 'basis_transcoder.js'), 'utf8');
const wasmBinary = fs.readFileSync(path.join(libraries, 'basis_transcoder.wasm'));
const basis = await new Function('require', '__dirname', `${code}; return BASIS`)((await import('node:module'))
    .createRequire(import.meta.url), folder)({ wasmBinary });
basis.initializeBasis();

const half = (h) => (h >> 10 ? (1024 + (h & 1023)) * 2 ** ((h >> 10) - 25) : h * 2 ** -24);
const bytes = fs.readFileSync(path.join(folder, 'blocks.ktx2'));
const raw = fs.readFileSync(path.join(folder, 'blocks.rgb'));
const ours = new Float32Array(raw.buffer, raw.byteOffset, raw.length / 4);
const modes = fs.readFileSync(path.join(folder, 'blocks.modes'));
const width = bytes.readUInt32LE(20), height = bytes.readUInt32LE(24);
const blocks = bytes.subarray(Number(bytes.readBigUInt64LE(80)));
assert.equal(ours.length, 3 * width * height);

const file = new basis.KTX2File(new Uint8Array(bytes));
assert.ok(file.isValid());
assert.ok(file.isHDR(), 'the transcoder takes the file for UASTC HDR');
assert.ok(file.startTranscoding());
function transcode(format) {
    const out = new Uint8Array(file.getImageTranscodedSizeInBytes(0, 0, 0, format));
    assert.ok(file.transcodeImage(out, 0, 0, 0, format, 0, -1, -1), `format ${format} is transcoded`);
    return out;
}
const BC6H = 22, ASTC = 23, RGBA_HALF = 25; // transcoder_texture_format

function same(name, value) {
    for (let i = 0; i < width * height; i++)
        for (let c = 0; c < 3; c++) {
            if (value(i, c) === ours[3 * i + c])
                continue;
            const block = Math.floor(Math.floor(i / width) / 4) * (width / 4) + Math.floor(i % width / 4);
            assert.fail(`${name}: texel ${i}, channel ${c} of mode ${modes[block]} is ${value(i, c)}, not ${ours[3 * i + c]}`);
        }
}
const halfs = new Uint16Array(transcode(RGBA_HALF).buffer);
same('transcoder', (i, c) => half(halfs[4 * i + c]));
assert.deepEqual(Buffer.from(transcode(ASTC)), blocks.subarray(0, width * height));
assert.equal(transcode(BC6H).length, width * height);

const counts = Array.from({ length: 24 }, (_, m) => modes.filter((mode) => mode === m).length);
console.log(`uastc: ${modes.length} blocks of ${counts.filter((n) => n).length} modes are decoded alike by the transcoder`);

// astcenc reads a header of 16 bytes before the blocks, and writes half floats as a KTX file.
const header = Buffer.from([0x13, 0xab, 0xa1, 0x5c, 4, 4, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0]);
header.writeUIntLE(width, 7, 3);
header.writeUIntLE(height, 10, 3);
fs.writeFileSync(path.join(folder, 'blocks.astc'), Buffer.concat([header, blocks]));
const program = ['astcenc', 'astcenc-sse2', 'astcenc-native'].find((name) => !spawnSync(name, ['-version']).error);
if (program) {
    const run = spawnSync(program, ['-dH', path.join(folder, 'blocks.astc'), path.join(folder, 'blocks.ktx')], { encoding: 'utf8' });
    assert.equal(run.status, 0, run.stdout + run.stderr);
    const ktx = fs.readFileSync(path.join(folder, 'blocks.ktx'));
    const at = 64 + ktx.readUInt32LE(60) + 4, channels = ktx.readUInt32LE(24) === 0x1907 ? 3 : 4; // GL_RGB
    assert.deepEqual([ktx.readUInt32LE(16), ktx.readUInt32LE(36), ktx.readUInt32LE(40)], [0x140b, width, height]);
    same('astcenc', (i, c) => half(ktx.readUInt16LE(at + 2 * (channels * i + c))));
    console.log(`uastc: ${program} decodes them alike`);
} else {
    console.log('uastc: astcenc, which Debian has, is missing and was not asked');
}

// Compares the errors of BC6H and of UASTC HDR by kiln and by Basis Universal:
// node blocks.mjs BIN PANORAMAS ASSETS FOLDER CSV
// In: the panoramas NAMES, and those of npm's @pmndrs/assets in the folder ASSETS, which are data URLs in modules of
// JavaScript. Out: errors and CPU times, printed and as rows of CSV. kiln bakes a cube of each panorama and encodes
// its levels as BC6H and as UASTC HDR. Basis Universal (UASTC HDR 4x4 at its default effort; npm ktx2-encoder,
// WebAssembly) encodes the same levels, and its transcoder converts the UASTC HDR of both encoders to BC6H. oiiotool
// decodes BC6H. The summary gives, for each set of panoramas, kiln's errors divided by Basis Universal's; exit status 1
// if the mean of a panorama misses one of BARS.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import BASIS from './node_modules/ktx2-encoder/dist/basis/basis_encoder.js';

const [bin, panoramas, assets, folder, csv] = process.argv.slice(2).map((name) => path.resolve(name));
const NAMES = ['city', 'courtyard', 'forest', 'interior', 'night', 'studio', 'sunrise', 'sunset'], LEVELS = 6, PEER_LEVELS = [0, 2, 4];
const RGBA16F = 10; // number of a format in DDS files
const run = (program, ...args) => execFileSync(program, args, { encoding: 'utf8', cwd: folder });
const ours = (...args) => run(path.join(bin, 'bench_blocks'), ...args).trim().split(' ').map(Number);

fs.rmSync(folder, { recursive: true, force: true });
fs.mkdirSync(folder, { recursive: true });
const basis = await BASIS({ print() {} });
basis.initializeBasis();

// Returns the levels of a KTX2 cube in rgba32f: the size and the bytes of each face.
function readCube(name) {
    const file = fs.readFileSync(path.join(folder, name));
    return Array.from({ length: LEVELS }, (_, level) => {
        const at = Number(file.readBigUInt64LE(80 + 24 * level)), size = file.readUInt32LE(20) >> level;
        const bytes = 16 * size * size;
        return { size, faces: Array.from({ length: 6 }, (__, face) =>
            new Uint8Array(file.subarray(at + face * bytes, at + (face + 1) * bytes))) };
    });
}

// Writes one level as a DDS file, with the header that kiln wrote for all levels.
function writeLevel(name, header, size, faces) {
    const own = Buffer.from(header);
    [size, size, faces[0].length].forEach((value, i) => own.writeUInt32LE(value, 12 + 4 * i));
    own.writeUInt32LE(1, 28);
    fs.writeFileSync(path.join(folder, name), Buffer.concat([own, ...faces]));
}

function basisFace(pixels, size) {
    const encoder = new basis.BasisEncoder(), out = new Uint8Array(1 << 20);
    encoder.setTexType(0); // 2-D
    encoder.setHDR(true);
    encoder.setUASTCHDRQualityLevel(1);
    encoder.setCreateKTX2File(true);
    encoder.setKTX2UASTCSupercompression(false);
    encoder.setMipGen(false);
    if (!encoder.setSliceSourceImageHDR(0, pixels, size, size, basis.hdr_image_type.cHITRGBAFloat.value, false, 100))
        throw new Error('Basis takes no source');
    const begin = process.cpuUsage(), length = encoder.encode(out);
    const file = new basis.KTX2File(out.slice(0, length)), format = basis.transcoder_texture_format.cTFBC6H.value;
    if (!length || !file.isValid() || !file.startTranscoding())
        throw new Error('Basis encodes nothing');
    const blocks = new Uint8Array(file.getImageTranscodedSizeInBytes(0, 0, 0, format));
    file.transcodeImage(blocks, 0, 0, 0, format, 0, -1, -1);
    const plain = basis.transcoder_texture_format.cTFRGBA_HALF.value;
    const halfs = new Uint8Array(file.getImageTranscodedSizeInBytes(0, 0, 0, plain));
    const microseconds = process.cpuUsage(begin).user;
    file.transcodeImage(halfs, 0, 0, 0, plain, 0, -1, -1);
    file.close();
    file.delete();
    encoder.delete();
    return { blocks, microseconds, halfs: new Uint16Array(halfs.buffer) };
}

// Returns the errors that bench_blocks prints of a DDS file of blocks.
function measure(name, truth, level) {
    run('oiiotool', `${name}.dds`, '--fullpixels', '--scanline', '-o', `${name}.exr`);
    return ours('error', truth, `${level}`, `${name}.exr`);
}

// The blocks of a level of kiln's UASTC HDR file after conversion to BC6H, of all faces.
function convertLevel(name, level) {
    const file = new basis.KTX2File(new Uint8Array(fs.readFileSync(path.join(folder, name))));
    const format = basis.transcoder_texture_format.cTFBC6H.value;
    if (!file.isValid() || !file.startTranscoding())
        throw new Error(`${name} is not converted`);
    const faces = Array.from({ length: 6 }, (_, face) => {
        const blocks = new Uint8Array(file.getImageTranscodedSizeInBytes(level, 0, face, format));
        file.transcodeImage(blocks, level, 0, face, format, 0, -1, -1);
        return blocks;
    });
    file.close();
    file.delete();
    return faces;
}

// Returns the errors that bench_blocks prints of UASTC HDR as Basis Universal's transcoder decodes it, to half floats of
// RGBA. They are written as one DDS texture of all faces, one below the other.
function measureHalfs(truth, level, header, size, made) {
    const own = Buffer.from(header), set = (place, value) => own.writeUInt32LE(value, place);
    Object.entries({ 12: 6 * size, 16: size, 20: 8 * size, 28: 1, 112: 0, 128: RGBA16F, 136: 0 })
        .forEach(([place, value]) => set(+place, value));
    const faces = made.map(({ halfs }) => Buffer.from(halfs.buffer));
    fs.writeFileSync(path.join(folder, 'halfs.dds'), Buffer.concat([own, ...faces]));
    return ours('error', truth, `${level}`, 'halfs.dds');
}

const rows = ['name,unit,median,minimum'];
const add = (name, unit, value) => rows.push(`${name},${unit},${value},${value}`);
// The largest mean over the levels of a panorama of what kiln takes or errs, divided by Basis Universal's.
const BARS = { uastc: 1, 'uastc displayed': 1, 'converted to bc6h': 1, cpu: 0.2 };
const ratios = {}, each = {};
const compare = (set, name, what, ratio) => [[set, ratios], [name, each]].forEach(([key, lists]) =>
    ((lists[key] ??= {})[what] ??= []).push(ratio));
const meanOf = (list) => Math.exp(list.reduce((sum, x) => sum + Math.log(x), 0) / list.length);

// The panoramas as [set, name, path].
const pictures = NAMES.map((name) => ['eight', name, path.join(panoramas, `${name}.exr`)]);
for (const module of fs.readdirSync(assets).filter((name) => name.endsWith('.exr.js'))) {
    const name = `assets-${module.replace('.exr.js', '')}`, file = path.join(folder, `${name}.exr`);
    const [, text] = fs.readFileSync(path.join(assets, module), 'utf8').match(/base64,([A-Za-z0-9+/=]+)/);
    fs.writeFileSync(file, Buffer.from(text, 'base64'));
    pictures.push(['assets', name, file]);
}
console.log('blocks: RMS error in steps of half floats (10 steps are nearly 1 %) | RMS error relative to the RMS ' +
            'radiance | CPU microseconds for each texel');
for (const [set, name, picture] of pictures) {
    const truth = `${name}.ktx2`;
    const [time] = ours('save', picture, truth, `${name}.dds`);
    const dds = fs.readFileSync(path.join(folder, `${name}.dds`)), header = dds.subarray(0, 148);
    console.log(`  ${name}  kiln, all levels: ${time.toFixed(2)}`);
    add(`${name} kiln`, 'us/texel', time);
    const sizes = Array.from({ length: 9 }, (_, k) => 16 * Math.ceil((256 >> k || 1) / 4) ** 2);
    const whole = sizes.reduce((a, b) => a + b);
    const [uastcTime, ...uastc] = ours('uastc', '-', truth, `${name}-uastc.ktx2`);
    console.log(`  ${name}  kiln, all levels as UASTC HDR: ${uastcTime.toFixed(2)}`);
    add(`${name} kiln uastc`, 'us/texel', uastcTime);
    readCube(truth).forEach(({ size, faces }, level) => {
        const before = 148 + sizes.slice(0, level).reduce((a, b) => a + b, 0);
        writeLevel('kiln.dds', header, size, faces.map((_, f) =>
            dds.subarray(before + f * whole, before + f * whole + sizes[level])));
        const [codes, energy] = measure('kiln', truth, level);
        add(`${name} kiln level ${level}`, 'codes', codes);
        add(`${name} kiln level ${level}`, 'relative', energy);
        let line = `    level ${level}  kiln ${codes.toFixed(1)} | ${energy.toExponential(1)}`;
        if (PEER_LEVELS.includes(level)) {
            const made = faces.map((face) => basisFace(face, size));
            writeLevel('basis.dds', header, size, made.map(({ blocks }) => blocks));
            const [theirs, theirEnergy] = measure('basis', truth, level);
            const [, uastcEnergy, uastcShown] = measureHalfs(truth, level, header, size, made);
            const [, ownEnergy, ownShown] = uastc.slice(3 * level);
            writeLevel('converted.dds', header, size, convertLevel(`${name}-uastc.ktx2`, level));
            const [, convertedEnergy] = measure('converted', truth, level);
            add(`${name} kiln uastc as bc6h level ${level}`, 'relative', convertedEnergy);
            compare(set, name, 'uastc', ownEnergy / uastcEnergy);
            compare(set, name, 'uastc displayed', ownShown / uastcShown);
            compare(set, name, 'converted to bc6h', convertedEnergy / theirEnergy);
            compare(set, name, 'bc6h', energy / theirEnergy);
            add(`${name} kiln uastc level ${level}`, 'relative', ownEnergy);
            add(`${name} kiln uastc level ${level}`, 'displayed', ownShown);
            add(`${name} basis uastc level ${level}`, 'relative', uastcEnergy);
            add(`${name} basis uastc level ${level}`, 'displayed', uastcShown);
            const us = made.reduce((sum, { microseconds }) => sum + microseconds, 0) / (6 * size * size);
            add(`${name} basis level ${level}`, 'codes', theirs);
            add(`${name} basis level ${level}`, 'relative', theirEnergy);
            add(`${name} basis level ${level}`, 'us/texel', us);
            compare(set, name, 'cpu', uastcTime / us);
            line += `   Basis ${theirs.toFixed(1)} | ${theirEnergy.toExponential(1)} | ${us.toFixed(0)} (WebAssembly)` +
                    `   as UASTC HDR (converted ${convertedEnergy.toExponential(1)}): kiln ${ownEnergy.toExponential(1)} Basis ${uastcEnergy.toExponential(1)}`;
        }
        console.log(line);
    });
}
for (const [set, kinds] of Object.entries(ratios))
    for (const [what, list] of Object.entries(kinds)) {
        const sorted = list.sort((a, b) => a - b), mean = meanOf(list);
        const shown = [sorted[0], sorted[sorted.length >> 1], sorted.at(-1), mean].map((x) => x.toFixed(3));
        console.log(`  ${set}, ${what}, kiln / Basis Universal: least ${shown[0]}, median ${shown[1]}, most ${shown[2]}, ` +
                    `geometric mean ${shown[3]}; ${list.filter((x) => x > 1).length} of ${list.length} above 1`);
        add(`${set} ${what}`, 'kiln / basis', mean);
    }
fs.mkdirSync(path.dirname(csv), { recursive: true });
fs.writeFileSync(csv, `${rows.join('\n')}\n`);
for (const [name, kinds] of Object.entries(each))
    for (const [what, bar] of Object.entries(BARS).filter(([kind, most]) => !(meanOf(kinds[kind]) <= most))) {
        console.log(`  MISSED: ${name}, ${what}: kiln / Basis Universal is ${meanOf(kinds[what]).toFixed(3)}, more than ${bar}`);
        process.exitCode = 1;
    }

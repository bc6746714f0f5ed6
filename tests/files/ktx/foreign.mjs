// Writes KTX2 cubes by ktx-parse, a program that shares no code with kiln, for read.c: node foreign.mjs FOLDER
// Names are FORMAT-SCHEME-ORIENTATION-SIZE-LEVELS.ktx2. Number c of a texel is made of the integer n below.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { deflateSync } from "node:zlib";
import * as ktx from "ktx-parse";

const { KHR_DF_SAMPLE_DATATYPE_EXPONENT: EXPONENT, KHR_DF_SAMPLE_DATATYPE_FLOAT: FLOAT,
        KHR_DF_SAMPLE_DATATYPE_SIGNED: SIGNED, KHR_DF_SAMPLE_DATATYPE_LINEAR: LINEAR } = ktx;
const channels = [ktx.KHR_DF_CHANNEL_RGBSDA_RED, ktx.KHR_DF_CHANNEL_RGBSDA_GREEN, ktx.KHR_DF_CHANNEL_RGBSDA_BLUE,
                  ktx.KHR_DF_CHANNEL_RGBSDA_ALPHA];
const one = 0x3f800000, minusOne = 0xbf800000;
const n = (level, face, x, y, c) => (11 * level + 31 * face + 7 * y + 3 * x + 50 * c) % 256;

// put(view, at, (c) => n) stores a texel at the byte `at`. A half has the bits 0x3000 + 4 n, a float the value
// n / 1024. Whole numbers of 8 bits are n, those of 16 bits are 257 n, and both stand for n / 255. A channel of RGB9E5
// has the mantissa n and the exponent 15 + level, which is the value n 2^(level - 9).
const put16 = (value) => (view, at, of) => [0, 1, 2, 3].forEach((c) => view.setUint16(at + 2 * c, value(of(c)), true));
const put8 = (count) => (view, at, of) => { for (let c = 0; c < count; c++) view.setUint8(at + c, of(c)); };
const formats = {
    rgba16f: { vk: ktx.VK_FORMAT_R16G16B16A16_SFLOAT, bytes: 8, type: 2, bits: 16, put: put16((v) => 0x3000 + 4 * v) },
    rgba32f: { vk: ktx.VK_FORMAT_R32G32B32A32_SFLOAT, bytes: 16, type: 4, bits: 32,
               put: (view, at, of) => [0, 1, 2, 3].forEach((c) => view.setFloat32(at + 4 * c, of(c) / 1024, true)) },
    rgba16: { vk: ktx.VK_FORMAT_R16G16B16A16_UNORM, bytes: 8, type: 2, bits: 16, whole: true,
              put: put16((v) => 257 * v) },
    rgba8srgb: { vk: ktx.VK_FORMAT_R8G8B8A8_SRGB, bytes: 4, type: 1, bits: 8, whole: true, srgb: true, put: put8(4) },
    rgb8srgb: { vk: ktx.VK_FORMAT_R8G8B8_SRGB, bytes: 3, type: 1, bits: 8, whole: true, srgb: true, put: put8(3) },
    rgb9e5: { vk: ktx.VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, bytes: 4, type: 4, put: (view, at, of, level) =>
        view.setUint32(at, (of(0) | of(1) << 9 | of(2) << 18 | (15 + level) << 27) >>> 0, true) },
};

function samples(format) {
    if (!format.bits)
        return channels.slice(0, 3).flatMap((channelType, i) => [
            { bitOffset: 9 * i, bitLength: 8, channelType, samplePosition: [0, 0, 0, 0], sampleLower: 0,
              sampleUpper: 8448 },
            { bitOffset: 27, bitLength: 4, channelType: channelType | EXPONENT, samplePosition: [0, 0, 0, 0],
              sampleLower: 15, sampleUpper: 31 }]);
    return channels.slice(0, format.bytes * 8 / format.bits).map((channel, i) => ({
        bitOffset: i * format.bits, bitLength: format.bits - 1, samplePosition: [0, 0, 0, 0],
        channelType: channel | (format.whole ? 0 : FLOAT | SIGNED) | (format.srgb && i === 3 ? LINEAR : 0),
        sampleLower: format.whole ? 0 : minusOne, sampleUpper: format.whole ? 2 ** format.bits - 1 : one }));
}

// A frame of zstd (RFC 8878) that states its size, with blocks of bytes as they are and, for equal bytes, of one byte
// and a count.
function zstd(bytes) {
    const parts = [Buffer.from([0x28, 0xb5, 0x2f, 0xfd, 0xa0]), Buffer.alloc(4)];
    parts[1].writeUInt32LE(bytes.length);
    for (let at = 0; at < bytes.length; at += 1000) {
        const block = bytes.subarray(at, at + 1000), equal = block.every((b) => b === block[0]);
        const head = (at + 1000 >= bytes.length ? 1 : 0) | (equal ? 2 : 0) | block.length << 3;
        parts.push(Buffer.from([head & 255, head >> 8 & 255, head >> 16]), equal ? block.subarray(0, 1) : block);
    }
    return Buffer.concat(parts);
}

// The texels of a level as they are stored: with columns from the right for an l, with rows from the bottom for a u.
function level(format, k, edge, orientation) {
    const bytes = Buffer.alloc(6 * edge * edge * format.bytes), view = new DataView(bytes.buffer, bytes.byteOffset);
    for (let face = 0, at = 0; face < 6; face++)
        for (let row = 0; row < edge; row++)
            for (let column = 0; column < edge; column++, at += format.bytes) {
                const x = orientation[0] === "l" ? edge - 1 - column : column;
                const y = orientation[1] === "u" ? edge - 1 - row : row;
                format.put(view, at, (c) => (c === 3 ? 255 : n(k, face, x, y, c)), k);
            }
    return bytes;
}

const schemes = { none: [ktx.KHR_SUPERCOMPRESSION_NONE, (b) => b], zstd: [ktx.KHR_SUPERCOMPRESSION_ZSTD, zstd],
                  zlib: [ktx.KHR_SUPERCOMPRESSION_ZLIB ?? 3, (b) => deflateSync(b)] };

function write(name, scheme, orientation, size, levels) {
    const format = formats[name], file = ktx.createDefaultContainer(), block = file.dataFormatDescriptor[0];
    Object.assign(file, { vkFormat: format.vk, typeSize: format.type, pixelWidth: size, pixelHeight: size, faceCount: 6,
                          levelCount: levels, supercompressionScheme: schemes[scheme][0] });
    Object.assign(block, { colorModel: ktx.KHR_DF_MODEL_RGBSDA, colorPrimaries: ktx.KHR_DF_PRIMARIES_BT709,
                           transferFunction: format.srgb ? ktx.KHR_DF_TRANSFER_SRGB : ktx.KHR_DF_TRANSFER_LINEAR,
                           bytesPlane: [format.bytes, 0, 0, 0, 0, 0, 0, 0], samples: samples(format) });
    if (orientation !== "--")
        file.keyValue.KTXorientation = orientation;
    for (let k = 0; k < levels; k++) {
        const texels = level(format, k, size >> k, orientation);
        file.levels.push({ levelData: new Uint8Array(schemes[scheme][1](texels)),
                           uncompressedByteLength: texels.length });
    }
    writeFileSync(join(process.argv[2], `${name}-${scheme}-${orientation}-${size}-${levels}.ktx2`), ktx.write(file));
}

const orientations = ["rd", "--", "ru", "ld", "lu"];
let count = 0;
for (const name of Object.keys(formats))
    for (const scheme of Object.keys(schemes))
        for (const [size, levels] of [[8, 4], [5, 1], [16, 2]])
            write(name, scheme, orientations[count++ % 5], size, levels);

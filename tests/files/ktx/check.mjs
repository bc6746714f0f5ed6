// Reads KTX2 cubes and tables written by write.c with ktx-parse and compares every field with what the
// specification asks of such a file: node check.mjs FOLDER
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import * as ktx from "ktx-parse";

const { KHR_DF_SAMPLE_DATATYPE_EXPONENT: EXPONENT, KHR_DF_SAMPLE_DATATYPE_FLOAT: FLOAT,
        KHR_DF_SAMPLE_DATATYPE_SIGNED: SIGNED } = ktx;
const RED = ktx.KHR_DF_CHANNEL_RGBSDA_RED, GREEN = ktx.KHR_DF_CHANNEL_RGBSDA_GREEN,
      BLUE = ktx.KHR_DF_CHANNEL_RGBSDA_BLUE, ALPHA = ktx.KHR_DF_CHANNEL_RGBSDA_ALPHA;

const one = 0x3f800000, minusOne = 0xbf800000;
const signed = (bits) => [RED, GREEN, BLUE, ALPHA].map(
    (channel, i) => [i * bits, bits, channel | FLOAT | SIGNED, minusOne, one]);
const shared = [RED, GREEN, BLUE].flatMap((channel, i) => [
    [9 * i, 9, channel, 0, 8448], [27, 5, channel | EXPONENT, 15, 31]]);
const formats = {
    rgba16f: { vk: ktx.VK_FORMAT_R16G16B16A16_SFLOAT, bytes: 8, type: 2, samples: signed(16) },
    rgba32f: { vk: ktx.VK_FORMAT_R32G32B32A32_SFLOAT, bytes: 16, type: 4, samples: signed(32) },
    rgb9e5: { vk: ktx.VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, bytes: 4, type: 4, samples: shared },
    b10g11r11: { vk: ktx.VK_FORMAT_B10G11R11_UFLOAT_PACK32, bytes: 4, type: 4, samples: [
        [0, 11, RED | FLOAT, 0, one], [11, 11, GREEN | FLOAT, 0, one], [22, 10, BLUE | FLOAT, 0, one]] },
    bc6h: { vk: ktx.VK_FORMAT_BC6H_UFLOAT_BLOCK, bytes: 16, type: 1, block: 4, model: 133, // KHR_DF_MODEL_BC6H
            samples: [[0, 128, FLOAT, 0, one]] },
    uastc: { vk: ktx.VK_FORMAT_ASTC_4x4_SFLOAT_BLOCK_EXT, bytes: 16, type: 1, block: 4, model: 167, // UASTC HDR 4x4
             samples: [[0, 128, FLOAT, 0, one]] },
};

const text = (value) => typeof value === "string" ? value : Buffer.from(value).toString().replace(/\0$/, "");

function checkDescriptor(file, format) {
    assert.equal(file.dataFormatDescriptor.length, 1);
    const block = file.dataFormatDescriptor[0];
    assert.equal(block.vendorId, ktx.KHR_DF_VENDORID_KHRONOS);
    assert.equal(block.descriptorType, ktx.KHR_DF_KHR_DESCRIPTORTYPE_BASICFORMAT);
    assert.equal(block.colorModel, format.model ?? ktx.KHR_DF_MODEL_RGBSDA);
    assert.equal(block.colorPrimaries, ktx.KHR_DF_PRIMARIES_BT709);
    assert.equal(block.transferFunction, ktx.KHR_DF_TRANSFER_LINEAR);
    assert.equal(block.flags, ktx.KHR_DF_FLAG_ALPHA_STRAIGHT);
    const less = (format.block ?? 1) - 1;
    assert.deepEqual([...block.texelBlockDimension], [less, less, 0, 0]);
    assert.deepEqual([...block.bytesPlane], [format.bytes, 0, 0, 0, 0, 0, 0, 0]);
    assert.deepEqual(block.samples.map((s) => [s.bitOffset, s.bitLength + 1, s.channelType,
                                               Number(s.sampleLower) >>> 0, Number(s.sampleUpper) >>> 0]),
                     format.samples);
    for (const sample of block.samples)
        assert.deepEqual([...sample.samplePosition], [0, 0, 0, 0]);
}

function check(path, format, zstd, size, levels) {
    const file = ktx.read(readFileSync(path));
    assert.equal(file.vkFormat, format.vk);
    assert.equal(file.typeSize, format.type);
    assert.deepEqual([file.pixelWidth, file.pixelHeight, file.pixelDepth], [size, size, 0]);
    assert.deepEqual([file.layerCount, file.faceCount], [0, 6]);
    assert.equal(file.supercompressionScheme,
                 zstd ? ktx.KHR_SUPERCOMPRESSION_ZSTD : ktx.KHR_SUPERCOMPRESSION_NONE);
    assert.equal(file.globalData, null);

    checkDescriptor(file, format);

    assert.equal(file.levels.length, levels);
    file.levels.forEach((level, k) => {
        const edge = Math.ceil(Math.max(1, size >> k) / (format.block ?? 1));
        const bytes = 6 * edge * edge * format.bytes;
        assert.equal(level.uncompressedByteLength, bytes);
        if (zstd)
            assert.deepEqual([...level.levelData.subarray(0, 4)], [0x28, 0xb5, 0x2f, 0xfd]);
        else
            assert.equal(level.levelData.byteLength, bytes);
        if (zstd || format !== formats.rgba32f)
            return;
        // write.c: texel i of level k is (i + k / 4, 2 i, 0.5).
        const values = new Float32Array(level.levelData.slice().buffer);
        for (let i = 0; i < values.length / 4; i++)
            assert.deepEqual([...values.subarray(4 * i, 4 * i + 4)], [i + k / 4, 2 * i, 0.5, 1]);
    });

    const keys = Object.keys(file.keyValue);
    assert.deepEqual(keys, ["KTXorientation", "KTXwriter", "kiln:lobe", "kiln:roughness", "kiln:sh"]);
    assert.deepEqual(keys, [...keys].sort());
    assert.equal(text(file.keyValue.KTXorientation), "rd");
    assert.match(text(file.keyValue.KTXwriter), /^kiln \d+\.\d+\.\d+$/);
    assert.equal(text(file.keyValue["kiln:lobe"]), "ggx");
    assert.deepEqual(text(file.keyValue["kiln:roughness"]).split(" ").map(Number),
                     Array.from({ length: levels }, (_, k) => Math.fround(k / 8)));
    assert.match(text(file.keyValue["kiln:sh"]), /^bands 2\nirradiance 0\nwindow 0\n(\S+ \S+ \S+\n?){4}$/);

    // Written again by ktx-parse and read: the same.
    const again = ktx.read(ktx.write(file, { keepWriter: true }));
    assert.deepEqual(again.levels.map((l) => l.uncompressedByteLength),
                     file.levels.map((l) => l.uncompressedByteLength));
    assert.deepEqual(Object.keys(again.keyValue), keys);
}

// Tables: vkFormat of 1, 2 and 4 channels; a whole number's range is 0 to all ones.
const numbers = {
    f32: { vk: [ktx.VK_FORMAT_R32_SFLOAT, ktx.VK_FORMAT_R32G32_SFLOAT, , ktx.VK_FORMAT_R32G32B32A32_SFLOAT],
           bits: 32, array: Float32Array, value: (x) => x },
    f16: { vk: [ktx.VK_FORMAT_R16_SFLOAT, ktx.VK_FORMAT_R16G16_SFLOAT, , ktx.VK_FORMAT_R16G16B16A16_SFLOAT],
           bits: 16, array: Uint16Array, value: (x) => {
               const e = x >> 10, m = x & 1023;
               return e ? (1 + m / 1024) * 2 ** (e - 15) : m / 1024 * 2 ** -14;
           } },
    u16: { vk: [ktx.VK_FORMAT_R16_UNORM, ktx.VK_FORMAT_R16G16_UNORM, , ktx.VK_FORMAT_R16G16B16A16_UNORM],
           bits: 16, whole: true, array: Uint16Array, value: (x) => x / 65535 },
    u8: { vk: [ktx.VK_FORMAT_R8_UNORM, ktx.VK_FORMAT_R8G8_UNORM, , ktx.VK_FORMAT_R8G8B8A8_UNORM],
          bits: 8, whole: true, array: Uint8Array, value: (x) => x / 255 },
};
const kinds = { e: "e", dfg: "dfg", glass: "glass", multi: "dfg-multiscatter", walk: "e-walk" };

function checkTable(path, kind, number, zstd, channels, depth) {
    const file = ktx.read(readFileSync(path));
    const stored = channels === 3 ? 4 : channels, bits = number.bits, count = 7 * 3 * depth * stored;
    assert.equal(file.vkFormat, number.vk[stored - 1]);
    assert.equal(file.typeSize, bits / 8);
    assert.deepEqual([file.pixelWidth, file.pixelHeight, file.pixelDepth], [7, 3, depth > 1 ? depth : 0]);
    assert.deepEqual([file.layerCount, file.faceCount], [0, 1]);
    assert.equal(file.supercompressionScheme,
                 zstd ? ktx.KHR_SUPERCOMPRESSION_ZSTD : ktx.KHR_SUPERCOMPRESSION_NONE);
    checkDescriptor(file, { bytes: stored * bits / 8, samples: [RED, GREEN, BLUE, ALPHA].slice(0, stored).map(
        (channel, i) => number.whole ? [i * bits, bits, channel, 0, 2 ** bits - 1]
                                     : [i * bits, bits, channel | FLOAT | SIGNED, minusOne, one]) });
    assert.equal(file.levels.length, 1);
    const level = file.levels[0];
    assert.equal(level.uncompressedByteLength, count * bits / 8);
    if (zstd) { // whose texels tests/files/tables.c reads
        assert.deepEqual([...level.levelData.subarray(0, 4)], [0x28, 0xb5, 0x2f, 0xfd]);
    } else {
        assert.equal(level.levelData.byteLength, count * bits / 8);
        new number.array(level.levelData.slice().buffer).forEach((x, i) => {
            const channel = i % stored, texel = Math.floor(i / stored);
            const wanted = channel < channels ? (texel * channels + channel) / 1024 : 1;
            const off = Math.abs(number.value(x) - wanted);
            assert.ok(off <= (number.whole ? 0.5000001 / (2 ** bits - 1) : 0), `number ${i} is off by ${off}`);
        });
    }
    const keys = Object.keys(file.keyValue);
    assert.deepEqual(keys, ["KTXorientation", "KTXwriter", "kiln:table"]);
    assert.equal(text(file.keyValue.KTXorientation), depth > 1 ? "rdi" : "rd");
    assert.match(text(file.keyValue.KTXwriter), /^kiln \d+\.\d+\.\d+$/);
    assert.equal(text(file.keyValue["kiln:table"]), `kind=${kinds[kind]} d=ggx g=smith sheen=ashikhmin axis=cbrt ` +
                 `corners=1 complement=0 flip=0 size=7x3x${depth} paths=0`);
    const again = ktx.read(ktx.write(file, { keepWriter: true }));
    assert.deepEqual([again.pixelDepth, again.vkFormat], [file.pixelDepth, file.vkFormat]);
}

// The flat picture of three.js up to r186: one face and one level, of whole blocks.
function checkFlat(path) {
    const file = ktx.read(readFileSync(path));
    assert.deepEqual([file.vkFormat, file.typeSize], [formats.uastc.vk, 1]);
    assert.deepEqual([file.pixelWidth, file.pixelHeight, file.pixelDepth], [336, 128, 0]);
    assert.deepEqual([file.layerCount, file.faceCount, file.levels.length], [0, 1, 1]);
    checkDescriptor(file, formats.uastc);
    assert.equal(file.levels[0].uncompressedByteLength, 336 * 128);
    assert.match(text(file.keyValue["kiln:engine"]), /^engine=three-cubeuv layout=cubeuv roughness=0,/);
    const again = ktx.read(ktx.write(file, { keepWriter: true }));
    assert.deepEqual([again.pixelWidth, Object.keys(again.keyValue)], [336, Object.keys(file.keyValue)]);
}

const folder = process.argv[2];
const names = readdirSync(folder).filter((name) => name.endsWith(".ktx2"));
assert.equal(names.length, 85);
for (const name of names) {
    const [format, coding, size, levels] = name.replace(".ktx2", "").split("-");
    const [, kind, number, packing, channels, depth] = name.replace(".ktx2", "").split("-");
    try {
        if (format === "cubeuv") {
            checkFlat(join(folder, name));
            continue;
        }
        if (format === "table") {
            checkTable(join(folder, name), kind, numbers[number === "auto" ? "f16" : number], packing === "zstd",
                       Number(channels), Number(depth));
            continue;
        }
        check(join(folder, name), formats[format], coding === "zstd", Number(size), Number(levels));
    } catch (error) {
        console.error(`${name}: ${error.message}`);
        process.exit(1);
    }
}
console.log(`${names.length} files read`);

// Loads KTX2 cubes and tables written by write.c with Khronos' libktx, as WebAssembly, and compares what it
// hands to WebGL, recorded by a context that draws nothing, with the files' own bytes: node libktx.mjs FOLDER
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { read } from "ktx-parse";

const here = dirname(fileURLToPath(import.meta.url));
const libs = join(here, "node_modules/@khronosgroup/gltf-viewer/dist/libs");

// Its package takes .js for ES modules; this one is none.
const make = new Function("require", "__filename", "__dirname",
                          `${readFileSync(join(libs, "libktx.js"), "utf8")}; return LIBKTX;`)(
    createRequire(import.meta.url), join(libs, "libktx.js"), libs);
const lib = await make({ print() {}, printErr() {} });

const copy = (heap, at, size) => Buffer.from(heap.buffer, at * heap.BYTES_PER_ELEMENT, size);
const calls = [];
const record = {
    texImage2D: (target, level, inner, width, height, border, format, type, heap, at) =>
        calls.push({ target, level, inner, width, height, format, type, heap, at }),
    texImage3D: (target, level, inner, width, height, depth, border, format, type, heap, at) =>
        calls.push({ target, level, inner, width, height, depth, format, type, heap, at }),
    compressedTexImage2D: (target, level, inner, width, height, border, heap, at, size) =>
        calls.push({ target, level, inner, width, height, size, heap, at }),
    getSupportedExtensions: () => ["EXT_texture_compression_bptc"],
    getParameter: (name) => (name === 0x1f02 ? "WebGL 2.0" : 4), // VERSION; UNPACK_ALIGNMENT
    getError: () => 0,
    createTexture: () => ({}),
};
const nothing = () => null;
const context = new Proxy(record, {
    get: (target, name) => target[name] ?? (/^current/.test(name) ? undefined : nothing),
});
lib.GL.makeContextCurrent(lib.GL.registerContext(context, { majorVersion: 2, minorVersion: 0 }));

// By vkFormat: internal format, format and type of OpenGL ES 3.0, bytes of a texel.
const F = 0x1406, H = 0x140b, B = 0x1401, RED = 0x1903, RG = 0x8227, RGB = 0x1907, RGBA = 0x1908;
const formats = {
    9: [0x8229, RED, B, 1], 16: [0x822b, RG, B, 2], 37: [0x8058, RGBA, B, 4],
    76: [0x822d, RED, H, 2], 83: [0x822f, RG, H, 4], 97: [0x881a, RGBA, H, 8],
    100: [0x822e, RED, F, 4], 103: [0x8230, RG, F, 8], 109: [0x8814, RGBA, F, 16],
    122: [0x8c3a, RGB, 0x8c3b, 4], 123: [0x8c3d, RGB, 0x8c3e, 4],
    1000066000: [0x93b0, undefined, undefined, 16], // COMPRESSED_RGBA_ASTC_4x4
    143: [0x8e8f, undefined, undefined, 16], // COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT
};
const CUBE = 0x8513, POSITIVE_X = 0x8515, TEXTURE_2D = 0x0de1, TEXTURE_3D = 0x806f;

function check(name) {
    const bytes = readFileSync(join(folder, name));
    // The texels as they are without zstd stand in the twin.
    const file = read(bytes), twin = name.replace("-zstd-", "-plain-");
    const plain = twin === name ? file : read(readFileSync(join(folder, twin)));
    const texture = new lib.ktxTexture(bytes); // where it fails, all of its numbers are 0
    assert.deepEqual([texture.baseWidth, texture.baseHeight, texture.vkFormat],
                     [file.pixelWidth, file.pixelHeight, file.vkFormat]);
    assert.equal(texture.needsTranscoding, false);
    // 16 bits as whole numbers are no texture of WebGL.
    if (!formats[file.vkFormat])
        return texture.delete();
    const [inner, format, type, size] = formats[file.vkFormat];
    calls.length = 0;
    const { target, error } = texture.glUpload();
    assert.equal(error, 0);
    const cube = file.faceCount === 6;
    assert.equal(target, cube ? CUBE : file.pixelDepth ? TEXTURE_3D : TEXTURE_2D);
    assert.equal(calls.length, file.levels.length * file.faceCount);
    for (const call of calls) {
        const edge = (x) => Math.max(1, x >> call.level);
        const blocks = (x) => (file.vkFormat === 143 || file.vkFormat === 1000066000 ? Math.ceil(x / 4) : x);
        const face = cube ? call.target - POSITIVE_X : 0;
        const length = blocks(edge(file.pixelWidth)) * blocks(edge(file.pixelHeight)) *
                       edge(file.pixelDepth) * size;
        assert.deepEqual([call.inner, call.format, call.type], [inner, format, type]);
        assert.deepEqual([call.width, call.height], [edge(file.pixelWidth), edge(file.pixelHeight)]);
        assert.equal(call.size ?? length, length);
        const wanted = plain.levels[call.level].levelData.subarray(face * length, (face + 1) * length);
        if (plain === file && file.supercompressionScheme) { // a file without a twin
            assert.equal(length, file.levels[call.level].uncompressedByteLength);
            continue;
        }
        assert.ok(copy(call.heap, call.at, length).equals(wanted), `level ${call.level}, face ${face} differs`);
    }
    texture.delete();
    return calls.length;
}

// A check that cannot fail is none: of a damaged file nothing is loaded.
function refuses(name, at, what) {
    const bytes = readFileSync(join(folder, name));
    bytes[at] ^= 0xff;
    const texture = new lib.ktxTexture(bytes);
    assert.equal(texture.baseWidth, 0, `loads ${what}`);
    texture.delete();
}

const folder = process.argv[2];
const names = readdirSync(folder).filter((name) => name.endsWith(".ktx2"));
let uploads = 0;
for (const name of names) {
    try {
        uploads += check(name) ?? 0;
    } catch (error) {
        console.error(`libktx, ${name}: ${error.message ?? error}`);
        process.exit(1);
    }
}
assert.ok(uploads > 300, `only ${uploads} uploads`);
refuses("rgba16f-plain-8-4.ktx2", 4, "a damaged identifier");
refuses("rgba16f-zstd-8-4.ktx2", 40, "levels that are not there");
refuses("bc6h-plain-8-4.ktx2", 36, "faces that are none");
refuses("rgb9e5-plain-8-4.ktx2", 80 + 8, "a level whose size is not its texels'");
console.log(`libktx: ${names.length} files, ${uploads} uploads`);

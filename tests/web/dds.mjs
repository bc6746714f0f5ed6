// A browser's WebGL 2 reads every DDS format as the floats it was made of, to the format's rounding:
//   node dds.mjs KILN SITE FOLDER
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { withPage } from './browser.mjs';

const [kiln, , folder] = process.argv.slice(2).map((name) => path.resolve(name));
const SIZE = 32, LEVELS = 3;
fs.mkdirSync(folder, { recursive: true });
const run = (...args) => execFileSync(kiln, args, { cwd: folder, encoding: 'utf8' });
run('sky', '-q', '--size', '128', '--elevation', '-3', '-o', 'sky.exr');

// The file by the letter of its header; faces one after the other, each with its levels.
const FORMATS = { rgba32f: [2, 16, 1], rgba16f: [10, 8, 1], rgb9e5: [67, 4, 1], b10g11r11: [26, 4, 1], bc6h: [95, 16, 4] };
function readFile(name, format = name, levels = LEVELS) {
    const bytes = fs.readFileSync(path.join(folder, `${name}.dds`)), [dxgi, unit, block] = FORMATS[format];
    assert.equal(bytes.toString('latin1', 0, 4), 'DDS ');
    assert.equal(bytes.toString('latin1', 84, 88), 'DX10');
    assert.deepEqual([4, 12, 16, 28].map((at) => bytes.readUInt32LE(at)), [124, SIZE, SIZE, levels]);
    assert.deepEqual([128, 132, 136, 140].map((at) => bytes.readUInt32LE(at)), [dxgi, 3, 4, 1]);
    const parts = [];
    let at = 148;
    for (let face = 0; face < 6; face++)
        for (let level = 0; level < levels; level++) {
            const size = SIZE >> level, length = (size / block) ** 2 * unit;
            parts.push({ size, base64: bytes.toString('base64', at, at + length) });
            at += length;
        }
    assert.equal(at, bytes.length);
    return parts;
}

// In the page: what the device makes of a picture's bytes.
function decode([name, parts]) {
    const gl = document.createElement('canvas').getContext('webgl2');
    const bptc = gl.getExtension('EXT_texture_compression_bptc');
    if (!gl.getExtension('EXT_color_buffer_float') || !bptc)
        throw new Error('no float targets or no BPTC here');
    const program = gl.createProgram();
    for (const [type, text] of [
        [gl.VERTEX_SHADER, 'void main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1); }'],
        [gl.FRAGMENT_SHADER, 'precision highp float; precision highp sampler2D; uniform sampler2D t; out vec4 c; ' +
                             'void main() { c = texelFetch(t, ivec2(gl_FragCoord.xy), 0); }']]) {
        const shader = gl.createShader(type);
        gl.shaderSource(shader, `#version 300 es\n${text}`);
        gl.compileShader(shader);
        gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    gl.useProgram(program);
    return parts.map(({ size, base64 }) => {
        const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0)), words = bytes.buffer;
        gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
        const [inside, format, type, data] = {
            rgba32f: [gl.RGBA32F, gl.RGBA, gl.FLOAT, new Float32Array(words)],
            rgba16f: [gl.RGBA16F, gl.RGBA, gl.HALF_FLOAT, new Uint16Array(words)],
            rgb9e5: [gl.RGB9_E5, gl.RGB, gl.UNSIGNED_INT_5_9_9_9_REV, new Uint32Array(words)],
            b10g11r11: [gl.R11F_G11F_B10F, gl.RGB, gl.UNSIGNED_INT_10F_11F_11F_REV, new Uint32Array(words)],
            bc6h: [],
        }[name];
        if (inside)
            gl.texImage2D(gl.TEXTURE_2D, 0, inside, size, size, 0, format, type, data);
        else
            gl.compressedTexImage2D(gl.TEXTURE_2D, 0, bptc.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT, size, size, 0, bytes);
        const source = gl.getParameter(gl.TEXTURE_BINDING_2D);
        gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, size, size);
        gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D,
                                gl.getParameter(gl.TEXTURE_BINDING_2D), 0);
        gl.bindTexture(gl.TEXTURE_2D, source);
        gl.viewport(0, 0, size, size);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
        const shown = new Float32Array(4 * size * size);
        gl.readPixels(0, 0, size, size, gl.RGBA, gl.FLOAT, shown);
        if (gl.getError())
            throw new Error(`${name}: the device does not take it`);
        return [...shown];
    });
}

// Half a unit in the last place of what a format has: of a channel, or of the largest of three.
const bounds = {
    rgba32f: () => 0,
    rgba16f: (x) => Math.max(x * 2 ** -11, 2 ** -25),
    rgb9e5: (x, c, most) => most * 2 ** -9,
    bc6h: (x) => x * 2 ** -10, // of what kiln decodes
    b10g11r11: (x, c) => Math.max(x * 2 ** (c < 2 ? -7 : -6), 2 ** (c < 2 ? -21 : -20)),
};

for (const name of Object.keys(FORMATS))
    run('bake', 'sky.exr', '-q', '--size', `${SIZE}`, '--levels', `${LEVELS}`, '--format', name, '-o', `${name}.dds`);
// A mirror of its own size is the source.
run('bake', 'bc6h.dds', '-q', '--size', `${SIZE}`, '--levels', '1', '--roughness', '0', '--format', 'rgba32f',
    '-o', 'decoded.dds');
const floats = ({ base64 }) => new Float32Array(new Uint8Array(Buffer.from(base64, 'base64')).buffer);
fs.writeFileSync(path.join(folder, 'index.html'), '<!doctype html><title>dds</title><link rel="icon" href="data:,">');
await withPage(folder, async (page, address) => {
    await page.goto(address);
    const exact = readFile('rgba32f').map(floats), decoded = readFile('decoded', 'rgba32f', 1).map(floats);
    for (const name of Object.keys(FORMATS)) {
        let shown = await page.evaluate(decode, [name, readFile(name)]), made = exact;
        if (name === 'bc6h')
            [shown, made] = [shown.filter((_, part) => part % LEVELS === 0), decoded];
        let most = 0, squares = 0, whole = 0;
        shown.forEach((texels, part) => texels.forEach((x, i) => {
            const c = i % 4, wanted = made[part][i], rgb = made[part].subarray(i - c, i - c + 3);
            if (c === 3)
                return assert.equal(x, 1, `${name}: alpha is ${x}`);
            squares += (x - wanted) ** 2;
            whole += wanted ** 2;
            most = Math.max(most, Math.abs(x - wanted) / wanted);
            assert.ok(Math.abs(x - wanted) <= bounds[name](wanted, c, Math.max(...rgb)),
                      `${name}: ${x} in picture ${part}, texel ${i >> 2}, channel ${c}, wanted ${wanted}`);
        }));
        assert.ok(whole > 0, `${name} is black`);
        console.log(`  ${name}: rms ${Math.sqrt(squares / whole).toExponential(1)}, ${most.toExponential(1)} at most`);
    }
});

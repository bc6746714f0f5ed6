// The WGSL that kiln writes for tables of lobes, run by the browser's WebGPU, computes the light that
// docs/theory/lobes.md defines, which is summed here in other words:
//   node wgsl.mjs KILN SITE FOLDER
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { withPage } from './browser.mjs';

const [kiln, site, folder] = process.argv.slice(2).map((name) => path.resolve(name));
const SIZE = 12, LEVELS = 5, FACE = 128, POINTS = 400;
fs.mkdirSync(folder, { recursive: true });

// Radiance of a level in a direction, in two environments: the same from all sides, which tests levels and weights, and
// linear in the direction.
const environments = [
    (d, level) => [1 + 0.3 * level, 2 - 0.2 * level, 0.5],
    (d) => [1 + 0.5 * d[0], 1.5 - 0.8 * d[1], 1 + 0.7 * d[2]],
];
// Bilinear texels of small levels are not linear in the direction, and halves and weights of the filter are rounded.
const tolerances = [2e-3, 1.5e-2];

const half = (bits) => {
    const exponent = bits >> 10 & 31, mantissa = bits & 1023;
    const value = exponent ? (1 + mantissa / 1024) * 2 ** (exponent - 15) : mantissa * 2 ** -24;
    return bits >> 15 ? -value : value;
};
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const add = (a, s, b, t) => a.map((x, i) => s * x + t * b[i]);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => add(a, 1 / Math.hypot(...a), a, 0);

let state = 1;
const random = () => {
    state = state * 16807 % 2147483647;
    return state / 2147483647;
};
const direction = () => unit([random() - 0.5, random() - 0.5, random() - 0.5]);

// Points at texels of the table, where no weight of the filter matters: n, v, roughness and the texel.
function makePoint() {
    const column = Math.floor(random() * SIZE), row = Math.floor(random() * SIZE), n = direction();
    const nov = column / (SIZE - 1), t = unit(cross(n, direction()));
    const v = add(n, nov, t, Math.sqrt(1 - nov * nov));
    return { n, v, nov, roughness: row / (SIZE - 1), texel: row * SIZE + column };
}

// Degree l of the light of `sh` as a homogeneous polynomial in a vector.
const band = [
    (sh) => 0.28209479 * sh[0],
    (sh, d) => 0.48860251 * (sh[1] * d[1] + sh[2] * d[2] + sh[3] * d[0]),
    (sh, [x, y, z]) => 1.09254843 * (sh[4] * x * y + sh[5] * y * z + sh[7] * x * z) +
        0.31539157 * sh[6] * (2 * z * z - x * x - y * y) + 0.54627422 * sh[8] * (x * x - y * y),
];

// The table's numbers at a point: those of each slice, and the directions of the taps.
function lookUp(table, taps, { n, v, nov, texel }) {
    const t = nov < 1 ? unit(add(n, nov, v, -1)) : unit(cross(n, [0.3, 0.5, 0.8]));
    const slices = Array.from({ length: taps + 1 }, (_, k) =>
        table.slice(4 * (k * SIZE * SIZE + texel), 4 * (k * SIZE * SIZE + texel + 1)));
    const directions = slices.slice(0, taps).map(([lean]) =>
        add(n, Math.cos(Math.acos(nov) - lean), t, Math.sin(Math.acos(nov) - lean)));
    return { t, slices, directions };
}

// SwiftShader's WebGPU darkens the outermost half texel of each face of a cube. False if a tap reads there.
function isClear(table, taps, point) {
    const { slices, directions } = lookUp(table, taps, point);
    return directions.every((d, k) => {
        const [, second, largest] = d.map(Math.abs).sort((a, b) => a - b);
        return second / largest < 1 - 1.1 / (FACE >> Math.min(Math.ceil(slices[k][1]), LEVELS - 1));
    });
}

// The light of one channel, and whether it is the least light that is returned beside bright light.
function reflect(table, taps, sh, radiance, point, channel) {
    const { n } = point, { t, slices, directions } = lookUp(table, taps, point), b = cross(n, t), c = [];
    let sum = 0, rest = 1, lowest = Infinity;
    for (let k = 0; k < taps; k++) {
        const [, level, weight, coefficient] = slices[k], d = directions[k];
        const low = Math.min(Math.floor(level), LEVELS - 2), share = level - low;
        const light = (1 - share) * radiance(d, low)[channel] + share * radiance(d, low + 1)[channel];
        sum += weight * light;
        lowest = Math.min(lowest, light);
        rest -= weight;
        c.push(coefficient);
    }
    c.push(...slices[taps]);
    const of = (l, d) => band[l](sh.map((each) => each[channel]), d);
    const mixed = (of(2, add(n, 1, t, 1)) - of(2, n) - of(2, t)) / 2;
    sum += rest * of(0) + c[0] * of(1, n) + c[1] * of(1, t);
    sum += c[2] * of(2, n) + c[3] * mixed + c[4] * (of(2, t) - of(2, b));
    const least = 0.6 * Math.min(Math.max(1 - rest, 0), 1) * lowest;
    return { light: Math.max(sum, least), bound: sum < least };
}

// In the page: runs the shader at all points, in each environment.
async function run({ code, taps, size, table, cubes, points, sh }) {
    const adapter = await navigator.gpu?.requestAdapter();
    if (!adapter)
        throw new Error('no WebGPU here');
    const device = await adapter.requestDevice();
    const bytes = (base64) => Uint8Array.from(atob(base64), (each) => each.charCodeAt(0));
    const module = device.createShaderModule({ code: `${code}
        @group(0) @binding(0) var table: texture_3d<f32>;
        @group(0) @binding(1) var levels: texture_cube<f32>;
        @group(0) @binding(2) var linear: sampler;
        @group(0) @binding(3) var<storage, read> given: array<vec4<f32>>;
        @group(0) @binding(4) var<storage, read_write> made: array<vec4<f32>>;
        @compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
            var sh: array<vec3<f32>, 9>;
            for (var k = 0; k < 9; k++) {
                sh[k] = given[k].xyz;
            }
            let n = given[9 + 2 * id.x];
            let v = given[10 + 2 * id.x];
            made[id.x] = vec4<f32>(l_reflect(table, levels, linear, sh, n.xyz, v.xyz, n.w), 1.0);
        }` });
    const { messages } = await module.getCompilationInfo();
    if (messages.length)
        throw new Error(messages.map((each) => `${each.type}, line ${each.lineNum}: ${each.message}`).join('\n'));
    const usage = GPUTextureUsage.COPY_DST | GPUTextureUsage.TEXTURE_BINDING;
    const lobes = device.createTexture({ size: [size, size, taps + 1], dimension: '3d', format: 'rgba16float', usage });
    device.queue.writeTexture({ texture: lobes }, bytes(table), { bytesPerRow: 8 * size, rowsPerImage: size },
                              [size, size, taps + 1]);
    const pipeline = device.createComputePipeline({ layout: 'auto', compute: { module, entryPoint: 'main' } });
    const linear = device.createSampler({ magFilter: 'linear', minFilter: 'linear', mipmapFilter: 'linear' });
    const given = device.createBuffer({ size: 16 * (9 + 2 * points.length),
                                        usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST });
    device.queue.writeBuffer(given, 0, new Float32Array(
        [...sh.map((each) => [...each, 0]), ...points.flatMap((p) => [[...p.n, p.roughness], [...p.v, 0]])].flat()));
    const results = [];
    for (const cube of cubes) {
        const levels = cube.map((texels) => new Float16Array(new Float32Array(bytes(texels).buffer)));
        const edge = Math.sqrt(levels[0].length / 24);
        const texture = device.createTexture({ size: [edge, edge, 6], mipLevelCount: levels.length,
                                               format: 'rgba16float', usage });
        levels.forEach((texels, mipLevel) => {
            const width = edge >> mipLevel;
            device.queue.writeTexture({ texture, mipLevel }, texels, { bytesPerRow: 8 * width, rowsPerImage: width },
                                      [width, width, 6]);
        });
        const room = 16 * points.length;
        const made = device.createBuffer({ size: room, usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC });
        const read = device.createBuffer({ size: room, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
        const group = device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries: [
            lobes.createView(), texture.createView({ dimension: 'cube' }), linear, { buffer: given }, { buffer: made },
        ].map((resource, binding) => ({ binding, resource })) });
        const encoder = device.createCommandEncoder(), pass = encoder.beginComputePass();
        pass.setPipeline(pipeline);
        pass.setBindGroup(0, group);
        pass.dispatchWorkgroups(points.length);
        pass.end();
        encoder.copyBufferToBuffer(made, 0, read, 0, room);
        device.queue.submit([encoder.finish()]);
        await read.mapAsync(GPUMapMode.READ);
        results.push([...new Float32Array(read.getMappedRange())]);
    }
    return results;
}

// Texels of a level of a cube as floats in base64, in the order and orientation of WebGPU: +X -X +Y -Y +Z -Z.
function makeLevel(radiance, level) {
    const size = FACE >> level, texels = [];
    for (let face = 0; face < 6; face++)
        for (let y = 0; y < size; y++)
            for (let x = 0; x < size; x++) {
                const u = 2 * (x + 0.5) / size - 1, w = 2 * (y + 0.5) / size - 1;
                const d = [[1, -w, -u], [-1, -w, u], [u, 1, w], [u, -1, -w], [u, -w, 1], [-u, -w, -1]][face];
                texels.push(...radiance(unit(d), level), 1);
            }
    return Buffer.from(new Float32Array(texels).buffer).toString('base64');
}

const cubes = environments.map((radiance) => Array.from({ length: LEVELS }, (_, k) => makeLevel(radiance, k)));
await withPage(site, async (page, address) => {
    // WebGPU is there for pages of this machine's server, but not for a page without an address.
    const body = '<!doctype html><link rel="icon" href="data:,">';
    await page.route('**/empty', (route) => route.fulfill({ contentType: 'text/html', body }));
    await page.goto(`${address}empty`);
    for (let taps = 1; taps <= 3; taps++) {
        execFileSync(kiln, ['tables', '--table', 'lobes', '--taps', `${taps}`, '--levels', `${LEVELS}`, '--size',
                            `${SIZE}`, '--format', 'f16', '-o', 'l.raw', '--lookup', '-q'], { cwd: folder });
        const raw = fs.readFileSync(path.join(folder, 'l.raw'));
        const table = Array.from({ length: raw.length / 2 }, (_, i) => half(raw.readUInt16LE(2 * i)));
        const points = [];
        while (points.length < POINTS) {
            const point = makePoint();
            if (isClear(table, taps, point))
                points.push(point);
        }
        const sh = Array.from({ length: 9 }, (_, i) => [0, 1, 2].map(() => 4 * (random() - (i ? 0.5 : 0))));
        const results = await page.evaluate(run, {
            code: fs.readFileSync(path.join(folder, 'l_lookup.wgsl'), 'utf8'), taps, size: SIZE,
            table: raw.toString('base64'), points, sh, cubes,
        });
        let bound = 0;
        environments.forEach((radiance, e) => {
            let worst = 0;
            points.forEach((point, i) => {
                for (let channel = 0; channel < 3; channel++) {
                    const wanted = reflect(table, taps, sh, radiance, point, channel);
                    bound += wanted.bound;
                    worst = Math.max(worst, Math.abs(results[e][4 * i + channel] - wanted.light));
                }
            });
            console.log(`taps ${taps}, environment ${e}: largest error ${worst.toExponential(1)}`);
            assert.ok(worst < tolerances[e], `taps ${taps}, environment ${e}: error ${worst}`);
        });
        assert.ok(bound > 10 && bound < 3 * POINTS, `the least light is returned for ${bound} numbers`);
    }
}, ['--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader']);

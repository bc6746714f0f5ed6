// What each engine shows, as models in JS: by its name in kiln's table, the page that draws with it, what
// kiln is told to write and what the page loads.
//
// model(count, size), of the file's levels:
//   toKiln    the engine's direction as kiln's
//   lod       the level that is read for a roughness
//   shade     of n.v and roughness, [single, multiple]: value = single L(way, lod) + multiple I(normal) / pi
//   clamp     the least roughness; bend: how far the reflection is bent towards the normal
//   harmonics diffuse light is theirs; distance: of the camera, where rays are taken to be parallel but are not
//   told      the direction as the coarse texels tell it; curve: what becomes of radiance after it is read
//   coding    encode(rgb) and decode(rgba) of texels that are interpolated before they are decoded
// smallest: the size below which no level goes; words: what else `kiln bake` is told; asked: what else the page is told
// filtersNothing: the engine has no filter of its own; lightless: its page draws no lights in an environment
import { readTable } from './three-table.mjs';

// Panoramas have +X in the centre and +Z to the right, where kiln's have -Z and +X. Fdez-Aguera of white metal:
// what one bounce loses comes back as diffuse light.
const threeShading = (name) => {
    const table = readTable(name);
    return {
        toKiln: ([x, y, z]) => [z, y, -x],
        bend: (r) => r ** 4,
        shade: (nov, r) => {
            const [a, b] = table(r, nov);
            return [a + b, 1 - a - b];
        },
    };
};
export const three = {
    name: 'three', page: 'three.html', ending: '.ktx2', loads: '.ktx2',
    model: (count) => ({
        ...threeShading('three'),
        clamp: (r) => Math.max(r, 0.045),
        lod: (r) => (count - 1) * r * (2 - r),
    }),
};

// cube_uv_reflection_fragment.glsl.js: the mip of a roughness.
function roughnessToMip(r) {
    if (r < 0.21)
        return -2 * Math.log2(1.16 * r);
    const steps = [[1, -2], [0.8, -1], [0.4, 2], [0.305, 3], [0.21, 4]];
    const i = steps.findIndex(([end]) => r >= end), [low, mip] = steps[i];
    if (r === low)
        return mip;
    const [high, next] = steps[i - 1];
    return mip + (r - low) / (high - low) * (next - mip);
}
export const threeCubeUv = {
    name: 'three-cubeuv', page: 'three-cubeuv.html', ending: '.exr', loads: '.exr', smallest: 32,
    model: (count, size) => ({
        ...threeShading('three-r183'),
        clamp: (r) => Math.max(r, 0.0525),
        lod: (r) => Math.log2(size / 2) - roughnessToMip(r),
        told: (way) => way, // kiln's texels are such that what is read between them is right
    }),
};

// Up to r180: A and B by a closed form, and the reflection bent by r^2 instead of r^4.
export function approximateSplit(r, nov) {
    const [x, y, z, w] = [1 - r, 0.0425 - 0.0275 * r, 1.04 - 0.572 * r, 0.022 * r - 0.04];
    const a = Math.min(x * x, 2 ** (-9.28 * nov)) * x + y;
    return [-1.04 * a + z, 1.04 * a + w];
}
function approximateAlbedo(nov, r) {
    const [a, b] = approximateSplit(r, nov);
    return a + b;
}
export const threeCubeUvApproximate = {
    ...threeCubeUv,
    model: (...sizes) => ({
        ...threeCubeUv.model(...sizes),
        bend: (r) => r * r,
        shade: (nov, r) => [approximateAlbedo(nov, r), 1 - approximateAlbedo(nov, r)],
    }),
};

const slope = (r) => r * r + 0.0005;
export const babylon = {
    name: 'babylon', page: 'babylon.html', ending: '.env', loads: '.env',
    model: (count, size) => ({
        // Its panoramas have +Z in the centre and +X to the right, where kiln's have -Z and +X.
        toKiln: ([x, y, z]) => [x, y, -z],
        lod: (r) => Math.min(count - 1, Math.max(0, Math.log2(size * slope(r)) * 0.8)),
        // What one bounce loses is put back, so that white metal is 1; radiance goes over to irradiance.
        shade: (nov, r) => [1 - slope(r), slope(r)],
        harmonics: true,
        distance: 20000,
    }),
};
export const babylonDds = { ...babylon, name: 'babylon-dds', ending: '.dds', loads: '.dds' };

export const filament = {
    name: 'filament', page: 'filament.html', ending: '', loads: '_ibl.ktx',
    model: (count) => ({
        // Its panoramas have +Z in the centre and -X to the right, where kiln's have -Z and +X.
        toKiln: ([x, y, z]) => [-x, y, -z],
        clamp: (r) => Math.max(r, 0.045),
        bend: (r) => r ** 4,
        lod: (r) => (count - 1) * r * (2 - r),
        shade: () => [1, 0], // white metal is 1 after its compensation
    }),
};

export const playcanvas = {
    name: 'playcanvas', page: 'playcanvas.html', ending: '.png', loads: '.png',
    model: (count) => ({
        // Its panoramas have +Z in the centre and -X to the right, where kiln's have -Z and +X.
        toKiln: ([x, y, z]) => [-x, y, -z],
        lod: (r) => (count - 1) * r,
        shade: () => [1, 0], // no table: white metal is 1
        distance: 20000,
        told: (way) => way, // kiln's texels are such that what is read between them is right
    }),
};
export const playcanvasDds = { ...playcanvas, name: 'playcanvas-dds', ending: '.dds', loads: '.dds' };

// BrdfLutGeneratorFS.glsl: A + B by 1024 samples, in a table of 256 x 256 pairs of bytes that is read without
// interpolation.
const radicalInverse = (i) => {
    let value = 0;
    for (let base = 0.5; i; i >>= 1, base /= 2)
        value += (i & 1) * base;
    return value;
};
function sumSplit(roughness, nov) {
    const a2 = roughness ** 4, x = Math.sqrt(1 - nov * nov), sums = [0, 0];
    for (let i = 0; i < 1024; i++) {
        const angle = 2 * Math.PI * i / 1024, xi = radicalInverse(i);
        const noh = Math.sqrt((1 - xi) / (1 + (a2 - 1) * xi)), side = Math.sqrt(1 - noh * noh);
        const voh = x * side * Math.sin(angle) + nov * noh, nol = Math.min(1, 2 * voh * noh - nov);
        if (nol <= 0)
            continue;
        const visible = 0.5 / (nol * Math.sqrt(nov * nov * (1 - a2) + a2) + nov * Math.sqrt(nol * nol * (1 - a2) + a2));
        const weight = 4 * visible * Math.max(0, voh) * nol / noh / 1024, schlick = (1 - Math.max(0, voh)) ** 5;
        sums[0] += (1 - schlick) * weight;
        sums[1] += schlick * weight;
    }
    return sums.reduce((sum, value) => sum + Math.round(255 * Math.min(1, value)) / 255, 0);
}
const splits = new Map();
function cesiumAlbedo(nov, roughness) {
    const [i, j] = [nov, roughness].map((x) => Math.min(255, Math.floor(256 * x)));
    if (!splits.has(256 * j + i))
        splits.set(256 * j + i, sumSplit((j + 0.5) / 256, (i + 0.5) / 256));
    return splits.get(256 * j + i);
}
export const cesium = {
    name: 'cesium', page: 'cesium/cesium.html', ending: '', loads: '', filtersNothing: true, lightless: true,
    model: (count) => ({
        toKiln: (way) => way, // east, up and south
        lod: (r) => (count - 1) * r,
        shade: (nov, r) => {
            const albedo = cesiumAlbedo(nov, r);
            return [albedo, 1 - albedo];
        },
        harmonics: true,
        distance: 5000,
    }),
};

// ibl_frag_define: A + B by a closed form, and metal shows no diffuse light. Texels hold radiance 5 a c in bytes. Files
// are baked 16 times darker, so that they hold radiance up to 80, and the engine multiplies its light by 16.
const STEP = 16 * 5 / 255;
const galaceanTexels = {
    encode: (rgb) => {
        const a = Math.min(255, Math.max(1, Math.ceil(Math.max(...rgb) / STEP)));
        return [...rgb].map((x) => Math.round(255 * Math.min(1, Math.max(0, x) / (a * STEP)))).concat(a);
    },
    decode: ([r, g, b, a]) => [r, g, b].map((c) => c * a * STEP / 255),
};
export const galacean = {
    name: 'galacean', page: 'galacean/galacean.html', ending: '.env', loads: '.env', filtersNothing: true, lightless: true,
    words: ['--exposure', '-4'], asked: { intensity: 16 },
    model: (count) => ({
        // Its panoramas have -X in the centre and -Z to the right, where kiln's have -Z and +X.
        toKiln: ([x, y, z]) => [-z, y, x],
        lod: (r) => (count - 1) * r,
        shade: (nov, r) => [approximateAlbedo(nov, r), 0],
        coding: galaceanTexels,
        harmonics: true,
    }),
};

// One model for each way of loading in the current version of each engine.
export const current = [three, threeCubeUv, babylon, babylonDds, filament, playcanvas, playcanvasDds, cesium,
                        galacean];

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
// smallest: the size below which no level goes.
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

// Up to r180: A and B by a closed form, whose sum this is, and the reflection bent by r^2 instead of r^4.
function approximateAlbedo(nov, r) {
    const [x, y, z, w] = [1 - r, 0.0425 - 0.0275 * r, 1.04 - 0.572 * r, 0.022 * r - 0.04];
    const a = Math.min(x * x, 2 ** (-9.28 * nov)) * x + y;
    return -1.04 * a + z + (1.04 * a + w);
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

// One model for each way of loading in the current version of each engine.
export const current = [three, threeCubeUv, babylon, babylonDds, filament, playcanvas, playcanvasDds];

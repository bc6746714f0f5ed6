// three.js r183 shows what kiln wrote for r181 to r186: MeshStandardMaterial, lit by scene.environment.
import { proveEngine } from './rig.mjs';
import { readTable } from './three-table.mjs';

const table = readTable('three-r183');

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

await proveEngine({
    name: 'three-cubeuv', page: 'three-cubeuv.html', ending: '.exr', smallest: 32,
    model: (count, size) => ({
        // Its panoramas have +X in the centre and +Z to the right, where kiln's have -Z and +X.
        toKiln: ([x, y, z]) => [z, y, -x],
        clamp: (r) => Math.max(r, 0.0525),
        bend: (r) => r ** 4,
        lod: (r) => Math.log2(size / 2) - roughnessToMip(r),
        // Fdez-Aguera of white metal: what one bounce loses comes back as diffuse light.
        shade: (nov, r) => {
            const [a, b] = table(r, nov);
            return [a + b, 1 - a - b];
        },
        told: (way) => way, // kiln's texels are such that what is read between them is right
    }),
    bounds: { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-3, most: 2e-3 },
              // The model knows no texels, of which there are 14 across a face from roughness 0.21 on.
              real: [{ rows: [0.45, 1], rms: 5e-3, most: 0.02 }, { rows: [0.1, 0.1], rms: 0.015, most: 0.1 },
                     { rms: 0.05 }] },
});

// three.js shows what kiln wrote: MeshStandardMaterial, lit by scene.environment.
import { proveEngine } from './rig.mjs';
import { readTable } from './three-table.mjs';

const table = readTable('three');

await proveEngine({
    name: 'three',
    page: 'three.html',
    ending: '.ktx2',
    model: (count) => ({
        // Its panoramas have +X in the centre and +Z to the right, where kiln's have -Z and +X.
        toKiln: ([x, y, z]) => [z, y, -x],
        clamp: (r) => Math.max(r, 0.045),
        bend: (r) => r ** 4,
        lod: (r) => (count - 1) * r * (2 - r),
        // Fdez-Aguera of white metal: what one bounce loses comes back as diffuse light.
        shade: (nov, r) => {
            const [a, b] = table(r, nov);
            return [a + b, 1 - a - b];
        },
    }),
    bounds: { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-3, most: 2e-3 },
              real: { rms: 1e-3, most: 5e-3 } },
});

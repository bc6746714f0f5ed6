// PlayCanvas shows what kiln wrote: StandardMaterial, lit by scene.envAtlas.
import { proveEngine } from './rig.mjs';

const engine = {
    page: 'playcanvas.html',
    model: (count) => ({
        // Its panoramas have +Z in the centre and -X to the right, where kiln's have -Z and +X.
        toKiln: ([x, y, z]) => [-x, y, -z],
        lod: (r) => (count - 1) * r,
        shade: () => [1, 0], // no table: white metal is 1
        distance: 20000,
        told: (way) => way, // kiln's texels are such that what is read between them is right
    }),
};
// The model knows no texels: a mirror of 512 by 256, and 14 by 6 at roughness 1.
await proveEngine({
    ...engine, name: 'playcanvas', ending: '.png',
    bounds: { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-6, most: 1e-6 },
              real: [{ rows: [0.2, 0.8], rms: 4e-3, most: 0.05 }, { rms: 0.012 }],
              diffuse: { rms: 4e-3, most: 0.05 } },
});
await proveEngine({
    ...engine, name: 'playcanvas-dds', ending: '.dds',
    bounds: { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-6, most: 1e-6 },
              real: [{ rows: [0.2, 0.8], rms: 4e-3, most: 0.05 }, { rms: 0.012 }],
              diffuse: { rms: 4e-3, most: 0.05 } },
});

// Babylon.js shows what kiln wrote: PBRMaterial, lit by scene.environmentTexture.
import { proveEngine } from './rig.mjs';

const slope = (r) => r * r + 0.0005;
const model = (count, size) => ({
    // Its panoramas have +Z in the centre and +X to the right, where kiln's have -Z and +X.
    toKiln: ([x, y, z]) => [x, y, -z],
    lod: (r) => Math.min(count - 1, Math.max(0, Math.log2(size * slope(r)) * 0.8)),
    // What one bounce loses is put back, so that white metal is 1; radiance goes over to irradiance.
    shade: (nov, r) => [1 - slope(r), slope(r)],
    harmonics: true,
    distance: 20000,
});

await proveEngine({
    name: 'babylon', page: 'babylon.html', ending: '.env', model,
    bounds: { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-3, most: 2e-3 },
              real: { rms: 5e-3, most: 0.03 } },
});
await proveEngine({
    name: 'babylon-dds', page: 'babylon.html', ending: '.dds', model,
    bounds: { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-3, most: 2e-3 },
              real: { rms: 1e-3, most: 5e-3 } },
});

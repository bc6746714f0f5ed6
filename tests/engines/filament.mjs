// Filament's web build shows what kiln wrote: a glTF of white metal, lit by createIblFromKtx1.
import { proveEngine } from './rig.mjs';

const engine = {
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
await proveEngine({
    ...engine,
    bounds: { coded: { axes: 0.01, lod: 0.02 }, white: { rms: 5e-3, most: 5e-3 },
              real: { rms: 5e-3, most: 0.03 } },
});
// Red and green are rounded by 1/128 at most, blue by 1/64.
await proveEngine({
    ...engine, format: ['b10g11r11', 4],
    bounds: { coded: { axes: 0.01, lod: 0.02 },
              real: { rms: 6e-3, most: 0.025 } },
});

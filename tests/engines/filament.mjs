// Filament's web build shows what kiln wrote: a glTF of white metal, lit by createIblFromKtx1.
import { filament } from './models.mjs';

export default [{
    ...filament, title: 'filament in rgba16f', format: ['rgba16f', 1],
    bounds: { coded: { axes: 5e-4, lod: 5e-4 }, white: { rms: 1e-6, most: 1e-6 },
              real: { rms: 5e-4, most: 3e-3 }, byDefault: { rms: 5e-4, most: 0.015 } },
}, { // by default b10g11r11: red and green are rounded by 1/128 at most, blue by 1/64
    ...filament,
    bounds: { coded: { axes: 0.01, lod: 5e-3 },
              real: { rms: 4e-3, most: 1 / 64 } },
}];

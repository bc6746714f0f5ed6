// Filament's web build shows what kiln wrote: a glTF of white metal, lit by createIblFromKtx1.
import { filament } from './models.mjs';

export default [{
    ...filament,
    bounds: { coded: { axes: 0.01, lod: 0.02 }, white: { rms: 5e-3, most: 5e-3 },
              real: { rms: 5e-3, most: 0.03 }, byDefault: { rms: 5e-3, most: 0.03 } },
}, { // red and green are rounded by 1/128 at most, blue by 1/64
    ...filament, title: 'filament in b10g11r11', format: ['b10g11r11', 4],
    bounds: { coded: { axes: 0.01, lod: 0.02 },
              real: { rms: 6e-3, most: 0.025 } },
}];

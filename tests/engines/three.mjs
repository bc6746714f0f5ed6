// three.js shows what kiln wrote: MeshStandardMaterial, lit by scene.environment.
import { three } from './models.mjs';

export default [{
    ...three, title: 'three in rgba16f', format: ['rgba16f', 1],
    bounds: { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-3, most: 2e-3 },
              real: { rms: 1e-3, most: 5e-3 }, byDefault: { rms: 1e-3, most: 5e-3 } },
}, { // by default rgb9e5: texels err by 2^-9 of their largest channel at most
    ...three,
    bounds: { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-3, most: 2e-3 }, real: { rms: 1e-3, most: 0.02 } },
}, {
    // In the coded file red, green and blue rise along three axes, which two lines of colours for each block tell
    // only roughly: texels of its last levels err by 2 to 4 %.
    ...three, title: 'three in uastc', format: ['uastc', 9],
    bounds: { coded: { axes: 0.1, lod: 0.2 }, white: { rms: 1e-3, most: 2e-3 }, real: { rms: 0.015, most: 0.25 } },
}];

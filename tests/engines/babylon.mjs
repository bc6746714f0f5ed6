// Babylon.js shows what kiln wrote: PBRMaterial, lit by scene.environmentTexture.
import { babylon, babylonDds } from './models.mjs';

export default [{
    ...babylon,
    bounds: { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-3, most: 2e-3 },
              real: { rms: 5e-3, most: 0.03 }, byDefault: { rms: 5e-3, most: 0.03 } },
}, {
    ...babylonDds,
    bounds: { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-3, most: 2e-3 },
              real: { rms: 1e-3, most: 5e-3 } },
}];

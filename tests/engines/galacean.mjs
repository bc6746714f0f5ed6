// Galacean Engine shows what kiln wrote: PBRMaterial, lit by scene.ambientLight.
import { galacean } from './models.mjs';

const levels = [{ rows: [0.1, 0.6], rms: 1e-5, most: 1e-4 }, { rms: 1e-3, most: 0.03 }];

export default [{
    ...galacean,
    // In the coded file colours differ so much from texel to texel that the levels of one and of four texels show how
    // the engine interpolates colour and multiplier apart, of which the fit knows nothing.
    bounds: { coded: { axes: 0.02, lod: 0.02 }, white: { rms: 2e-3, most: 2e-3 },
              real: levels, byDefault: levels, diffuse: { rms: 1e-5, most: 1e-4 } },
}];

// three.js shows what kiln wrote: MeshStandardMaterial, lit by scene.environment.
import { three } from './models.mjs';

export default [{
    ...three,
    bounds: { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-3, most: 2e-3 },
              real: { rms: 1e-3, most: 5e-3 }, byDefault: { rms: 1e-3, most: 5e-3 } },
}];

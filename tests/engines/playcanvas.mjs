// PlayCanvas shows what kiln wrote: StandardMaterial, lit by scene.envAtlas.
import { playcanvas, playcanvasDds } from './models.mjs';

// The model knows no texels: a mirror of 512 by 256, and 14 by 6 at roughness 1. What is tuned varies more
// between them than these bounds allow.
const bounds = { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-6, most: 1e-6 },
                 real: [{ rows: [0.2, 0.8], rms: 4e-3, most: 0.05 }, { rms: 0.012 }],
                 diffuse: { rms: 4e-3, most: 0.05 } };
export default [{ ...playcanvas, bounds }, { ...playcanvasDds, bounds }];

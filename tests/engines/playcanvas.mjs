// PlayCanvas shows what kiln wrote: StandardMaterial, lit by scene.envAtlas.
import { playcanvas, playcanvasDds } from './models.mjs';

// models.mjs, which says what the engine should draw, takes pictures as continuous. Those of the atlas have
// 512 x 256 texels for a mirror and 14 x 6 for roughness 1. Bilinear interpolation of so few texels makes the
// difference that the bounds `real` and `diffuse` allow.
const bounds = { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-6, most: 1e-6 },
                 real: [{ rows: [0.2, 0.8], rms: 4e-3, most: 0.05 }, { rms: 0.012 }],
                 diffuse: { rms: 4e-3, most: 0.05 } };
export default [{ ...playcanvas, bounds }, { ...playcanvasDds, bounds }];

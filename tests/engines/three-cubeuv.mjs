// three.js r183 shows what kiln wrote for r150 to r186: MeshStandardMaterial, lit by scene.environment.
import { threeCubeUv } from './models.mjs';

export default [{
    ...threeCubeUv,
    bounds: { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-3, most: 2e-3 },
              // The model knows no texels, of which there are 14 across a face from roughness 0.21 on.
              real: [{ rows: [0.45, 1], rms: 5e-3, most: 0.02 }, { rows: [0.1, 0.1], rms: 0.015, most: 0.1 },
                     { rms: 0.05 }] },
}];

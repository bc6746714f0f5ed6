// three.js shows what kiln wrote: MeshStandardMaterial, lit by scene.environment.
import fs from 'node:fs';
import { proveEngine, tableReader } from './rig.mjs';

// three's own split sum: 16 x 16 halves (A, B), x = roughness, y = n.v.
const source = fs.readFileSync(new URL('node_modules/three/src/renderers/shaders/DFGLUTData.js',
                                       import.meta.url), 'utf8');
const halves = source.match(/Uint16Array\(\s*\[([^\]]*)\]/)[1].match(/0x[0-9a-f]+/g).map(Number);
const decode = (half) => (half >> 10 ? (1 + (half & 1023) / 1024) * 2 ** ((half >> 10) - 15)
                                     : (half & 1023) * 2 ** -24);
const table = tableReader(16, (x, y) => [0, 1].map((c) => decode(halves[2 * (16 * y + x) + c])));

await proveEngine({
    name: 'three',
    page: 'three.html',
    ending: '.ktx2',
    model: (count) => ({
        // Its panoramas have +X in the centre and +Z to the right, where kiln's have -Z and +X.
        toKiln: ([x, y, z]) => [z, y, -x],
        clamp: (r) => Math.max(r, 0.045),
        bend: (r) => r ** 4,
        lod: (r) => (count - 1) * r * (2 - r),
        // Fdez-Aguera of white metal: what one bounce loses comes back as diffuse light.
        shade: (nov, r) => {
            const [a, b] = table(r, nov);
            return [a + b, 1 - a - b];
        },
    }),
    bounds: { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-3, most: 2e-3 },
              real: { rms: 1e-3, most: 5e-3 } },
});

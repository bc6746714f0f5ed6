import fs from 'node:fs';
import { tableReader } from './rig.mjs';

// A version's own split sum: 16 x 16 halves (A, B), x = roughness, y = n.v.
export function readTable(name) {
    const file = `node_modules/${name}/src/renderers/shaders/DFGLUTData.js`;
    const source = fs.readFileSync(new URL(file, import.meta.url), 'utf8');
    const halves = source.match(/Uint16Array\(\s*\[([^\]]*)\]/)[1].match(/0x[0-9a-f]+/g).map(Number);
    const decode = (half) => (half >> 10 ? (1 + (half & 1023) / 1024) * 2 ** ((half >> 10) - 15)
                                         : (half & 1023) * 2 ** -24);
    return tableReader(16, (x, y) => [0, 1].map((c) => decode(halves[2 * (16 * y + x) + c])));
}

import fs from 'node:fs';

const mix = (a, b, t) => a.map((x, i) => x + t * (b[i] - x));

// A and B at [roughness, n.v], by the texels' pairs of a table.
export function tableReader(size, texel) {
    return (x, y) => {
        const at = (w) => Math.min(size - 1, Math.max(0, w * size - 0.5));
        const [u, v] = [at(x), at(y)], i = Math.min(size - 2, Math.floor(u));
        const j = Math.min(size - 2, Math.floor(v));
        return mix(mix(texel(i, j), texel(i + 1, j), u - i),
                   mix(texel(i, j + 1), texel(i + 1, j + 1), u - i), v - j);
    };
}

// A version's own split sum: 16 x 16 halves (A, B), x = roughness, y = n.v.
export function readTable(name) {
    const file = `node_modules/${name}/src/renderers/shaders/DFGLUTData.js`;
    const source = fs.readFileSync(new URL(file, import.meta.url), 'utf8');
    const halves = source.match(/Uint16Array\(\s*\[([^\]]*)\]/)[1].match(/0x[0-9a-f]+/g).map(Number);
    const decode = (half) => (half >> 10 ? (1 + (half & 1023) / 1024) * 2 ** ((half >> 10) - 15)
                                         : (half & 1023) * 2 ** -24);
    return tableReader(16, (x, y) => [0, 1].map((c) => decode(halves[2 * (16 * y + x) + c])));
}

// node three.mjs KILN: the split-sum table inside three.js, 16 x 16 halves from 4096 samples a texel,
// beside kiln's A and B. It must be the height-correlated model's, and no other's.
import {execFileSync} from 'node:child_process';
import {readFileSync} from 'node:fs';

const kiln = process.argv[2];
const folder = new URL('node_modules/three/', import.meta.url);
const version = JSON.parse(readFileSync(new URL('package.json', folder))).version;
const source = readFileSync(new URL('src/renderers/shaders/DFGLUTData.js', folder), 'utf8');
const halves = source.match(/Uint16Array\(\s*\[([^\]]*)\]/)[1].match(/0x[0-9a-f]+/g).map(Number);
const size = 16;
if (halves.length !== size * size * 2)
    throw new Error(`three's table has ${halves.length} numbers, not ${size * size * 2}`);

// Finite and not negative.
const decode = (half) => {
    const exponent = half >> 10, fraction = half & 1023;
    return exponent ? (1 + fraction / 1024) * 2 ** (exponent - 15) : fraction * 2 ** -24;
};

// x is roughness and y is n.v, at texel centres.
const points = Array.from(
    {length: size * size},
    (_, i) => `${((i % size) + 0.5) / size} ${(Math.floor(i / size) + 0.5) / size}\n`).join('');
const exact = (quantity, g) =>
    execFileSync(kiln, ['eval', quantity, '--g', g], {input: points, encoding: 'utf8'})
        .trim().split('\n').map(Number);

const compare = (g) => ['a', 'b'].map((quantity, channel) => {
    const off = exact(quantity, g).map((value, i) => decode(halves[2 * i + channel]) - value);
    return {
        rms: Math.sqrt(off.reduce((sum, x) => sum + x * x, 0) / off.length),
        largest: Math.max(...off.map(Math.abs)),
    };
});

const [a, b] = compare('smith');
const [other] = compare('smith-uncorrelated');
const text = ({rms, largest}) => `${rms.toExponential(1)} rms, ${largest.toExponential(1)} at most`;
console.log(`three ${version}: A off by ${text(a)}, B by ${text(b)}; ` +
    `A of the uncorrelated model by ${text(other)}`);
// Theirs is noisy: 4096 samples.
if (!(a.rms < 3e-3 && a.largest < 2e-2 && b.rms < 3e-4 && b.largest < 1e-3))
    throw new Error('the tables disagree by more than the noise of 4096 samples');
if (!(other.rms > 10 * a.rms))
    throw new Error('the comparison does not tell models apart');

// Godot 3 shows the sun of a panorama and kiln's panorama by the lines of docs/engines/godot.md:
//     node godot.mjs KILN WRITE PANORAMA FOLDER
// Out: lines with the errors; exit status 1 if the pixels differ from irradiance * max(0, n . l) / pi, or if the sky is
// not where kiln's panorama has it.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';

const [kiln, write, panorama, folder] = process.argv.slice(2).map((name) => path.resolve(name));
const HALF = 1 / 1024; // part of a value that Mesa cuts off at most, since pixels are halves
const PRINTED = 1e-5; // digits of what Godot prints

fs.rmSync(folder, { recursive: true, force: true });
fs.cpSync(path.join(path.dirname(new URL(import.meta.url).pathname), 'godot'), folder, { recursive: true });
execFileSync(kiln, ['lights', panorama, '-o', path.join(folder, 'lights.json')]);
const { lights: [{ direction, irradiance }] } = JSON.parse(fs.readFileSync(path.join(folder, 'lights.json')));

// Returns the words of each line that a script of Godot prints.
function run(script) {
    const command = ['-a', 'godot3', '--path', folder, '-s', script, '--audio-driver', 'Dummy'];
    const text = execFileSync('xvfb-run', command, {
        encoding: 'utf8', timeout: 200000,
        env: { ...process.env, HOME: folder, XDG_DATA_HOME: folder, XDG_CONFIG_HOME: folder, XDG_CACHE_HOME: folder },
    });
    return text.split('\n').map((line) => line.split(' '));
}
const numbers = (lines, first) =>
    lines.filter(([word]) => word === first).map(([, ...words]) => words.map(Number));
const patches = numbers(run('patches.gd'), 'patch');

const brightest = Math.max(...irradiance) / Math.PI;
let most = 0, lit = 0;
for (const [x, y, z, ...shown] of patches) {
    const cosine = Math.max(0, -x * direction[0] + y * direction[1] - z * direction[2]);
    lit += cosine > 0;
    shown.forEach((value, c) => {
        most = Math.max(most, Math.abs(value - irradiance[c] * cosine / Math.PI) / brightest);
    });
}
console.log(`  godot: ${lit} of ${patches.length} patches are lit, off by ${(100 * most).toFixed(3)} % of the brightest`);
if (patches.length !== 64 || lit < 20 || !(most < HALF + PRINTED))
    throw new Error(`${lit} of ${patches.length} patches are lit, off by ${most}, bound ${HALF + PRINTED}`);

// Level 0 of the coded cube is 2 + d in kiln's direction d, which Godot's (-x, y, -z) is. A pixel's centre lies up to
// 1.8 degrees from the direction. Godot filters the sky for metal by itself, and puts no light back.
execFileSync(write, ['godot', 'coded', '64', path.join(folder, 'sky.exr')]);
const lines = run('sky.gd');
const seen = (what) => numbers(lines, what).map(([x, y, z, ...shown]) =>
    [-x, y, -z].map((d, c) => ({ wanted: 2 + d, shown: shown[c] })));
const sky = seen('sky').flat(), metal = seen('metal').flat();
const off = Math.max(...sky.map(({ wanted, shown }) => Math.abs(shown - wanted)));
const shares = metal.map(({ wanted, shown }) => shown / wanted), least = Math.min(...shares), largest = Math.max(...shares);
console.log(`  godot: the sky is off by ${off.toFixed(3)} at most; metal shows ${least.toFixed(3)} to ${largest.toFixed(3)} of it`);
if (sky.length !== 24 || metal.length !== 24 || !(off < 0.05) || !(least > 0.9) || !(largest < 1))
    throw new Error(`of ${sky.length} values the sky is off by ${off}; ${metal.length} values of metal are ${least} to ${largest}`);

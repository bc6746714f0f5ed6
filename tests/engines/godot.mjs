// Godot 3 shows the sun of a panorama by the lines of docs/engines/godot.md: node godot.mjs KILN PANORAMA FOLDER
// Out: a line with the errors; exit status 1 if the pixels differ from irradiance * max(0, n . l) / pi.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';

const [kiln, panorama, folder] = process.argv.slice(2).map((name) => path.resolve(name));
const HALF = 1 / 1024; // part of a value that Mesa cuts off at most, since pixels are halves
const PRINTED = 1e-5; // digits of what Godot prints

fs.rmSync(folder, { recursive: true, force: true });
fs.cpSync(path.join(path.dirname(new URL(import.meta.url).pathname), 'godot'), folder, { recursive: true });
execFileSync(kiln, ['lights', panorama, '-o', path.join(folder, 'lights.json')]);
const { lights: [{ direction, irradiance }] } = JSON.parse(fs.readFileSync(path.join(folder, 'lights.json')));
const command = ['-a', 'godot3', '--path', folder, '-s', 'patches.gd', '--audio-driver', 'Dummy'];
const text = execFileSync('xvfb-run', command, {
    encoding: 'utf8', timeout: 100000,
    env: { ...process.env, HOME: folder, XDG_DATA_HOME: folder, XDG_CONFIG_HOME: folder, XDG_CACHE_HOME: folder },
});
const patches = text.split('\n').filter((line) => line.startsWith('patch'))
    .map((line) => line.split(' ').slice(1).map(Number));

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
    throw new Error(`${lit} of ${patches.length} patches are lit, off by ${most}, bound ${HALF + PRINTED}:\n${text}`);

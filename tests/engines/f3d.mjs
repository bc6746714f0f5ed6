// F3D, a viewer of Debian, shows kiln's panorama where docs/engines/unreal.md says: node f3d.mjs KILN FOLDER
// In the panorama a quarter of the longitudes each is red, green, blue and white, and the upper half is twice as bright.
// Out: the colours that the sky and a ball of smooth metal show; exit status 1 if others than wanted.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { makeBall } from './glb.mjs';
import { readPng } from './png.mjs';

const [kiln, folder] = process.argv.slice(2).map((name) => path.resolve(name));
const WIDTH = 300, HEIGHT = 200;
const COLOURS = { red: [1, 0, 0], green: [0, 1, 0], blue: [0, 0, 1], white: [1, 1, 1] };

fs.rmSync(folder, { recursive: true, force: true });
fs.mkdirSync(folder, { recursive: true });
const texels = Array.from({ length: 32 }, (_, y) => Array.from({ length: 64 }, (__, x) =>
    [...Object.values(COLOURS)[x >> 4].map((value) => (y < 16 ? 120 : 60) * value), 128]));
fs.writeFileSync(path.join(folder, 'city.hdr'), Buffer.concat([
    Buffer.from('#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32 +X 64\n'), Buffer.from(texels.flat(2))]));
fs.writeFileSync(path.join(folder, 'model.glb'),
                 makeBall({ pbrMetallicRoughness: { metallicFactor: 1, roughnessFactor: 0.1 } }));
execFileSync(kiln, ['bake', 'city.hdr', '--for', 'unreal', '--size', '64', '-q', '-o', 'city_unreal.hdr'], { cwd: folder });
execFileSync('xvfb-run', ['-a', 'f3d', 'model.glb', '--hdri', 'city_unreal.hdr', '--resolution', `${WIDTH},${HEIGHT}`,
                          '--output', 'shown.png'],
             { cwd: folder, stdio: 'ignore', timeout: 200000, env: { ...process.env, HOME: folder } });

const nameOf = (rgb) => Object.entries(COLOURS).find(([, wanted]) =>
    rgb.every((value) => value > 40) === wanted.every(Boolean) && (wanted.every(Boolean) || wanted.indexOf(1) === rgb.indexOf(Math.max(...rgb))))?.[0];
const at = readPng(path.join(folder, 'shown.png'));
// The camera looks at the border of red and green. Near the middle the ball reflects what is behind the camera.
const WANTED = [[30, 60, 'red'], [270, 60, 'green'], [100, 90, 'red'], [200, 90, 'green'], [135, 90, 'white'], [165, 90, 'blue']];
const seen = WANTED.map(([x, y]) => nameOf(at(x, y)) ?? 'nothing');
console.log(`  f3d: the sky shows ${seen.slice(0, 2).join(' and ')}, the ball ${seen.slice(2).join(', ')}`);
if (seen.join() !== WANTED.map(([, , name]) => name).join() || !(at(30, 60)[0] > at(30, 160)[0] + 20))
    throw new Error(`${seen} are seen, and ${at(30, 60)} above ${at(30, 160)}`);

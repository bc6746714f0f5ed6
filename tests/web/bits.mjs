// WebAssembly gives the bits that the processor gives: every file of the baker in the page is the
// command's, byte for byte.
import fs from 'node:fs';
import path from 'node:path';
import { check, checkSame, checkThrows, inFolder, kiln, makeBaker, read, root } from './lib.mjs';

const stages = new Set();
const baker = await makeBaker({ progress: (stage, fraction) => {
    stages.add(stage);
    check(fraction >= 0 && fraction <= 1, `progress of ${stage} is ${fraction}`);
} });

kiln('sky', '-o', 'sky.exr', '--size', '256', '--elevation', '8', '--azimuth', '40');
kiln('sky', '-o', 'sky.hdr', '--size', '100', '--turbidity', '6');
kiln('bake', 'sky.exr', '-q', '-o', 'level_%d.exr', '--shape', 'panorama', '--size', '64', '--levels', '1');
kiln('bake', 'sky.exr', '-q', '-o', 'cube.ktx2', '--size', '64', '--format', 'rgb9e5');
kiln('bake', 'sky.exr', '-q', '-o', 'cube.dds', '--size', '64', '--format', 'rgba32f');

fs.copyFileSync(path.join(root, 'build/data/blender/city.exr'), inFolder('city.exr'));

const open = (name) => baker.open(read(name), name);
const sources = {
    // EXR as kiln writes it, ZIP of halfs, and as Blender does, DWAB.
    'level_0.exr': () => open('level_0.exr'),
    'city.exr': () => open('city.exr'),
    'sky.exr': () => baker.sky({ size: 256, elevation: 8, azimuth: 40 }),
    'sky.hdr': () => open('sky.hdr'),
    'cube.ktx2': () => open('cube.ktx2'),
    'cube.dds': () => open('cube.dds'),
};
const bakes = [
    [{}, []],
    [{ size: 48, levels: 4, yaw: 33.5, exposure: -2.5 },
     ['--size', '48', '--levels', '4', '--rotate', '33.5', '--exposure', '-2.5']],
];
let compared = 0;
for (const [name, take] of Object.entries(sources))
    for (const [options, args] of bakes) {
        take();
        baker.options(options);
        const { cpu } = baker.bake(options);
        check(cpu === 'simd128', `kernels are ${cpu}, not simd128`);
        // All formats once; the bits of all floats always.
        const formats = name === 'sky.hdr' ? ['rgba16f', 'rgb9e5', 'b10g11r11'] : [];
        for (const format of ['rgba32f', ...formats]) {
            kiln('bake', name, '-q', '-o', 'out.ktx2', '--sh', 'out.json', '--format', format, ...args);
            checkSame(baker.file('out.ktx2', format), read('out.ktx2'), `${name} as ${format}`);
            checkSame(baker.file('out.json'), read('out.json'), `harmonics of ${name}`);
            compared += 2;
        }
    }
// The view's source is turned by sampling: its harmonics are near those of the bake, which turns exactly.
kiln('bake', 'city.exr', '-q', '-o', 'city.hdr', '--shape', 'panorama', '--size', '64', '--levels', '1');
kiln('bake', 'city.exr', '-q', '-o', 'city.dds', '--size', '32', '--levels', '1');
for (const [name, up] of [['city.hdr', 'z'], ['city.dds', '-z'], ['city.dds', 'y']]) {
    open(name);
    baker.options({ pitch: 25, roll: -40, up, mirror: up !== 'y' });
    const { harmonics } = baker.bake({ size: 8 });
    baker.sun();
    const seen = baker.scenery({ size: 16 }).harmonics, norm = Math.hypot(...harmonics.slice(3));
    const off = Math.hypot(...harmonics.map((value, i) => value - seen[i])) / norm;
    check(off < 0.02, `${name} with ${up} up is turned otherwise in the view: harmonics differ by ${off}`);
}
for (const kind of ['e', 'eavg', 'dfg']) {
    kiln('tables', '--table', kind, '-q', '-o', 'table.ktx2');
    checkSame(baker.table('table.ktx2', kind), read('table.ktx2'), `table ${kind}`);
    compared++;
}
check(stages.size > 2, `told of ${[...stages]} only`);

// What cannot be read is said, and what was there stays.
const before = baker.file('out.ktx2');
checkThrows(() => baker.open(new Uint8Array(100), 'zeros.hdr'), /^zeros\.hdr: its 100 bytes do not begin/);
checkThrows(() => baker.open(read('sky.hdr').subarray(0, 2000), 'cut.hdr'), /^cut\.hdr: /);
checkThrows(() => baker.open(read('city.exr').subarray(0, 90000), 'cut.exr'), /^cut\.exr: .*(chunk|header)/);
checkThrows(() => baker.bake({ size: 0.5 - 2 }), /size/);
checkSame(baker.file('out.ktx2'), before, 'the file after failures');
console.log(`${compared} files are the command's`);

// <model-viewer> shows the gain-map JPEG that kiln wrote, and readers of such files read from it what kiln reads.
import fs from 'node:fs';
import path from 'node:path';
import { check, folder, kiln, panorama, readFile } from './rig.mjs';

const FLAT = ['--shape', 'panorama', '--size', 1024, '--roughness', 0, '--format', 'rgba32f', '-q'];
// Pictures for <model-viewer> are small, since its filter takes long without a GPU.
const SMALL = ['--size', 128, '-q'];

async function prepare() {
    await kiln('bake', panorama, '--for', 'model-viewer', '-q', '-o', 'panorama.jpg');
    await kiln('bake', 'panorama.jpg', ...FLAT, '-o', 'read.exr');
    await kiln('bake', panorama, '--for', 'godot', '-q', '-o', 'source.exr');
    // The file without its second picture, whose place the index of pictures (MPF) tells.
    const jpeg = readFile('panorama.jpg'), index = jpeg.indexOf('MPF\0') + 4;
    fs.writeFileSync(path.join(folder, 'base.jpg'), jpeg.subarray(0, jpeg.readUInt32BE(index + 54)));
    await kiln('bake', 'base.jpg', ...FLAT, '-o', 'base.exr');
    for (const [engine, name] of [['model-viewer', 'small.jpg'], ['unreal', 'small.hdr']])
        await kiln('bake', panorama, '--for', engine, ...SMALL, '-o', name);
}

// The loader of a file, the EXR file with which it is compared, the bounds and what is compared.
const READERS = [
    // three.js rounds to halves.
    ['gainmap-js', 'panorama.jpg', 'read.exr', { rms: 5e-4, most: 2e-3 }, 'by gainmap-js and by kiln'],
    ['base', 'base.jpg', 'base.exr', { rms: 1e-6, most: 1e-5 }, 'its first picture by the browser and by kiln'],
    ['gainmap-js', 'panorama.jpg', 'source.exr', { rms: 0.02 }, 'by gainmap-js and before it was written'],
    // It applies gains to values by the curve of sRGB, which is right where the gain is 1.
    ['UltraHDRLoader', 'panorama.jpg', 'read.exr', { rms: 0.1, most: 0.3 }, 'by UltraHDRLoader and by kiln'],
];

function differ(a, b) {
    let most = 0, squares = 0, count = 0;
    a.forEach((x, i) => {
        if (i % 4 === 3 || a[i - i % 4 + 3] !== 255 || b[i - i % 4 + 3] !== 255) // outside of the ball
            return;
        most = Math.max(most, Math.abs(x - b[i]));
        squares += (x - b[i]) ** 2;
        count++;
    });
    return { most, rms: Math.sqrt(squares / count), count };
}

export default [{
    name: 'model-viewer', page: 'model-viewer/model-viewer.html', prepare,
    check: async (_, draw, say) => {
        for (const [loader, file, other, bounds, what] of READERS) {
            const { rms, most } = await draw(file, [], [], 0, { loader, with: other });
            say(`${what}: rms ${rms.toExponential(1)}, ${most.toExponential(1)} at most`);
            check(rms < bounds.rms && most < (bounds.most ?? Infinity), `${what}: off by ${rms}, ${most} at most`);
        }
        for (const roughness of [0.1, 0.4, 1]) {
            const [shown, wanted] = [await draw('small.jpg', [], [roughness], 0), await draw('small.hdr', [], [roughness], 0)];
            const { most, rms, count } = differ(shown, wanted);
            say(`a ball of roughness ${roughness}, lit by .jpg and by .hdr: ${count} values, ` +
                `rms ${rms.toFixed(2)} of 255, ${most} at most`);
            check(count > 20000 && rms < 1 && most < 12, `roughness ${roughness}: off by ${rms}, ${most} at most`);
        }
    },
}];

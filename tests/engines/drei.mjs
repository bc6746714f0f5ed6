// drei's <Environment> loads the gain-map JPEG that kiln wrote, and shows what it shows of an .hdr file.
import fs from 'node:fs';
import path from 'node:path';
import { check, folder, kiln, panorama } from './rig.mjs';

// Pictures that are filtered are small, since three.js's filter takes long without a GPU.
const SMALL = ['--size', 128, '-q'];
const here = import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname);

async function prepare() {
    const { build } = await import('./drei/node_modules/esbuild/lib/main.js');
    await build({ entryPoints: [path.join(here, 'drei/main.jsx')], outfile: path.join(folder, 'drei-bundle.js'), bundle: true,
                  format: 'esm', jsx: 'automatic', minifySyntax: true, define: { 'process.env.NODE_ENV': '"production"' } });
    for (const [engine, name] of [['model-viewer', 'small.jpg'], ['unreal', 'small.hdr']])
        await kiln('bake', panorama, '--for', engine, ...SMALL, '-o', name);
    await kiln('bake', 'small.jpg', '--shape', 'panorama', '--size', 256, '--roughness', 0, '--format', 'rgba32f', '-q',
               '-o', 'read.exr');
}

// JPEG's errors are those of single texels, which rough balls average.
const BALLS = [[0, { rms: 0.015, most: 0.3 }], [0.1, { rms: 0.01, most: 0.1 }], [0.4, { rms: 0.006, most: 0.02 }],
               [1, { rms: 0.006, most: 0.01 }]];
const SKY = { rms: 0.025, most: 0.6 };

export default [{
    name: 'drei', page: 'drei/drei.html', prepare,
    check: async (_, draw, say) => {
        const tell = (what, { count, rms, most }, bounds) => {
            say(`${what}: ${count} values, rms ${rms.toExponential(1)}, ${most.toExponential(1)} at most`);
            check(count > 20000 && rms < bounds.rms && most < bounds.most,
                  `${what}: ${count} values, off by ${rms} rms (${bounds.rms}), ${most} at most (${bounds.most})`);
        };
        // gainmap-js rounds to halves.
        tell('texels by drei and by kiln', await draw('small.jpg', [], [1], 0, { with: 'read.exr' }), { rms: 5e-4, most: 2e-3 });
        const pictures = await draw('small.jpg', [], BALLS.map(([roughness]) => roughness), 0, { like: 'small.hdr' });
        pictures.forEach((off, i) => (i < BALLS.length
            ? tell(`a ball of roughness ${BALLS[i][0]}, lit by .jpg and by .hdr`, off, BALLS[i][1])
            : tell('the sky, of .jpg and of .hdr', off, SKY)));
    },
}];

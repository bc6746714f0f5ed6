// Measures how long pages of three.js load environments: node load.mjs BIN PANORAMAS FOLDER CSV
// In: the panoramas NAMES. Out: for each version of three.js and each kind of file the bytes, the milliseconds from the
// request to the first picture, the bytes of the texels on the GPU, and the RMS difference of the picture from that of
// kiln's file of halves. Every measurement is a page of its own in one browser, whose server is on the same machine; the
// least time of RUNS counts.
import fs from 'node:fs';
import path from 'node:path';
import { execFileSync } from 'node:child_process';
import { makeSite } from '../../tests/engines/rig.mjs';
import { withBrowser } from '../../tests/web/browser.mjs';
import { makePanorama } from './ways.mjs';

const [bin, panoramas, folder, csv] = process.argv.slice(2, 6).map((name) => path.resolve(name));
const NAMES = ['courtyard'], RUNS = 1;
const kiln = (...args) => execFileSync(path.join(bin, 'kiln'), args, { cwd: folder });
makeSite(folder);
fs.symlinkSync(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), path.join(folder, 'bench'));

// Version of three.js: [what is measured, way of load.html, ending of the file, words for kiln].
const KINDS = {
    three: [['kiln rgba16f', 'kiln', '-a.ktx2', ['--for', 'three', '--format', 'rgba16f']],
            ['kiln rgb9e5', 'kiln', '-e.ktx2', ['--for', 'three']],
            ['kiln uastc', 'kiln', '-b.ktx2', ['--for', 'three', '--format', 'uastc']],
            ['.hdr, filtered', 'hdr', '.hdr'], ['.exr, filtered', 'exr', '.exr']],
    'three-r186': [['kiln rgba16f', 'kiln', '-c.exr', ['--for', 'three-cubeuv']],
                   ['kiln uastc', 'kiln', '-d.ktx2', ['--for', 'three-cubeuv', '--format', 'uastc']],
                   ['.hdr, filtered', 'hdr', '.hdr'], ['.exr, filtered', 'exr', '.exr']],
};
for (const name of NAMES) {
    makePanorama(bin, folder, path.join(panoramas, `${name}.exr`), `${name}.hdr`);
    fs.copyFileSync(path.join(panoramas, `${name}.exr`), path.join(folder, `${name}.exr`));
    for (const [, , ending, words] of Object.values(KINDS).flat().filter((kind) => kind[3]))
        kiln('bake', `${name}.exr`, '-q', '-o', `${name}${ending}`, ...words);
}

const rms = (a, b) => Math.sqrt(a.reduce((sum, x, i) => sum + (x - b[i]) ** 2, 0) / b.reduce((sum, x) => sum + x * x, 0));
const lines = ['three.js,panorama,kind,bytes,milliseconds,bytes on the GPU,relative rms'];
await withBrowser(folder, async (visit, address) => {
    for (const [version, kinds] of Object.entries(KINDS))
        for (const name of NAMES) {
            let halves;
            for (const [kind, way, ending] of kinds) {
                const runs = [];
                for (let run = 0; run < RUNS; run++)
                    await visit(async (page) => {
                        page.setDefaultTimeout(120000);
                        await page.goto(`${address}bench/load.html?${version}`);
                        await page.waitForFunction(() => window.measure);
                        runs.push(await page.evaluate((args) => window.measure(...args), [`${address}${name}${ending}`, way]));
                        await page.close();
                    });
                const least = Math.min(...runs.map(({ milliseconds }) => milliseconds));
                const { bytes, pixels } = runs[0], size = fs.statSync(path.join(folder, `${name}${ending}`)).size;
                halves ??= pixels;
                console.log(`  ${version.padEnd(10)} ${name.padEnd(9)} ${kind.padEnd(14)} ${String(size).padStart(8)} bytes ` +
                            `${least.toFixed(0).padStart(5)} ms ${(bytes / 1e6).toFixed(2).padStart(6)} MB on the GPU  ` +
                            `${(100 * rms(pixels, halves)).toFixed(2)} % from halves`);
                lines.push([version, name, `"${kind}"`, size, least, bytes, rms(pixels, halves)].join());
            }
        }
});
fs.mkdirSync(path.dirname(csv), { recursive: true });
fs.writeFileSync(csv, `${lines.join('\n')}\n`);

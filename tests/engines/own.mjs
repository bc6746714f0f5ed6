// kiln check finds in the engines' own bakes the errors that docs/engines states: node own.mjs KILN PANORAMA FOLDER
//
// Each page bakes the panorama by its engine's own filter. The texels are read back and written as DDS files, and
// kiln check says what the engine would show of them.
import { execFile } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { promisify } from 'node:util';
import { HIDDEN, withBrowser } from '../web/browser.mjs';

const [kiln, panorama, folder] = process.argv.slice(2).map((name) => path.resolve(name));
const here = path.dirname(new URL(import.meta.url).pathname);
const chosen = process.argv.slice(5);

// The errors in per cent over all roughnesses that docs/engines/README.md has for courtyard.exr: kiln check weights
// roughnesses and directions otherwise, and knows no irradiance.
const ENGINES = [
    { page: 'three', engine: 'three', figure: 2.7 },
    { page: 'three-r183', engine: 'three-cubeuv', figure: 17 },
    { page: 'playcanvas', engine: 'playcanvas-dds', figure: 8.8 },
    { page: 'babylonjs', engine: 'babylon-dds', figure: 2.9 },
];

// A DDS file of 32-bit floats with the older header: a picture, or a cube whose faces are followed by their levels.
function dds(made) {
    const header = Buffer.alloc(128), cube = Boolean(made.faces);
    header.write('DDS ');
    for (const [at, value] of [[4, 124], [8, 0x2100f], [12, cube ? made.size : made.height],
                               [16, cube ? made.size : made.width], [28, cube ? made.levels : 1], [76, 32], [80, 4],
                               [84, 116], [108, 0x401008], [112, cube ? 0xfe00 : 0]])
        header.writeUInt32LE(value, at);
    if (cube)
        return Buffer.concat([header, ...made.faces.flat().map((text) => Buffer.from(text, 'base64'))]);
    const pixels = Buffer.from(made.pixels, 'base64'), row = 16 * made.width;
    const rows = Array.from({ length: made.height }, (_, y) => pixels.subarray(y * row, (y + 1) * row));
    return Buffer.concat([header, ...(made.upward ? rows.reverse() : rows)]);
}

async function run(...words) {
    return promisify(execFile)(kiln, words, { cwd: folder, maxBuffer: 1 << 24 }).catch((error) => error);
}

fs.rmSync(folder, { recursive: true, force: true });
fs.mkdirSync(folder, { recursive: true });
fs.symlinkSync(path.join(here, 'node_modules'), path.join(folder, 'npm'));
fs.symlinkSync(here, path.join(folder, 'pages'));
await run('bake', panorama, '-o', 'p.hdr', '--shape', 'panorama', '--size', '512', '--levels', '1', '-q');

await withBrowser(folder, async (visit, address) => {
    for (const { page, engine, figure } of ENGINES.filter((e) => !chosen.length || chosen.includes(e.page)))
        await visit(async (browser) => {
            browser.setDefaultTimeout(400000);
            await browser.goto(`${address}pages/own.html?${page}`);
            await browser.waitForFunction(() => window.bake);
            const made = await browser.evaluate((url) => window.bake(url), `${address}p.hdr`);
            fs.writeFileSync(path.join(folder, `${page}.dds`), dds(made));
            const { stdout, stderr } = await run('check', 'p.hdr', `${page}.dds`, '--for', engine, '--json');
            const [{ levels, error }] = JSON.parse(stdout);
            if (!levels)
                throw new Error(`${error} ${stderr}`);
            const shown = 100 * levels.shown.all, faults = levels.findings.filter((f) => f.fault);
            console.log(`  ${page}: ${shown.toFixed(2)} % shown, ${figure} % in the docs; levels of ` +
                        `${levels.levels.map((l) => (100 * l.rms).toFixed(2)).join(' ')} %; ` +
                        `${faults.map((f) => f.text).join('; ')}`);
            if (!(shown > 0.7 * figure && shown < 1.5 * figure))
                throw new Error(`${shown} % is not near ${figure} %`);
            if (faults.some((f) => /turned|mirrored|upside/.test(f.text)))
                throw new Error('the axes are not those of the engine');
        }, () => `${page}: `);
}, HIDDEN);

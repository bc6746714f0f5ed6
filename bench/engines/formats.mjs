// Measures what each format of each engine takes and how much it errs:
//   node formats.mjs BIN PANORAMAS FOLDER CSV [ENGINE...]
// In: the panoramas NAMES. Out: for each engine, format and panorama the bytes of the files, also compressed by gzip -9
// and by zstd -19, and the errors that bench_formats prints; and the milliseconds until a page of the engine has loaded
// the file of the first panorama and drawn, in one run on the same machine. Printed, and as rows of CSV.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import zlib from 'node:zlib';
import { current } from '../../tests/engines/models.mjs';
import { CELL, makeSite, makeViews, openEngine } from '../../tests/engines/rig.mjs';
import { withPage } from '../../tests/web/browser.mjs';

const [bin, panoramas, folder, csv] = process.argv.slice(2, 6).map((name) => path.resolve(name));
const only = process.argv.slice(6);
const NAMES = ['courtyard', 'city', 'interior', 'forest'];
makeSite(folder);

// Files that an engine loads besides the file with the levels.
const OTHERS = { filament: [['_ibl.ktx', '_skybox.ktx']], bevy: [['_specular.ktx2', '_diffuse.ktx2']] };

// The bytes of an engine's files as they are, by gzip and by zstd.
function sizesOf(engine, file) {
    const files = [file, ...(OTHERS[engine] ?? []).map(([ending, other]) => file.replace(ending, other))];
    return files.map((name) => [fs.statSync(name).size, zlib.gzipSync(fs.readFileSync(name), { level: 9 }).length,
                                execFileSync('zstd', ['-19', '-q', '-c', name], { maxBuffer: 1 << 28 }).length])
        .reduce((sum, sizes) => sum.map((size, i) => size + sizes[i]));
}

const rows = NAMES.flatMap((name) => {
    fs.mkdirSync(path.join(folder, name));
    const text = execFileSync(path.join(bin, 'bench_formats'), [path.join(panoramas, `${name}.exr`),
                                                                path.join(folder, name), ...only],
        { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] });
    return text.trim().split('\n').map((line) => {
        const [engine, format, , alone, shown, worst, displayed, , file] = line.split(' ');
        return { name, engine, format, alone, shown, worst, displayed, file, sizes: sizesOf(engine, file) };
    });
});

// The milliseconds from the request of a file to the pixels of one view that it lights. The page has drawn the same
// format of another panorama before, so that its shaders are compiled.
async function timeOf(browser, address, model, file) {
    await openEngine(browser, address, model.page);
    const served = (name) => `${address}${path.relative(folder, file.replace(`/${NAMES[0]}/`, `/${name}/`))}`;
    const view = makeViews([[0.31, 0.22, 0.92]]);
    return browser.evaluate(async ([warm, cold, args, cell, asked]) => {
        const { views, roughness } = JSON.parse(args);
        await window.draw(warm, views, roughness, cell, asked);
        const begin = performance.now();
        await window.draw(cold, views, roughness, cell, asked);
        return performance.now() - begin;
    }, [served(NAMES[1]), served(NAMES[0]), JSON.stringify({ views: view, roughness: [0.3] }), CELL, model.asked ?? {}]);
}

const times = new Map();
const gltf = { page: 'babylon.html', asked: { linear: true } };
await withPage(folder, async (browser, address) => {
    browser.setDefaultTimeout(300000);
    for (const { engine, format, file } of rows.filter(({ name }) => name === NAMES[0])) {
        const model = engine === 'gltf' ? gltf : current.find(({ name }) => name === engine);
        // The page of three-cubeuv reads EXR alone; bench/run.sh load measures KTX2 files in r186.
        if (!model || (engine === 'three-cubeuv' && format === 'uastc'))
            continue;
        times.set(`${engine} ${format}`, await timeOf(browser, address, model, file.replace(/\.ktx2$/, (ending) =>
            (engine === 'cesium' ? '' : ending))));
    }
});

const lines = ['engine,format,panorama,bytes,gzip,zstd,format alone,shown,shown at worst,displayed,milliseconds'];
const percent = (x) => (x === '?' ? '-' : (100 * x).toPrecision(3)).padStart(7);
console.log('  engine, format, panorama | bytes, gzip, zstd | relative RMS error of the format alone, of what is shown, ' +
            'displayed error, all in % | ms until the first picture');
for (const { name, engine, format, sizes, alone, shown, worst, displayed } of rows) {
    const ms = name === NAMES[0] ? times.get(`${engine} ${format}`) : undefined;
    console.log(`  ${engine.padEnd(14)} ${format.padEnd(9)} ${name.padEnd(9)} ${sizes.map((n) => String(n).padStart(8)).join('')}` +
                `${[alone, shown, displayed].map(percent).join('')}  ${ms === undefined ? '' : ms.toFixed(0)}`);
    lines.push([engine, format, name, ...sizes, alone, shown, worst, displayed, ms === undefined ? '' : ms.toFixed(0)].join());
}
fs.mkdirSync(path.dirname(csv), { recursive: true });
fs.writeFileSync(csv, `${lines.join('\n')}\n`);

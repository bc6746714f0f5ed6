// Bakes panoramas in one page of a browser by kiln's WebAssembly and by three.js's PMREMGenerator, and compares
// the results with brute force: node pmrem.mjs BIN SITE PANORAMAS FOLDER CSV
// In: the panoramas NAMES. Out: times and errors, printed and as rows of CSV. The files of the page are copied to
// FOLDER. The version of three.js is that of tests/engines/package-lock.json.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { withPage } from '../../tests/web/browser.mjs';

const [bin, site, panoramas, folder, csv] = process.argv.slice(2).map((name) => path.resolve(name));
const three = fileURLToPath(new URL('../../tests/engines/node_modules/three/build', import.meta.url));
const NAMES = ['courtyard', 'sunrise'], RUNS = 5, TEXELS = 200;

fs.rmSync(folder, { recursive: true, force: true });
fs.mkdirSync(folder, { recursive: true });
const gather = (from, ...names) => names.forEach(
    (name) => fs.copyFileSync(path.join(from, name), path.join(folder, name)));
gather(site, 'baker.js', 'baker.wasm', 'baker.mjs');
gather(three, 'three.module.js', 'three.core.js');
gather(panoramas, ...NAMES.map((name) => `${name}.exr`));
fs.copyFileSync(new URL('pmrem.html', import.meta.url), path.join(folder, 'index.html'));

// Directions of the cube faces +X -X +Y -Y +Z -Z, as OpenGL defines them.
const FACES = [(s, t) => [1, -t, -s], (s, t) => [-1, -t, s], (s, t) => [s, 1, t],
               (s, t) => [s, -1, -t], (s, t) => [s, -t, 1], (s, t) => [-s, -t, -1]];
// three.js's panoramas have +X in the centre and +Z to the right, where kiln's have -Z and +X.
const toKiln = { kiln: (d) => d, three: ([x, y, z]) => [z, y, -x] };

// Returns [face, column, row] of TEXELS texels that are evenly spread over a level, or of all texels of a small
// level.
const places = ({ size }) => {
    const all = 6 * size * size, count = Math.min(all, TEXELS);
    return Array.from({ length: count }, (_, i) => {
        const at = Math.floor((i + 0.5) * all / count);
        return [Math.floor(at / (size * size)), at % size, Math.floor(at / size) % size];
    });
};

function direction({ size }, [face, x, y]) {
    const d = FACES[face](2 * (x + 0.5) / size - 1, 2 * (y + 0.5) / size - 1);
    return d.map((c) => c / Math.hypot(...d));
}

// Returns the relative RMS error of each level, except for level 0 of roughness 0.
function errors(panorama, who, levels, values) {
    const chosen = levels.map(places).map((of, k) => (k ? of : []));
    const lines = levels.flatMap((level, k) => chosen[k].map((place) =>
        [level.roughness, ...toKiln[who](direction(level, place))].join(' ')));
    const truth = execFileSync(path.join(bin, 'bench_reference'), [panorama],
                               { input: `${lines.join('\n')}\n`, encoding: 'utf8' })
        .trim().split('\n').map((line) => line.split(' ').map(Number));
    if (truth.length !== lines.length)
        throw new Error(`${truth.length} values of brute force for ${lines.length} directions`);
    return levels.slice(1).map((_, k) => {
        let off = 0, whole = 0;
        for (const got of values[k + 1]) {
            const wanted = truth.shift();
            for (let c = 0; c < 3; c++) {
                off += (got[c] - wanted[c]) ** 2;
                whole += wanted[c] ** 2;
            }
        }
        return Math.sqrt(off / whole);
    });
}

const rows = ['name,unit,median,minimum'];
function report(name, who, { levels, seconds, first }, rms) {
    const sorted = [...seconds].sort((a, b) => a - b), median = sorted[RUNS >> 1];
    rows.push(`${name} ${who},s,${median},${sorted[0]}`, `${name} ${who} first,s,${first},${first}`);
    console.log(`  ${name.padEnd(10)} ${who.padEnd(6)} ${median.toFixed(3)} s (first ${first.toFixed(3)})` +
                `  worst level ${Math.max(...rms).toExponential(1)}`);
    rms.forEach((value, k) => {
        const { size, roughness } = levels[k + 1];
        rows.push(`${name} ${who} roughness ${roughness.toFixed(3)} rms,relative,${value},${value}`);
        console.log(`      roughness ${roughness.toFixed(3)}, ${String(size).padStart(3)} texels: ` +
                    value.toExponential(1));
    });
}

await withPage(folder, async (page, address) => {
    page.setDefaultTimeout(300000);
    await page.goto(address);
    await page.waitForFunction(() => window.ready);
    for (const [n, name] of NAMES.entries()) {
        const panorama = path.join(panoramas, `${name}.exr`);
        await page.evaluate((file) => window.open(file), `${name}.exr`);
        const kiln = await page.evaluate((runs) => window.bakeKiln(runs), RUNS);
        const other = await page.evaluate((runs) => window.bakeThree(runs), RUNS);
        if (!n)
            console.log(`  kiln as WebAssembly (${kiln.cpu}, one thread) and three.js r${other.version} ` +
                        `on ${other.gpu};\n  median time of ${RUNS} bakes, relative RMS error of ${TEXELS} texels of each level`);
        const read = (reader, { levels }) => page.evaluate(
            ([call, of]) => window[call](of), [reader, levels.map(places)]);
        report(name, 'kiln', kiln, errors(panorama, 'kiln', kiln.levels, await read('readKiln', kiln)));
        report(name, 'three', other, errors(panorama, 'three', other.levels, await read('readThree', other)));
    }
});
if (csv) {
    fs.mkdirSync(path.dirname(csv), { recursive: true });
    fs.writeFileSync(csv, `${rows.join('\n')}\n`);
}

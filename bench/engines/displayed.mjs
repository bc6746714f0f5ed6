// Measures the errors of engines' pixels, with kiln's files and with the engines' own filters:
//   node displayed.mjs BIN PANORAMAS FOLDER CSV [ENGINE...]
// In: the panoramas NAMES. Out: relative RMS errors, printed and as rows of CSV. Each engine draws white metal as
// in tests/engines, at 19 roughnesses. The pixels are compared with the engine's own shading formula applied to
// light that a brute-force sum filters for each direction and roughness. The errors therefore come from mixing two
// levels and from interpolating texels, and not from the engine's formula.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import * as models from '../../tests/engines/models.mjs';
import { makeSite, makeViews, openEngine, predict } from '../../tests/engines/rig.mjs';
import { withPage } from '../../tests/web/browser.mjs';
import { engineOf, makePanorama, makeWays } from './ways.mjs';

const [bin, panoramas, folder, csv] = process.argv.slice(2, 6).map((name) => path.resolve(name));
const only = process.argv.slice(6);
const NAMES = ['courtyard', 'sunrise'], CELL = 4;
const ROUGHNESS = Array.from({ length: 19 }, (_, i) => (10 + 5 * i) / 100);
// Six views, which show 192 directions.
const VIEWS = makeViews([[0.9, 0.3, 0.1], [-0.9, -0.2, 0.2], [0.1, 0.9, 0.3], [-0.2, -0.9, 0.1],
                         [0.3, 0.2, 0.9], [-0.4, 0.1, -0.9]]);
// Returns the pixels that the engine would draw if the light were filtered exactly. bench_reference is called once
// for all pixels.
function truth(engine, panorama) {
    const { size, level_count: count } = engineOf(bin, engine.name);
    const model = engine.model(count, size), asked = [];
    const asset = { radiance: () => [0, 0, 0], irradiance: () => [0, 0, 0] };
    const rows = ROUGHNESS.map((roughness) => VIEWS.map((view) =>
        predict(model, asset, view, roughness, ROUGHNESS).map((p) => {
            asked.push([p.r, ...model.toKiln(p.way)]);
            return p;
        })));
    // GGX of roughness 1 with n = v gives irradiance / pi.
    VIEWS.forEach((view) => view.normals.forEach((n) => asked.push([1, ...model.toKiln(n)])));
    const values = execFileSync(path.join(bin, 'bench_reference'), [path.join(folder, panorama)], {
        input: `${asked.map((line) => line.join(' ')).join('\n')}\n`, encoding: 'utf8', maxBuffer: 1 << 26,
    }).trim().split('\n').map((line) => line.split(' ').map(Number));
    if (values.length !== asked.length)
        throw new Error(`${values.length} values of brute force for ${asked.length} directions`);
    const each = VIEWS.length * VIEWS[0].normals.length, around = values.slice(-each);
    let at = 0;
    return rows.map((views) => views.flat().map((p, i) =>
        values[at++].map((x, c) => p.single * x + p.multiple * around[i][c])));
}

// Returns the relative RMS error at each roughness.
function errors(shown, wanted) {
    return ROUGHNESS.map((_, row) => {
        let off = 0, whole = 0;
        shown.flatMap((view) => view[row]).forEach((pixel, i) => pixel.forEach((x, c) => {
            off += (x - wanted[row][i][c]) ** 2;
            whole += wanted[row][i][c] ** 2;
        }));
        return Math.sqrt(off / whole);
    });
}

const percent = (x) => (100 * x).toPrecision(2).padStart(6);
const lines = ['engine,panorama,maker,roughness,relative rms'];
makeSite(folder);
const ways = makeWays(bin, folder, ['--tune=none']);
for (const name of NAMES)
    makePanorama(bin, folder, path.join(panoramas, `${name}.exr`), `${name}.hdr`);
console.log('  relative RMS error in % over 192 directions, at roughness 0.1, 0.2, 0.3, 0.5, 0.7 and 1; then over all ' +
            '19 roughnesses, and at the worst');
await withPage(folder, async (browser, address) => {
    browser.setDefaultTimeout(300000);
    for (const engine of Object.values(models).filter(({ name }) => !only.length || only.includes(name))) {
        for (const name of NAMES) {
            const wanted = truth(engine, `${name}.hdr`);
            for (const { maker, make } of ways(engine)) {
                const file = await make(`${name}.hdr`);
                const draw = await openEngine(browser, address, engine.page);
                const rms = errors(await draw(file, VIEWS, ROUGHNESS, CELL), wanted);
                const all = Math.sqrt(rms.reduce((sum, x) => sum + x * x, 0) / rms.length);
                const few = [0.1, 0.2, 0.3, 0.5, 0.7, 1].map((r) => rms[ROUGHNESS.indexOf(r)]);
                console.log(`  ${engine.name.padEnd(14)} ${name.padEnd(9)} ${maker.padEnd(15)}` +
                            `${few.map(percent).join('')}  ${percent(all)}${percent(Math.max(...rms))}`);
                rms.forEach((x, i) => lines.push([engine.name, name, maker, ROUGHNESS[i], x].join()));
            }
        }
    }
});
fs.mkdirSync(path.dirname(csv), { recursive: true });
fs.writeFileSync(csv, `${lines.join('\n')}\n`);

// Measures the errors of engines' pixels, with kiln's files and with the engines' own filters:
//   node displayed.mjs BIN PANORAMAS FOLDER CSV [ENGINE...]
// In: the panoramas NAMES. Out: relative RMS errors, which measure.mjs defines, printed and as rows of CSV.
import fs from 'node:fs';
import path from 'node:path';
import { current } from '../../tests/engines/models.mjs';
import { makeSite, openEngine } from '../../tests/engines/rig.mjs';
import { withPage } from '../../tests/web/browser.mjs';
import { CELL, ROUGHNESS, VIEWS, errors, overAll, percent, truth } from './measure.mjs';
import { makePanorama, makeWays } from './ways.mjs';

const [bin, panoramas, folder, csv] = process.argv.slice(2, 6).map((name) => path.resolve(name));
const only = process.argv.slice(6);
const NAMES = ['courtyard', 'sunrise'];
const lines = ['engine,panorama,maker,roughness,relative rms'];
makeSite(folder);
const ways = makeWays(bin, folder, ['--tune=none']);
for (const name of NAMES)
    makePanorama(bin, folder, path.join(panoramas, `${name}.exr`), `${name}.hdr`);
console.log('  relative RMS error in % over 192 directions, at roughness 0.1, 0.2, 0.3, 0.5, 0.7 and 1; then over all ' +
            '19 roughnesses, and at the worst');
await withPage(folder, async (browser, address) => {
    browser.setDefaultTimeout(300000);
    for (const engine of current.filter(({ name }) => !only.length || only.includes(name))) {
        for (const name of NAMES) {
            const wanted = truth(bin, engine, path.join(folder, `${name}.hdr`));
            for (const { maker, make } of ways(engine)) {
                const file = await make(`${name}.hdr`);
                const draw = await openEngine(browser, address, engine.page);
                const rms = errors(await draw(file, VIEWS, ROUGHNESS, CELL, engine.asked), wanted);
                const all = overAll(rms);
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

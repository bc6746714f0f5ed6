// Measures the errors of engines' pixels with kiln's files after suns and lamps were taken out of the panoramas:
//   node lights.mjs BIN PANORAMAS FOLDER CSV [ENGINE...]
// In: the panoramas NAMES, of which the lights of a thousandth of the light and more are taken out. Out: RMS errors of
// the pixels that measure.mjs defines, printed and as rows of CSV; exit status 1 if a bar is missed. The lights belong
// to the picture that is wanted and to the picture that is shown, as analytic lights without an error. The difference
// of both pictures is then that of the panoramas without lights. This difference is divided by the RMS value of the
// picture that is wanted, which is lit by the whole panorama.
import fs from 'node:fs';
import path from 'node:path';
import { current } from '../../tests/engines/models.mjs';
import { makeSite, openEngine } from '../../tests/engines/rig.mjs';
import { withPage } from '../../tests/web/browser.mjs';
import { CELL, ROUGHNESS, VIEWS, errors, overAll, percent, truth } from './measure.mjs';
import { makePanorama, makeWays } from './ways.mjs';

const [bin, panoramas, folder, csv] = process.argv.slice(2, 6).map((name) => path.resolve(name));
const only = process.argv.slice(6);
const CALM = 'courtyard';
// For each panorama the largest error, as a multiple of the error of CALM, which has no lights.
const NAMES = { [CALM]: 1, sunrise: 1, city: 1, sunset: 1, interior: 1, night: 2, forest: Infinity, studio: Infinity };

makeSite(folder);
for (const name of Object.keys(NAMES)) {
    const from = path.join(panoramas, `${name}.exr`);
    makePanorama(bin, folder, from, `${name}.hdr`);
    makePanorama(bin, folder, from, `${name}-rest.hdr`,
                 ['--sun', 'extract', '--lights-share', '0.001', '--lights-file', `${name}.json`]);
}
const lightsOf = (name) => JSON.parse(fs.readFileSync(path.join(folder, `${name}.json`))).lights;
const wholeSum = (lights) => lights.reduce((sum, { share }) => sum + share, 0);

// Returns the errors of an engine's pixels at each roughness: as parts of all light, and of the light that is left.
async function measure(browser, address, engine, name) {
    const [{ make }] = makeWays(bin, folder)(engine).slice(1); // kiln's file by default
    const rest = truth(bin, engine, path.join(folder, `${name}-rest.hdr`));
    const whole = lightsOf(name).length ? truth(bin, engine, path.join(folder, `${name}.hdr`)) : rest;
    const file = await make(`${name}-rest.hdr`);
    const draw = await openEngine(browser, address, engine.page);
    const shown = await draw(file, VIEWS, ROUGHNESS, CELL);
    return { ofAll: errors(shown, rest, whole), ofRest: errors(shown, rest) };
}

const figures = (rms) => [overAll(rms), Math.max(...rms)];
const tell = (rms) => figures(rms).map(percent).join('');
const lines = ['engine,panorama,lights,share,roughness,rms of all light,rms of the rest'];
const missed = [];
console.log('  RMS error in % over 19 roughnesses from 0.1 to 1, and at the worst: relative to all light, then ' +
            'relative to the\n  light that is left');
await withPage(folder, async (browser, address) => {
    browser.setDefaultTimeout(300000);
    for (const engine of current.filter(({ name, lightless }) => !lightless && (!only.length || only.includes(name)))) {
        let calm;
        for (const [name, bar] of Object.entries(NAMES)) {
            const { ofAll, ofRest } = await measure(browser, address, engine, name), lights = lightsOf(name);
            calm ??= figures(ofAll);
            const over = figures(ofAll).map((x, i) => x / calm[i]);
            console.log(`  ${engine.name.padEnd(14)} ${name.padEnd(9)} ${String(lights.length).padStart(2)} lights` +
                        `${percent(wholeSum(lights))} %  ${tell(ofAll)}  ${tell(ofRest)}`);
            if (Math.max(...over) > bar)
                missed.push(`${engine.name} errs in ${name} by ${over.map((x) => x.toFixed(2)).join(' and ')} of ` +
                            `${CALM}'s errors, more than ${bar}`);
            ofAll.forEach((x, i) => lines.push([engine.name, name, lights.length, wholeSum(lights), ROUGHNESS[i], x,
                                                ofRest[i]].join()));
        }
    }
});
fs.mkdirSync(path.dirname(csv), { recursive: true });
fs.writeFileSync(csv, `${lines.join('\n')}\n`);
missed.forEach((sentence) => console.log(`  MISSED: ${sentence}`));
process.exitCode = missed.length ? 1 : 0;

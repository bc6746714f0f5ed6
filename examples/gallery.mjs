// Compares engines that are lit by kiln's file with engines that filter the panorama themselves.
// In: panoramas. Out: HTML with rows of balls as each engine draws them, and their errors against
// the engine's shading of exactly filtered light; and rows of golden balls with true reflections,
// against an integral over the panorama.
//     node gallery.mjs BIN FOLDER FRAGMENT PANORAMA...
// BIN holds the kiln command; FOLDER receives temporary files; FRAGMENT receives the HTML with its
// pictures inside, which gallery.c makes into a page.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { engineOf, makePanorama, makeWays } from '../bench/engines/ways.mjs';
import * as models from '../tests/engines/models.mjs';
import { makeLobesBy } from '../npm/tools/lobes.mjs';
import { baked, dot, makeSite, openEngine, predict, readCube } from '../tests/engines/rig.mjs';
import { readTable } from '../tests/engines/three-table.mjs';
import { addDiffuse, brighten, reflect, texelsOf, toSteps } from '../tests/engines/truth.mjs';
import { HIDDEN, withBrowser } from '../tests/web/browser.mjs';

const [bin, folder, fragment, ...panoramas] = process.argv.slice(2).map((name) => path.resolve(name));
const ROUGHNESS = [0.1, 0.25, 0.4, 0.6, 0.8, 1], PIXELS = 56, LOUDER = 8;
const ENGINES = [models.three, models.babylon, models.filament, models.playcanvas];
const TITLES = { three: 'three.js', babylon: 'Babylon.js', filament: 'Filament', playcanvas: 'PlayCanvas' };

// A ball with a diameter of PIXELS, seen from direction toEye: the pixels inside it and their
// normals.
function makeBall(toEye, right, up) {
    const inside = [], normals = [];
    for (let i = 0; i < PIXELS * PIXELS; i++) {
        const x = 2 * (i % PIXELS + 0.5) / PIXELS - 1, y = 1 - 2 * (Math.floor(i / PIXELS) + 0.5) / PIXELS;
        const left = 1 - x * x - y * y;
        if (left < 0.02)
            continue; // skips pixels at the rim, where the error depends on the rim's exact place
        inside.push(i);
        normals.push(toEye.map((_, c) => x * right[c] + y * up[c] + Math.sqrt(left) * toEye[c]));
    }
    // openEngine's page draws a patch for each normal; the patches' right-hand axis is up x toEye,
    // which is opposite to `right` in engines with a left-handed world.
    const along = [0, 1, 2].map((i) => up[(i + 1) % 3] * toEye[(i + 2) % 3] - up[(i + 2) % 3] * toEye[(i + 1) % 3]);
    return { inside, view: { toEye, right: along, up, normals } };
}

// The ball in the axes of an engine, such that every engine shows the same side of the environment.
function ballOf(engine) {
    const { toKiln } = engine.model(6, 256);
    const axis = (d) => [0, 1, 2].map((i) => [0, 1, 2].reduce((sum, c) =>
        sum + d[c] * toKiln([0, 1, 2].map((k) => Number(k === i)))[c], 0));
    return makeBall(axis([0, 0, 1]), axis([1, 0, 0]), axis([0, 1, 0]));
}

// Bakes one exact level for each roughness, as kiln does without --for.
function exactLevels(panorama) {
    return ROUGHNESS.map((r, i) => {
        const file = `exact-${i}.ktx2`;
        execFileSync(path.join(bin, 'kiln'), ['bake', panorama, '-q', '-o', file, '--format', 'rgba32f', '--size',
                                              '256', '--roughness', `${r}`], { cwd: folder });
        return readCube(path.join(folder, file))[0];
    });
}

// The engine's shading model, evaluated with exactly filtered light.
function truth(engine, view, levels) {
    const { size, level_count: count } = engineOf(bin, engine.name);
    const model = engine.model(count, size), around = baked([levels.at(-1)]).irradiance;
    return ROUGHNESS.map((roughness, row) => predict(model, {
        radiance: (d) => baked([levels[row]]).radiance(d, 0), irradiance: around,
    }, view, roughness, ROUGHNESS).map((p) => p.value));
}

const rms = (shown, wanted) => {
    let off = 0, whole = 0;
    shown.forEach((pixel, i) => pixel.forEach((x, c) => {
        off += (x - wanted[i][c]) ** 2;
        whole += wanted[i][c] ** 2;
    }));
    return Math.sqrt(off / whole);
};

// Draws a row of balls as a PNG: radiance c through c / (c + 1) and the power 1 / 2.2; with `grey`,
// signed differences around middle grey.
function drawRow(page, inside, balls, exposure, grey) {
    const width = balls.length * (PIXELS + 4), bytes = new Uint8ClampedArray(4 * width * PIXELS);
    balls.forEach((ball, k) => ball.forEach((pixel, i) => {
        const to = 4 * (Math.floor(inside[i] / PIXELS) * width + k * (PIXELS + 4) + inside[i] % PIXELS);
        pixel.forEach((x, c) => {
            const light = Math.max(0, x * exposure);
            bytes[to + c] = grey ? 128 + 127 * x * exposure : 255 * (light / (1 + light)) ** (1 / 2.2);
        });
        bytes[to + 3] = 255;
    }));
    return page.evaluate(([base64, columns, rows]) => {
        const canvas = document.createElement('canvas');
        canvas.width = columns;
        canvas.height = rows;
        const data = Uint8ClampedArray.from(atob(base64), (c) => c.charCodeAt(0));
        canvas.getContext('2d').putImageData(new ImageData(data, columns, rows), 0, 0);
        return canvas.toDataURL('image/png');
    }, [Buffer.from(bytes).toString('base64'), width, PIXELS]);
}

const percent = (x) => `${(100 * x).toPrecision(2)}`;
const figure = (source, caption) =>
    `<figure><img class="wide" src="${source}" alt="Six balls"><figcaption>${caption}</figcaption></figure>`;

// The rows of one engine as HTML: two pictures for each maker of its files.
async function showEngine(browser, address, engine, file, levels) {
    const { inside, view } = ballOf(engine);
    const wanted = truth(engine, view, levels);
    const mean = wanted.at(-1).flat().reduce((sum, x) => sum + x, 0) / wanted.at(-1).length / 3;
    const draw = await openEngine(browser, address, engine.page);
    const html = [`<div class="rows"><h3>${TITLES[engine.name]}</h3>`];
    for (const { maker, make } of ways(engine)) {
        const [rows] = await draw(await make(file), [view], ROUGHNESS, 2);
        const errors = rows.map((row, k) => percent(rms(row, wanted[k]))).join(' &nbsp; ');
        const title = maker === 'kiln' ? '<b>kiln\'s file</b>' : maker === 'cmgen' ? 'cmgen\'s bake' : 'its own bake';
        html.push(figure(await drawRow(browser, inside, rows, 0.6 / mean, false), title));
        const off = rows.map((row, k) => row.map((p, i) => p.map((x, c) => x - wanted[k][i][c])));
        html.push(figure(await drawRow(browser, inside, off, LOUDER / mean / 2, true),
                         `error, ${LOUDER} times louder: ${errors} %`));
    }
    console.log(`  ${TITLES[engine.name]}`);
    return `${html.join('\n')}\n</div>`;
}

// ------------------------------------------------------------------------------- true reflections

const GOLD_WORDS = '<p>Balls of gold, of roughness 0.35, 0.5, 0.65, 0.8 and 0.95. Engines show a rough surface by one ' +
    'round lobe. With <code>trueReflections</code> of the npm package, the same file shows the lobe as it is. The truth ' +
    'is the integral of GGX over all texels of the panorama, with the light of further bounces as the engine adds it. ' +
    'Errors are in steps of 255 after c / (c + mean): grey is right, and the numbers are the rms of each ball.</p>';
const GOLD = [1, 0.766, 0.336], ROUGH = [0.35, 0.5, 0.65, 0.8, 0.95], LOUDER_STEPS = 4;

// What golden balls reflect once, as [roughness][normal], in kiln's axes. The narrowest lobes need
// finer texels.
function reflectOnce(panorama, { toEye, normals }) {
    const texelsBy = (size) => {
        execFileSync(path.join(bin, 'kiln'), ['bake', panorama, '-q', '-o', `texels-${size}.ktx2`, '--format',
                                              'rgba32f', '--size', `${size}`, '--levels', '1'], { cwd: folder });
        return texelsOf(readCube(path.join(folder, `texels-${size}.ktx2`))[0]);
    };
    const fine = texelsBy(128), coarse = texelsBy(64);
    return ROUGH.map((r) => normals.map((n) =>
        ({ nov: dot(n, toEye), r, ...reflect(r < 0.45 ? fine : coarse, n, toEye, r, GOLD) })));
}

const GOLDEN = [
    { engine: models.three, page: 'three-version.html?three', more: addDiffuse(readTable('three'), GOLD) },
    { engine: models.babylon, page: models.babylon.page, more: brighten(GOLD) },
];

// The golden balls of one engine as HTML: two pictures for each way to light them, and the truth.
async function showGold(browser, address, { engine, page, more }, file, once) {
    const { inside, view } = ballOf(engine), draw = await openEngine(browser, address, page);
    const wanted = once.map((row) => row.map(more)), all = wanted.flat(2);
    const mean = all.reduce((sum, x) => sum + x) / all.length, curve = toSteps(mean);
    const html = [`<div class="rows"><h3>${TITLES[engine.name]}, gold</h3>`];
    const show = async (title, rows) => {
        const off = rows.map((row, k) => row.map((p, i) => p.map((x, c) => curve(x) - curve(wanted[k][i][c]))));
        const errors = off.map((row) => Math.sqrt(row.flat().reduce((sum, x) => sum + x * x, 0) / row.length / 3));
        html.push(figure(await drawRow(browser, inside, rows, 0.6 / mean, false), title));
        html.push(figure(await drawRow(browser, inside, off, LOUDER_STEPS / 255, true),
                         `error, ${LOUDER_STEPS} times louder: ${errors.map((x) => x.toFixed(1)).join(' &nbsp; ')} of 255`));
    };
    const [own, kilns] = ways(engine), written = await kilns.make(file);
    const drawn = async (what, asked) => (await draw(what, [view], ROUGH, 2, { f0: GOLD, ...asked }))[0];
    await show('its own bake', await drawn(await own.make(file), { own: true }));
    await show('kiln\'s file', await drawn(written));
    for (const [taps, words] of [[1, 'one tap'], [2, 'two taps']])
        await show(`<b>kiln\'s file, true reflections with ${words}</b>`, await drawn(written, { taps }));
    html.push(figure(await drawRow(browser, inside, wanted, 0.6 / mean, false), 'truth'));
    console.log(`  ${TITLES[engine.name]}, gold`);
    return `${html.join('\n')}\n</div>`;
}

makeSite(folder);
makeLobesBy(path.join(bin, 'kiln'), path.join(folder, 'loaders/lobes'), ['three', 'babylon'], 2);
const ways = makeWays(bin, folder);
const html = [];
await withBrowser(folder, async (visit, address) => {
    for (const from of panoramas) {
        const { name } = path.parse(from), file = `${name}.hdr`;
        makePanorama(bin, folder, from, file);
        const levels = exactLevels(file);
        console.log(`${name} in`);
        // Side by side, since one engine alone does not keep all cores busy.
        const engines = await Promise.all(ENGINES.map(async (engine) => {
            let rows = '';
            await visit(async (browser) => {
                browser.setDefaultTimeout(300000);
                rows = await showEngine(browser, address, engine, file, levels);
            }, () => `${engine.name}: `);
            return rows;
        }));
        const once = reflectOnce(file, makeBall([0, 0, 1], [1, 0, 0], [0, 1, 0]).view);
        const golden = [];
        for (const one of GOLDEN)
            await visit(async (browser) => {
                browser.setDefaultTimeout(300000);
                golden.push(await showGold(browser, address, one, file, once));
            }, () => `${one.engine.name}, gold: `);
        html.push(`<h2>${name}</h2>`, ...engines, `<h2>${name}: true reflections</h2>`, GOLD_WORDS, ...golden);
    }
}, HIDDEN);
fs.writeFileSync(fragment, `${html.join('\n')}\n`);

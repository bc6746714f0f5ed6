// Compares engines that are lit by kiln's file with engines that filter the panorama themselves.
// In: panoramas. Out: HTML with rows of balls as each engine draws them, and their errors against
// the engine's shading of exactly filtered light.
//     node gallery.mjs BIN FOLDER FRAGMENT PANORAMA...
// BIN holds the kiln command; FOLDER receives temporary files; FRAGMENT receives the HTML with its
// pictures inside, which gallery.c makes into a page.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { engineOf, makePanorama, makeWays } from '../bench/engines/ways.mjs';
import * as models from '../tests/engines/models.mjs';
import { baked, makeSite, openEngine, predict, readCube } from '../tests/engines/rig.mjs';
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
    // The axes of all engines are converted to kiln's axes, so that every engine shows the
    // same side.
    const { toKiln } = engine.model(6, 256);
    const axis = (d) => [0, 1, 2].map((i) => [0, 1, 2].reduce((sum, c) =>
        sum + d[c] * toKiln([0, 1, 2].map((k) => Number(k === i)))[c], 0));
    const { inside, view } = makeBall(axis([0, 0, 1]), axis([1, 0, 0]), axis([0, 1, 0]));
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

makeSite(folder);
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
        html.push(`<h2>${name}</h2>`, ...engines);
    }
}, HIDDEN);
fs.writeFileSync(fragment, `${html.join('\n')}\n`);

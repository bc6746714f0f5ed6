// What the engines' proofs share; prove.mjs runs them.
//
// An engine draws flat patches of white metal, each with a normal of its own and lit by the file
// alone, in orthographic views: a pixel is a known direction, roughness and n.v. A model says in JS what
// the engine should then show: value = single * L(direction, lod) + multiple * I(normal).
import { execFile } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { promisify } from 'node:util';

export const [kilnPath, writePath, panorama, folder] =
    process.argv.slice(2).map((name) => path.resolve(name));
const here = import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname);

export function check(good, sentence) {
    if (!good)
        throw new Error(sentence);
}

export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const add = (a, s, b) => a.map((x, i) => x + s * b[i]);
const normalize = (a) => a.map((x) => x / Math.hypot(...a));
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                         a[0] * b[1] - a[1] * b[0]];
const mix = (a, b, t) => a.map((x, i) => x + t * (b[i] - x));

// ------------------------------------------------------------------------------------------ patches

export const COLUMNS = 32, CELL = 4;
export const ROUGHNESS = [0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1];

// Two views from opposite sides, or others. `toEye` is the direction to the camera.
export function makeViews(ways = [[0.31, 0.22, 0.92], [-0.4, -0.35, -0.85]]) {
    return ways.map((way) => {
        const toEye = normalize(way);
        const right = normalize(cross([0, 1, 0], toEye)), up = cross(toEye, right);
        // A spiral over the cap of n.v > 0.4.
        const normals = Array.from({ length: COLUMNS }, (_, i) => {
            const nov = 1 - 0.6 * (i + 0.5) / COLUMNS, angle = i * 2.399963;
            const side = add(right.map((x) => x * Math.cos(angle)), Math.sin(angle), up);
            return add(toEye.map((x) => x * nov), Math.sqrt(1 - nov * nov), side);
        });
        return { toEye, right, up, normals };
    });
}

// ------------------------------------------------------------------------------------- what is shown

const FACES = [(s, t) => [1, -t, -s], (s, t) => [-1, -t, s], (s, t) => [s, 1, t],
               (s, t) => [s, -1, -t], (s, t) => [s, -t, 1], (s, t) => [-s, -t, -1]];

function faceOf([x, y, z]) {
    const [ax, ay, az] = [x, y, z].map(Math.abs);
    if (ax >= ay && ax >= az)
        return [x > 0 ? 0 : 1, x > 0 ? -z / ax : z / ax, -y / ax];
    if (ay >= az)
        return [y > 0 ? 2 : 3, x / ay, y > 0 ? z / ay : -z / ay];
    return [z > 0 ? 4 : 5, z > 0 ? x / az : -x / az, -y / az];
}

// A level of a cube, read bilinearly across faces. row(i) has the rgba of row i of all faces' rows. Returns the first
// `channels` numbers.
export function readLevel({ size, row }, direction, channels = 3) {
    const [face, s, t] = faceOf(direction);
    const u = (s + 1) / 2 * size - 0.5, v = (t + 1) / 2 * size - 0.5;
    const corners = [0, 1, 2, 3].map((corner) => {
        let x = Math.floor(u) + corner % 2, y = Math.floor(v) + (corner >> 1), f = face;
        const weight = (1 - Math.abs(u - x)) * (1 - Math.abs(v - y));
        const out = [x, y].filter((at) => at < 0 || at >= size).length;
        if (out === 1) {
            const [other, p, q] = faceOf(FACES[face](2 * (x + 0.5) / size - 1,
                                                     2 * (y + 0.5) / size - 1));
            const place = (w) => Math.min(size - 1, Math.max(0, Math.floor((w + 1) / 2 * size)));
            [f, x, y] = [other, place(p), place(q)];
        }
        return { weight, texel: out < 2 && row(f * size + y).slice(4 * x, 4 * x + channels) };
    });
    // Where three faces meet there is no fourth texel; the mean of the three takes its place.
    const there = corners.filter(({ texel }) => texel), share = 1 / there.length;
    const missing = there.length < 4 ? corners.find(({ texel }) => !texel).weight : 0;
    const sum = Array(channels).fill(0);
    for (const { weight, texel } of there)
        texel.forEach((value, c) => { sum[c] += (weight + share * missing) * value; });
    return sum;
}

// Of an rgba32f KTX2 cube. Few of its texels are asked for, so that rows are read when they are.
export function readCube(name) {
    const file = fs.openSync(path.resolve(folder, name)), head = Buffer.alloc(80 + 24 * 32);
    fs.readSync(file, head, 0, head.length, 0);
    check(head.readUInt32LE(12) === 109, `${name} is not rgba32f`);
    return Array.from({ length: head.readUInt32LE(40) }, (_, level) => {
        const at = Number(head.readBigUInt64LE(80 + 24 * level));
        const size = head.readUInt32LE(20) >> level, rows = new Map();
        const row = (i) => {
            if (!rows.has(i)) {
                rows.set(i, new Float32Array(4 * size));
                fs.readSync(file, rows.get(i), 0, 16 * size, at + 16 * size * i);
            }
            return rows.get(i);
        };
        return { size, row };
    });
}

// Irradiance / pi of three bands: rows of coefficients, as kiln writes them.
function readHarmonics({ coefficients: c }, [x, y, z]) {
    const k = [0.282095, 0.488603, 1.092548, 0.315392, 0.546274].map((v) => v / Math.PI);
    const basis = [k[0], k[1] * y, k[1] * z, k[1] * x, k[2] * x * y, k[2] * y * z,
                   k[3] * (3 * z * z - 1), k[2] * x * z, k[4] * (x * x - y * y)];
    return [0, 1, 2].map((channel) => basis.reduce((sum, b, i) => sum + b * c[i][channel], 0));
}

// Radiance at a direction and a fractional level, and irradiance / pi, of each asset; kiln's
// directions. Engines take the latter from the last level or from harmonics.
const coded = (last, harmonics) => ({
    radiance: (d, lod) => d.map((x) => (1 + lod) * (2 + x)),
    irradiance: harmonics ? (n) => n.map((x) => 2 + 2 / 3 * x)
                          : (n) => n.map((x) => (1 + last) * (2 + x)),
});
const white = { radiance: () => [1, 1, 1], irradiance: () => [1, 1, 1] };
export const baked = (levels) => ({
    radiance: (d, lod, channels) => {
        const low = Math.min(Math.floor(lod), levels.length - 1);
        const high = Math.min(low + 1, levels.length - 1);
        return mix(readLevel(levels[low], d, channels), readLevel(levels[high], d, channels), lod - low);
    },
    irradiance: (n) => readLevel(levels.at(-1), n),
});

// The same for texels of four numbers that are interpolated before they are decoded.
function bakedInCode(levels, { encode, decode }) {
    const inCode = ({ size, row }) => {
        const rows = new Map();
        return { size, row: (i) => {
            if (!rows.has(i)) {
                const texels = row(i);
                rows.set(i, Array.from({ length: size }, (_, x) => encode(texels.slice(4 * x, 4 * x + 3))).flat());
            }
            return rows.get(i);
        } };
    };
    const coded = baked(levels.map(inCode));
    return { ...baked(levels), radiance: (d, lod) => decode(coded.radiance(d, lod, 4)) };
}

// What a model of models.mjs shows of an asset, at each normal of a row of patches.
export function predict(model, asset, { toEye: forward, right, up, normals }, roughness, all = ROUGHNESS) {
    const row = all.indexOf(roughness) - all.length / 2, half = 0.5 + 0.5 / CELL;
    return normals.map((n, i) => {
        // Babylon looks from the camera's place even where rays are parallel.
        const place = add(right.map((x) => (i + half - normals.length / 2) * x), row + half, up);
        const toEye = model.distance
            ? normalize(add(forward.map((x) => model.distance * x), -1, place)) : forward;
        const nov = dot(n, toEye), r = model.clamp ? model.clamp(roughness) : roughness;
        const mirror = add(n.map((x) => 2 * nov * x), -1, toEye);
        const way = model.bend ? normalize(mix(mirror, n, model.bend(r))) : mirror;
        const [single, multiple] = model.shade(nov, r);
        const light = asset.radiance(model.toKiln(way), model.lod(r));
        const around = asset.irradiance(model.toKiln(n));
        const curve = model.curve ?? ((x) => x);
        return { way, nov, r, single, multiple, around,
                 value: light.map((x, c) => single * curve(x) + multiple * around[c]) };
    });
}

// --------------------------------------------------------------------------------------- comparisons

// Solves the normal equations of rows [1, x, y, z] for one channel.
function fitLine(rows, values) {
    const a = Array.from({ length: 4 }, () => Array(5).fill(0));
    rows.forEach((row, k) => {
        for (let i = 0; i < 4; i++) {
            for (let j = 0; j < 4; j++)
                a[i][j] += row[i] * row[j];
            a[i][4] += row[i] * values[k];
        }
    });
    for (let i = 0; i < 4; i++) {
        const pivot = a.slice(i).reduce((best, row, k) =>
            (Math.abs(row[i]) > Math.abs(a[best][i]) ? k + i : best), i);
        [a[i], a[pivot]] = [a[pivot], a[i]];
        for (let k = 0; k < 4; k++)
            if (k !== i)
                a[k] = a[k].map((x, j) => x - a[k][i] / a[i][i] * a[i][j]);
    }
    return a.map((row, i) => row[4] / row[i]);
}

// A direction as a coarse level's texels tell it, between which it is read bilinearly.
const told = new Map();
function readDirection(way, size) {
    if (size > 64)
        return way;
    if (!told.has(size)) {
        const at = (i) => 2 * (i + 0.5) / size - 1;
        const rows = Array.from({ length: 6 * size }, (_, i) => Array.from({ length: size }, (_, x) =>
            [...normalize(FACES[Math.floor(i / size)](at(x), at(i % size))), 0]).flat());
        told.set(size, { size, row: (i) => rows[i] });
    }
    return readLevel(told.get(size), way);
}

function readMixed(model, way, lod, size) {
    const low = Math.floor(lod), t = lod - low;
    const read = model.told ?? readDirection;
    return mix(read(way, size >> low).map((x) => x * (1 + low) / (1 + lod)),
               read(way, Math.max(1, size >> (low + 1))).map((x) => x * (2 + low) / (1 + lod)), t);
}

// From the pixels alone: which axes each channel follows, and which level was read.
function checkCoded(say, model, views, last, size, shown, bounds) {
    const asset = coded(last, model.harmonics), worst = { axes: 0, lod: 0 };
    ROUGHNESS.forEach((roughness, row) => {
        const rows = [], channels = [[], [], []];
        views.forEach((view, side) => predict(model, asset, view, roughness).forEach((p, i) => {
            if (p.single < 0.1)
                return; // diffuse light alone
            rows.push([1, ...readMixed(model, p.way, model.lod(p.r), size)]);
            shown[side][row][i].forEach((x, c) =>
                channels[c].push((x - p.multiple * p.around[c]) / p.single));
        }));
        if (!rows.length)
            return;
        const fits = channels.map((values) => fitLine(rows, values));
        const level = fits.reduce((sum, fit) => sum + fit[0] / 6, 0);
        const lod = model.lod(model.clamp ? model.clamp(roughness) : roughness);
        worst.lod = Math.max(worst.lod, Math.abs(level - 1 - lod));
        fits.forEach((fit, c) => [[1, 0, 0], [0, 1, 0], [0, 0, 1]].forEach((axis, i) => {
            worst.axes = Math.max(worst.axes, Math.abs(fit[1 + i] / level - model.toKiln(axis)[c]));
        }));
    });
    say(`coded: axes to ${worst.axes.toFixed(4)}, level to ${worst.lod.toFixed(4)}`);
    check(worst.axes < bounds.axes && worst.lod < bounds.lod,
          `axes are off by ${worst.axes} (${bounds.axes}), the level by ${worst.lod} (${bounds.lod})`);
}

// Of the rows whose roughness lies within bounds.rows.
function checkPixels(say, name, model, asset, views, shown, bounds) {
    let most = 0, squares = 0, count = 0, scale = 0;
    const [from, to] = bounds.rows ?? [0, 1];
    views.forEach((view, side) => ROUGHNESS.forEach((roughness, row) =>
        from <= roughness && roughness <= to && predict(model, asset, view, roughness).forEach((p, i) => p.value.forEach((wanted, c) => {
            const off = Math.abs(shown[side][row][i][c] - wanted);
            most = Math.max(most, off / wanted);
            squares += off * off;
            scale += wanted * wanted;
            count++;
        }))));
    const rms = Math.sqrt(squares / scale);
    say(`${name}: ${count} values, rms ${rms.toExponential(1)}, ${most.toExponential(1)} at most`);
    const limit = bounds.most ?? Infinity;
    check(rms < bounds.rms && most < limit,
          `${name} is off by ${rms} rms (${bounds.rms}), ${most} at most (${limit})`);
}

// --------------------------------------------------------------------------------------------- files

// In turn, two at a time: kiln takes every core by itself, but waits for the disk.
const lanes = [Promise.resolve(), Promise.resolve()];
let turn = 0;
function run(program, args) {
    const lane = turn++ % lanes.length;
    const job = lanes[lane].then(() =>
        promisify(execFile)(program, args.map(String), { cwd: folder, maxBuffer: 1 << 26 }));
    lanes[lane] = job.catch(() => {});
    return job.then(({ stdout }) => stdout);
}
// What was asked for before is there already.
const made = new Map();
function once(program, args) {
    const key = [program, ...args].join('\n');
    if (!made.has(key))
        made.set(key, run(program, args));
    return made.get(key);
}
export const kiln = (...args) => once(kilnPath, args);
export const write = (...args) => once(writePath, args);

export const readFile = (name) => fs.readFileSync(path.join(folder, name));

async function engineOf(name) {
    return JSON.parse(await kiln('engines', '--json')).find((row) => row.name === name);
}

// Levels as kiln bakes them without --for.
export async function bakePlain(size, roughness, from = panorama) {
    const file = [path.parse(from).name, size, ...roughness.map((r) => Math.round(1e6 * r))].join('-') + '.ktx2';
    await kiln('bake', from, '-q', '-o', file, '--format', 'rgba32f', '--size', size, '--levels', roughness.length,
               '--roughness', roughness.join());
    return readCube(file);
}

// Where pages find packages, loaders and themselves. The loaders are those of the sources, or of a built npm package,
// which can bake.
export const builtPackage = process.env.KILN_PACKAGE;
function linkLoaders(place) {
    if (builtPackage)
        return fs.symlinkSync(path.resolve(builtPackage), place);
    const sources = path.join(here, '../../npm'); // to which tables of trueReflections() may be added
    fs.mkdirSync(place);
    for (const file of fs.readdirSync(sources).filter((name) => name.endsWith('.mjs')))
        fs.symlinkSync(path.join(sources, file), path.join(place, file));
    return undefined;
}
export function makeSite(site) {
    fs.rmSync(site, { recursive: true, force: true });
    fs.mkdirSync(site, { recursive: true });
    fs.symlinkSync(path.join(here, 'node_modules'), path.join(site, 'npm'));
    linkLoaders(path.join(site, 'loaders'));
    fs.symlinkSync(here, path.join(site, 'pages'));
}

// The page of an engine defines draw(file, views, ROUGHNESS, CELL, asked), which resolves to numbers
// [view][roughness][normal][channel]. An .hdr is a panorama, which the engine filters by itself. Numbers come
// as one text, which takes the browser's protocol a fraction of the time that arrays do.
export async function openEngine(browser, address, page) {
    await browser.goto(`${address}pages/${page}`);
    await browser.waitForFunction(() => window.draw);
    return async (file, views, roughness, cell, asked = {}) => JSON.parse(await browser.evaluate(async (args) =>
        JSON.stringify(await window.draw(...JSON.parse(args)), (_, x) => {
            if (typeof x === 'number' && !Number.isFinite(x)) // for which JSON has no word
                throw new Error(`${x} is drawn`);
            return x;
        }), JSON.stringify([`${address}${file}`, views, roughness, cell, asked])));
}

// The files of an engine that prove() draws, and the levels that its model reads.
// words: what else `kiln bake` is told.
export async function makeFiles({ name, ending, format, words = [], smallest = 0, bounds, model }) {
    const { size, level_count: count } = await engineOf(name);
    const files = [name, ...(format ? [format[0]] : [])].join('-');
    const bake = async (what, ...more) => JSON.parse(await kiln(
        'bake', panorama, '--for', name, '-o', `${files}-${what}${ending}`, '--json', ...words, ...more,
        ...(format ? ['--format', format[0]] : [])));
    for (const what of ['coded', 'white'])
        if (bounds[what])
            await write(name, what, size, `${files}-${what}${ending}`, ...(format ? [format[1]] : []));
    const report = await bake('real', '--tune=none');
    const roughness = report.output.levels.map((level) => level.roughness);
    const small = roughness.filter((_, k) => size >> k <= smallest); // those that all have the smallest size
    const levels = await bakePlain(size, roughness.slice(0, roughness.length - small.length));
    for (const r of small)
        levels.push(...await bakePlain(smallest, [r]));
    const { harmonics, coding } = model(count, size);
    let light = (cube) => (coding ? bakedInCode(cube, coding) : baked(cube));
    if (harmonics) {
        await kiln('bake', panorama, '-q', '-o', 'plain.hdr', '--size', 8, '--levels', 1, '--sh', 'sh.json',
                   '--sh-irradiance');
        const sh = JSON.parse(readFile('sh.json'));
        const levelsAlone = light;
        light = (cube) => ({ ...levelsAlone(cube), irradiance: (n) => readHarmonics(sh, n) });
    }
    const found = { files, size, count, real: light(levels) };
    if (!bounds.byDefault)
        return found;
    await bake('default');
    await write(name, 'default', panorama, `${files}-levels.ktx2`);
    return { ...found, byDefault: light(readCube(`${files}-levels.ktx2`)) };
}

// Takes an engine of models.mjs with bounds of its errors, its files, its page's draw() and what to do with a
// line of report.
// bounds.byDefault: drawn is also the file that kiln bakes when told the engine alone; its levels are read.
// bounds.diffuse: the page draws diffuse light alone where it is asked for that.
// format: its name and its number in kiln_format, where it is not the engine's first.
// asked: what else the page is told.
export async function prove({ loads, model, bounds, asked }, { files, size, count, real, byDefault }, show, say) {
    const views = makeViews(), shading = model(count, size);
    const draw = (what, more) => show(`${files}-${what}${loads}`, views, ROUGHNESS, CELL, { ...asked, ...more });
    if (bounds.coded)
        checkCoded(say, shading, views, count - 1, size, await draw('coded'), bounds.coded);
    if (bounds.white)
        checkPixels(say, 'furnace', shading, white, views, await draw('white'), bounds.white);
    const shown = await draw('real');
    [bounds.real].flat().forEach((bound) => checkPixels(say, 'real', shading, real, views, shown, bound));
    if (bounds.byDefault) {
        const pixels = await draw('default');
        [bounds.byDefault].flat().forEach((bound) =>
            checkPixels(say, 'by default', shading, byDefault, views, pixels, bound));
    }
    if (bounds.diffuse) {
        const matt = { ...shading, shade: () => [0, 1] }, diffuse = { diffuse: true };
        checkPixels(say, 'diffuse, coded', matt, coded(count - 1, shading.harmonics), views,
                    await draw('coded', diffuse), bounds.diffuse);
        checkPixels(say, 'diffuse, real', matt, real, views, await draw('real', diffuse), bounds.diffuse);
    }
}

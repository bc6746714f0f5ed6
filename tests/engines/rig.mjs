// What the engines' tests share. Each is run as: node NAME.mjs KILN WRITE PANORAMA FOLDER
//
// An engine draws flat patches of white metal, each with a normal of its own and lit by the file
// alone, in orthographic views: a pixel is a known direction, roughness and n.v. A model says in JS what
// the engine should then show: value = single * L(direction, lod) + multiple * I(normal).
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { withPage } from '../web/browser.mjs';

const [kilnPath, writePath, panorama, folder] =
    process.argv.slice(2).map((name) => path.resolve(name));
const here = import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname);

export function check(good, sentence) {
    if (!good)
        throw new Error(sentence);
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const add = (a, s, b) => a.map((x, i) => x + s * b[i]);
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

// A level of an rgba32f KTX2 cube, read bilinearly across faces.
function readLevel({ size, texels }, direction) {
    const [face, s, t] = faceOf(direction);
    const u = (s + 1) / 2 * size - 0.5, v = (t + 1) / 2 * size - 0.5;
    const sum = [0, 0, 0];
    for (let corner = 0; corner < 4; corner++) {
        let x = Math.floor(u) + corner % 2, y = Math.floor(v) + (corner >> 1), f = face;
        const weight = (1 - Math.abs(u - x)) * (1 - Math.abs(v - y));
        if (x < 0 || y < 0 || x >= size || y >= size) {
            const [other, p, q] = faceOf(FACES[face](2 * (x + 0.5) / size - 1,
                                                     2 * (y + 0.5) / size - 1));
            const place = (w) => Math.min(size - 1, Math.max(0, Math.floor((w + 1) / 2 * size)));
            [f, x, y] = [other, place(p), place(q)];
        }
        for (let c = 0; c < 3; c++)
            sum[c] += weight * texels[4 * ((f * size + y) * size + x) + c];
    }
    return sum;
}

export function readCube(name) {
    const bytes = fs.readFileSync(path.resolve(folder, name));
    check(bytes.readUInt32LE(12) === 109, `${name} is not rgba32f`);
    return Array.from({ length: bytes.readUInt32LE(40) }, (_, level) => {
        const at = Number(bytes.readBigUInt64LE(80 + 24 * level));
        const size = bytes.readUInt32LE(20) >> level;
        const data = bytes.subarray(at, at + 96 * size * size);
        return { size, texels: new Float32Array(new Uint8Array(data).buffer) };
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
    radiance: (d, lod) => {
        const low = Math.min(Math.floor(lod), levels.length - 1);
        const high = Math.min(low + 1, levels.length - 1);
        return mix(readLevel(levels[low], d), readLevel(levels[high], d), lod - low);
    },
    irradiance: (n) => readLevel(levels.at(-1), n),
});

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
        const texels = new Float32Array(24 * size * size), at = (i) => 2 * (i + 0.5) / size - 1;
        for (let i = 0; i < 6 * size * size; i++) {
            const face = Math.floor(i / size / size), y = Math.floor(i / size) % size;
            texels.set(normalize(FACES[face](at(i % size), at(y))), 4 * i);
        }
        told.set(size, { size, texels });
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
function checkCoded(model, views, last, size, shown, bounds) {
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
    console.log(`  coded: axes to ${worst.axes.toFixed(4)}, level to ${worst.lod.toFixed(4)}`);
    check(worst.axes < bounds.axes && worst.lod < bounds.lod,
          `axes are off by ${worst.axes} (${bounds.axes}), the level by ${worst.lod} (${bounds.lod})`);
}

// Of the rows whose roughness lies within bounds.rows.
function checkPixels(name, model, asset, views, shown, bounds) {
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
    console.log(`  ${name}: ${count} values, rms ${rms.toExponential(1)}, ${most.toExponential(1)} at most`);
    const limit = bounds.most ?? Infinity;
    check(rms < bounds.rms && most < limit,
          `${name} is off by ${rms} rms (${bounds.rms}), ${most} at most (${limit})`);
}

// --------------------------------------------------------------------------------------------- files

const run = (program, ...args) =>
    execFileSync(program, args, { cwd: folder, encoding: 'utf8', maxBuffer: 1 << 26 });
export const kiln = (...args) => run(kilnPath, ...args);
export const write = (...args) => run(writePath, ...args);

export function engineOf(name) {
    return JSON.parse(kiln('engines', '--json')).find((row) => row.name === name);
}

const bakePlain = (file, size, roughness) =>
    kiln('bake', panorama, '-q', '-o', file, '--format', 'rgba32f', '--size', `${size}`,
         '--levels', `${roughness.length}`, '--roughness', roughness.join());

// Where pages find packages, loaders and themselves.
export function makeSite(site) {
    fs.rmSync(site, { recursive: true, force: true });
    fs.mkdirSync(site, { recursive: true });
    fs.symlinkSync(path.join(here, 'node_modules'), path.join(site, 'npm'));
    fs.symlinkSync(path.join(here, '../../web/loaders'), path.join(site, 'loaders'));
    fs.symlinkSync(here, path.join(site, 'pages'));
}

// The page of an engine defines draw(file, views, ROUGHNESS, CELL), which resolves to numbers
// [view][roughness][normal][channel]. An .hdr is a panorama, which the engine filters by itself.
export async function openEngine(browser, address, page) {
    await browser.goto(`${address}pages/${page}`);
    await browser.waitForFunction(() => window.draw);
    return (file, views, roughness, cell) => browser.evaluate(
        (args) => window.draw(...args), [`${address}${file}`, views, roughness, cell]);
}

// Takes an engine of models.mjs, bounds of its errors, and
// bounds.diffuse: the page draws diffuse light alone where its address ends in #diffuse.
// format: its name and its number in kiln_format, where it is not the engine's first.
async function prove(browser, address, { name, page, ending, loads, format, smallest = 0, model, bounds }) {
    const { size, level_count: count } = engineOf(name);
    for (const what of ['coded', 'white'])
        run(writePath, name, what, `${size}`, `${what}${ending}`, ...(format ? [`${format[1]}`] : []));
    const report = JSON.parse(kiln('bake', panorama, '--for', name, '--fit=none', '-o', `real${ending}`, '--json',
                                    ...(format ? ['--format', format[0]] : [])));
    const roughness = report.output.levels.map((level) => level.roughness);
    const levels = roughness.flatMap((r, k) => (size >> k > smallest ? [] : [r]));
    bakePlain('plain.ktx2', size, smallest ? roughness.slice(0, -levels.length) : roughness);
    if (smallest) // those that all have the smallest size
        levels.forEach((r, i) => bakePlain(`plain${i}.ktx2`, smallest, [r]));
    kiln('bake', panorama, '-q', '-o', 'plain.hdr', '--size', '8', '--levels', '1', '--sh', 'sh.json',
         '--sh-irradiance');
    const sh = JSON.parse(fs.readFileSync(path.join(folder, 'sh.json')));
    const views = makeViews(), made = model(count, size);
    const open = await openEngine(browser, address, page);
    const draw = (file) => open(file, views, ROUGHNESS, CELL);
    console.log(name, format?.[0] ?? '');
    if (bounds.coded)
        checkCoded(made, views, count - 1, size, await draw(`coded${loads}`), bounds.coded);
    if (bounds.white)
        checkPixels('furnace', made, white, views, await draw(`white${loads}`), bounds.white);
    const real = baked([...readCube('plain.ktx2'),
                        ...levels.flatMap((_, i) => (smallest ? readCube(`plain${i}.ktx2`) : []))]);
    if (made.harmonics)
        real.irradiance = (n) => readHarmonics(sh, n);
    const shown = await draw(`real${loads}`);
    [bounds.real].flat().forEach((bound) => checkPixels('real', made, real, views, shown, bound));
    if (bounds.diffuse) {
        await browser.evaluate(() => { location.hash = 'diffuse'; });
        const matt = { ...made, shade: () => [0, 1] };
        checkPixels('diffuse, coded', matt, coded(count - 1, made.harmonics), views,
                    await draw(`coded${loads}`), bounds.diffuse);
        checkPixels('diffuse, real', matt, real, views, await draw(`real${loads}`), bounds.diffuse);
    }
}

// Proves one after the other, in one browser.
export async function proveEngine(...engines) {
    makeSite(folder);
    await withPage(folder, async (browser, address) => {
        for (const engine of engines)
            await prove(browser, address, engine);
    });
}

// trueReflections() of kiln-ibl/three and kiln-ibl/babylon shows gold nearer to the truth than the engines show it: by
// pixels of balls, against a sum over all texels of the panorama.
//
// Errors are the root of the mean square of the difference in steps of 255, after x / (x + mean) with the mean radiance
// of the panorama. KILN_PANORAMAS names others of build/data/blender than courtyard, with commas between.
import path from 'node:path';
import { approximateSplit, babylon, three, threeCubeUv, threeCubeUvApproximate } from './models.mjs';
import { readTable } from './three-table.mjs';
import { addDiffuse, brighten, reflect, texelsOf, toSteps } from './truth.mjs';
import { makeLobesBy } from '../../npm/tools/lobes.mjs';
import { CELL, add, bakePlain, builtPackage, check, dot, folder, kiln, kilnPath, makeViews, panorama, readFile, write } from './rig.mjs';

const GOLD = [1, 0.766, 0.336], ROUGHNESS = [0.35, 0.55, 0.75, 0.95], PATCHES = 96, TEXELS = 128;

// Balls seen from two sides: normals whose places are spread evenly over the ball's disc.
const views = makeViews().map(({ toEye, right, up }) => ({
    toEye, right, up,
    normals: Array.from({ length: PATCHES }, (_, i) => {
        const nov = Math.sqrt(1 - (i + 0.5) / PATCHES), angle = i * 2.399963;
        const side = add(right.map((x) => x * Math.cos(angle)), Math.sin(angle), up);
        return add(toEye.map((x) => x * nov), Math.sqrt(1 - nov * nov), side);
    }),
}));

function steps(shown, truth, mean) {
    const curve = toSteps(mean);
    return ROUGHNESS.map((_, row) => {
        const off = truth.flatMap((view, side) => view[row].flatMap((rgb, i) =>
            rgb.map((x, c) => (curve(shown[side][row][i][c]) - curve(x)) ** 2)));
        return Math.sqrt(off.reduce((sum, x) => sum + x) / off.length);
    });
}
const together = (rows) => Math.sqrt(rows.reduce((sum, x) => sum + x * x, 0) / rows.length);

const environments = (process.env.KILN_PANORAMAS ?? 'courtyard').split(',')
    .map((name) => path.join(path.dirname(panorama), `${name}.exr`));

// What patches reflect once of a panorama, as [view][roughness][normal]: computed once for engines of the same axes.
const known = new Map();
function reflected(name, cube, toKiln) {
    const key = `${name} ${toKiln([1, 2, 3])}`;
    if (!known.has(key)) {
        const texels = texelsOf(cube);
        known.set(key, views.map(({ toEye, normals }) => ROUGHNESS.map((r) => normals.map((n) =>
            ({ nov: dot(n, toEye), r, ...reflect(texels, toKiln(n), toKiln(toEye), r, GOLD) })))));
    }
    return known.get(key);
}

// kiln's files of a panorama for an engine, by default and with exactly filtered levels, and what they should show.
async function prepareOne(from, { name: engine, ending, model }) {
    const { name } = path.parse(from), words = ['bake', from, '-q', '--for', engine];
    await kiln(...words, '-o', `${name}-${engine}${ending}`, '--sh', `${name}-sh.json`);
    await kiln(...words, '-o', `${name}-${engine}-exact${ending}`, '--tune=none');
    await kiln('bake', from, '-q', '-o', `${name}.hdr`, '--shape', 'panorama', '--size', 512, '--levels', 1);
    await write(engine, 'white', 256, `${engine}-white${ending}`);
    const [cube] = await bakePlain(TEXELS, [0], from);
    return { name, once: reflected(name, cube, model(6, 256).toKiln), sh: JSON.parse(readFile(`${name}-sh.json`)) };
}

// The tables, which a built package has already.
let tables = false;
function makeTables() {
    if (!tables && !builtPackage)
        makeLobesBy(kilnPath, path.join(folder, 'loaders/lobes'));
    tables = true;
}

// What the loader finds of the harmonics, against what the command writes.
async function checkHarmonics({ name, sh }, { name: engine, ending }, draw, say) {
    const found = await draw(`${name}-${engine}${ending}`, views, ROUGHNESS, CELL, { harmonics: true });
    const off = Math.max(...sh.coefficients.flatMap((rgb, i) => rgb.map((x, c) => Math.abs(x - found[i][c]))));
    say(`${name}: harmonics off by ${off.toExponential(1)} at most`);
    check(off < (engine === 'three-cubeuv' ? 1e-3 : 1e-6), `${name}: the harmonics are off by ${off}`);
}

// Draws the engine's own bake and kiln's files, without and with true reflections. Returns the errors.
async function compare({ name, once, sh }, { engine, whole, more }, draw, say) {
    const truth = once.map((view) => view.map((row) => row.map(more)));
    const mean = 0.28209479 * sh.coefficients[0].reduce((a, b) => a + b) / 3, errors = {};
    const show = async (title, file, asked) => {
        const rows = steps(await draw(file, views, ROUGHNESS, CELL, { f0: GOLD, ...asked }), truth, mean);
        errors[title] = together(rows);
        say(`${name}, ${title.padEnd(9)} ${rows.map((x) => x.toFixed(2)).join('  ')}   ${errors[title].toFixed(2)}`);
    };
    const file = (what) => `${name}-${engine.name}${what}${engine.ending}`;
    if (whole && engine.name !== 'babylon') // whose own filter takes minutes in software
        await show('own', `${name}.hdr`, { own: true });
    if (whole && engine.name === 'three')
        await show('own, 2', `${name}.hdr`, { own: true, taps: 2, sh });
    await show('file', file(''), {});
    for (const taps of whole ? [1, 2, 3] : [2]) {
        await show(`file, ${taps}`, file(''), { taps });
        if (whole)
            await show(`exact, ${taps}`, file('-exact'), { taps });
    }
    return errors;
}

// ----------------------------------------------------------------------- what true reflections leave as it is

const flat = (shown) => shown.flat(3);
const differ = (a, b) => Math.max(...a.map((x, i) => Math.abs(x - b[i])));

// White light on white metal is white, and materials with other numbers of taps share a scene. With harmonics twice as
// bright, what the taps do not show is brighter.
async function checkFurnace(_, { name: engine, ending }, draw, say) {
    const white = Math.sqrt(4 * Math.PI), black = Array(8).fill([0, 0, 0]), taps = [1, 2, 3, 1];
    const show = async (asked) => flat(await draw(`${engine}-white${ending}`, views, ROUGHNESS, CELL, asked));
    const [before, after, brighter] = [await show({}), await show({ taps, sh: { coefficients: [Array(3).fill(white), ...black] } }),
                                       await show({ taps, sh: { coefficients: [Array(3).fill(2 * white), ...black] } })];
    say(`furnace: off by ${differ(before, after).toExponential(1)} at most`);
    check(differ(before, after) < 2e-3, `in a white furnace true reflections change pixels by ${differ(before, after)}`);
    check(differ(before, brighter) > 0.1, 'harmonics change no pixel');
}

// Reflections of a clear coat and of sheen, diffuse light, and those of anisotropic lobes: in the material of three.js
// that the function then does not concern.
const OTHERS = {
    'clear coat': { physical: { color: 0, clearcoat: 1, clearcoatRoughness: 0.3 } },
    'sheen': { physical: { color: 0, sheen: 1, sheenColor: 0xffffff } },
    'diffuse light': { diffuse: true },
    'anisotropy': { later: { anisotropy: 0.7 }, physical: { metalness: 1 } },
};
async function checkOthers({ name }, { name: engine, ending }, draw, say) {
    for (const [what, asked] of Object.entries(OTHERS)) {
        const show = async (taps) => flat(await draw(`${name}-${engine}${ending}`, views, ROUGHNESS, CELL,
                                                     { ...asked, taps }));
        const [before, after] = [await show(), await show(2)], off = differ(before, after);
        say(`${what}: ${off === 0 ? 'equal' : `off by ${off}`}, of ${Math.max(...before).toFixed(2)}`);
        check(off === 0 && Math.max(...before) > 0.1, `true reflections change ${what} by ${off}`);
    }
}

// An environment that is turned about y shows what the environment shows when all else is turned back.
async function checkTurn({ name }, { name: engine, ending }, draw, say) {
    const turn = 0.7, [c, s] = [Math.cos(turn), Math.sin(turn)], back = ([x, y, z]) => [c * x - s * z, y, s * x + c * z];
    const turned = views.map(({ toEye, right, up, normals }) => ({
        toEye: back(toEye), right: back(right), up: back(up), normals: normals.map(back) }));
    const show = async (from, asked) => flat(await draw(`${name}-${engine}${ending}`, from, ROUGHNESS, CELL,
                                                        { taps: 2, f0: GOLD, ...asked }));
    const [first, second] = [await show(views, { turn }), await show(turned, {})];
    const off = Math.max(...first.map((x, i) => Math.abs(x - second[i]) / (x + 0.1)));
    say(`turned: off by ${off.toExponential(1)} at most`);
    check(off < 2e-3, `a turned environment shows other pixels, by ${off}`);
}

// What the function refuses, by which sentence.
async function checkRefusals(asked, draw, say) {
    for (const [file, options, pattern] of asked) {
        const sentence = await draw(file, views, ROUGHNESS, CELL, { material: {}, ...options });
        say(`refuses: ${sentence}`);
        check(pattern.test(sentence), `${file} is not refused by the right sentence: ${sentence}`);
    }
}
const REFUSED = ({ name }) => [
    [`${name}-three.ktx2`, { material: { anisotropy: 0.5 } }, /the material's anisotropy is 0.5, and the tables are/],
    [`${name}-three.ktx2`, { taps: 4 }, /taps is 4, and must be 1, 2 or 3/],
    [`${name}.hdr`, { own: true }, /the environment has no spherical harmonics; pass the option sh/],
    [`${name}.hdr`, { own: true, sh: { coefficients: [] } }, /must be an object with 9 coefficients of 3 numbers or more/],
];

// One proof after the other, since a browser with all of them is slow. run(panorama, draw, say) is called for each
// panorama.
let before = Promise.resolve();
function proofOf({ title, page, engine, run }) {
    const turn = before;
    let done;
    before = new Promise((resolve) => { done = resolve; });
    return {
        name: engine.name, title, page,
        prepare: async () => {
            await turn;
            makeTables();
            const files = Promise.all(environments.map((from) => prepareOne(from, engine)));
            files.catch(done); // the next proof need not wait
            return files;
        },
        check: async (all, draw, say) => {
            try {
                for (const one of all)
                    await run(one, draw, say);
            } finally {
                done();
            }
        },
    };
}

// bounds: the greatest errors of kiln's file with true reflections, by the number of taps, as shares of the error
// without.
function errorsOf(title, page, { engine, whole, more, bounds }) {
    return proofOf({ title, page, engine, run: async (one, draw, say) => {
        await checkHarmonics(one, engine, draw, say);
        const errors = await compare(one, { engine, whole, more }, draw, say);
        for (const [taps, bound] of Object.entries(bounds)) {
            const share = errors[`file, ${taps}`] / errors.file;
            say(`${one.name}: ${taps} ${taps === '1' ? 'tap leaves' : 'taps leave'} ${share.toFixed(2)} of the error`);
            check(share < bound, `${title}, ${one.name}: ${taps} taps leave ${share} of the error (${bound})`);
        }
    } });
}
const threeOf = (version, engine, table, whole, bounds) =>
    errorsOf(version, `three-version.html?${version}`, { engine, whole, more: addDiffuse(table, GOLD), bounds });

export default [
    threeOf('three', three, readTable('three'), true, { 1: 0.6, 2: 0.36, 3: 0.3 }),
    proofOf({ title: 'three, what stays', page: 'three-version.html?three', engine: three, run: async (one, draw, say) => {
        for (const stays of [checkFurnace, checkOthers, checkTurn])
            await stays(one, three, draw, say);
        await checkRefusals(REFUSED(one), draw, say);
    } }),
    proofOf({ title: 'three,webgpu', page: 'three-version.html?three,webgpu', engine: three, run: async ({ name }, draw, say) =>
        checkRefusals([[`${name}-three.ktx2`, {}, /changes shaders of WebGLRenderer, and this is the build.*WebGPURenderer/]],
                      draw, say) }),
    errorsOf('babylon', 'babylon.html', { engine: babylon, whole: true, more: brighten(GOLD),
                                          bounds: { 1: 0.55, 2: 0.36, 3: 0.3 } }),
    errorsOf('babylon 5', 'babylon.html?babylonjs-5', { engine: babylon, more: brighten(GOLD), bounds: { 2: 0.25 } }),
    threeOf('three-r186', threeCubeUv, readTable('three-r183'), true, { 1: 0.55, 2: 0.35, 3: 0.32 }),
    threeOf('three-r181', threeCubeUv, readTable('three-r183'), false, { 2: 0.35 }),
    // Up to r180 the closed form of A and B errs more than the lobe does.
    ...['r180', 'r170', 'r162', 'r152', 'r150'].map((r) =>
        threeOf(`three-${r}`, threeCubeUvApproximate, approximateSplit, false, { 2: 0.8 })),
];

// The web page's main module. In: the address, dropped files, controls, keys. Out: the rendered
// view, the strip of baked levels, files to download. A worker (engine.mjs) bakes and another
// (stage_client.mjs) draws, so that nothing keeps the page waiting; the state is kept in the address.
import { BackgroundWork } from './background.mjs';
import { CheckPanel, sortFiles } from './check.mjs';
import { makeControls, NAMES } from './controls.mjs';
import { Engine } from './engine.mjs';
import { Files, save } from './files.mjs';
import { showHistogram } from './histogram.mjs';
import { showLabels } from './labels.mjs';
import { StageClient } from './stage_client.mjs';
import { bounded, flag, fromHash, number, text, toHash, word } from './state.mjs';
import { makeTheme } from './theme.mjs';
import { ThreeView } from './three_view.mjs';
import { middleGrey, unroll } from './unroll.mjs';
import { KEYS, View } from './view.mjs';

const get = (id) => document.getElementById(id);
const status = get('status'), bar = get('progress'), error = get('error');
const canvas = get('view'), flat = get('flat');

const say = (sentence) => { status.textContent = sentence; };

function complain(sentence) {
    error.textContent = /[.!]$/.test(sentence) ? sentence : `${sentence}.`;
    error.hidden = false;
}

const engine = new Engine({
    onProgress(stage, fraction) {
        bar.hidden = false;
        bar.value = fraction;
        say(`${stage[0].toUpperCase()}${stage.slice(1)}, ${Math.round(100 * fraction)} %.`);
    },
});
// The browser sets its graphics up for the page's first canvas, and would wait for the stage's shaders later.
get('histogram').getContext('2d', { willReadFrequently: true }).fillRect(0, 0, 1, 1);
let onDrawn = () => {}; // set once the view is there
const [stage, engines] = await Promise.all([
    StageClient.make(canvas, (drawn) => onDrawn(drawn)), engine.engines(),
]).catch((problem) => {
    say('The page cannot start.');
    complain(problem.message);
    throw problem;
});

// ------------------------------------------------------------------------------------------- state

// Name, kind and default of each value that the address may hold. Each scene has defaults of its
// own for camera, material and method.
const SCENES = [...stage.words.scene, 'three', 'check'];
// The scene of the renderer whose balls are shown.
const sceneOf = (scene) => ({ three: 'ibl', check: 'compare' })[scene] ?? scene;
function kindsOf(scene) {
    const own = stage.view(sceneOf(scene)), { words } = stage;
    return {
        source: text('sky'),
        sun: number(30, -5, 90),
        bearing: number(150, -180, 180),
        haze: number(3, 1.7, 10),
        size: number(256, 16, 1024, 0),
        turn: number(0, -180, 180),
        pitch: number(0, -180, 180),
        roll: number(0, -180, 180),
        up: word('y', 'y', 'z', '-z'),
        mirror: flag(false),
        stops: number(0, -16, 16),
        lamps: word('keep', 'keep', 'extract', 'clamp'),
        count: number(1, 1, 16, 0), // largest number of lights that are taken out
        clamp: number(0, 0, 65504), // 0: the baker chooses
        engine: word('three', ...engines.map(({ name }) => name)),
        engineSize: number(0, 0, 2048, 0), // 0: the engine's own
        format: word('auto', 'auto', ...engines.flatMap(({ formats }) => formats)),
        tune: word('auto', 'auto', 'none', 'sharp', 'soft'),
        checkFor: word('', '', ...engines.map(({ name }) => name)), // the engine that the checked file is for
        // index of the level shown in place of the balls; -1 shows the balls
        shown: number(-1, -1, 15, 0),
        scene: word('ibl', ...SCENES),
        method: word(own.method, ...words.method),
        material: word(own.material, ...words.material),
        debug: word('none', ...words.debug, 'error'),
        // relative noise of the reference that the error is measured against
        noise: number(0.05, 0.01, 0.5, 3),
        alone: flag(false), // the reference leaves out light between balls
        azimuth: number(own.azimuth, -3600, 3600),
        elevation: number(own.elevation, -89, 89),
        zoom: number(1, 0.2, 8, 3), // 1: all balls are whole
        distance: number(0, 0, 3000, 1), // of the camera from its target; 0: by the zoom
        fov: number(own.fov, 5, 90, 1),
        split: number(own.split, 0, 1),
        background: number(own.background, 0, 1),
        occlusion: flag(Boolean(own.occlusion)),
        cubeDiffuse: flag(Boolean(own.cubeDiffuse)),
        reflections: word(own.reflections, ...words.reflections),
        ground: flag(Boolean(own.ground)),
        asPrinted: flag(Boolean(own.asPrinted)),
        auto: flag(true),
        samples: number(own.samples, 1, 8, 0),
    };
}

function readAddress() {
    const { scene } = fromHash({ scene: word('ibl', ...SCENES) }, location.hash);
    return fromHash(kindsOf(scene), location.hash);
}

const state = readAddress();
let opened = null; // bytes and name of the opened file; null for the sky
let baked = null, range = null, lit = '';
let lights = []; // taken out of the source, in the form of Baker.sun()

function remember() {
    history.replaceState(null, '', toHash(kindsOf(state.scene), state) || location.pathname);
}

// ------------------------------------------------------------------------------------------ baking

// The name of what is open without its ending, for the names of files and for lines of code.
const stem = () => (opened ? opened.name.replace(/\.[^.]*$/, '').replace(/['"\\`]|\p{Cc}/gu, '_') : 'sky');

const optionsOf = ({ turn, pitch, roll, up, mirror, stops, lamps, count, clamp }) =>
    ({ yaw: turn, pitch, roll, up, mirror, exposure: stops, sun: lamps, lights: count, clamp });

// What names the open file or sky, and what the options do with its place and its lights.
const keyOf = (file) => (file ? file.stamp : [state.sun, state.bearing, state.haze].join());
const placeKey = ({ pitch, roll, up, mirror }) => [pitch, roll, up, mirror].join();
const sunKey = ({ lamps, count, clamp, stops }) =>
    ({ keep: '', extract: `without ${count} lights`, clamp: `at most ${clamp} at ${stops} stops` })[lamps];

function describe(source) {
    const from = `a ${source.shape} of ${source.width} x ${source.height}`;
    const made = `a cube of ${baked.levels[0].size} with ${baked.levels.length} levels`;
    return `${opened ? opened.name : 'The sky'}: from ${from}, ${made} baked in ` +
           `${baked.seconds.toFixed(2)} s. Nothing left this machine.`;
}

function setBusy(busy) {
    document.body.setAttribute('aria-busy', String(busy));
    bar.hidden = true;
    for (const button of get('downloads').children)
        button.disabled = busy || !baked || (button.dataset.needs === 'lights' && state.lamps !== 'extract');
}

// Runs requested work one after the other. Of requests that wait only the newest is run.
let newest = 0, running = Promise.resolve();
function request(work) {
    const mine = ++newest;
    document.body.setAttribute('aria-busy', 'true');
    running = running.then(async () => {
        if (mine !== newest)
            return;
        setBusy(true);
        error.hidden = true;
        try {
            await work();
        } catch (problem) {
            complain(problem.message);
            say(baked ? `${opened ? opened.name : 'The sky'} is still here.` : 'Nothing is baked yet.');
        }
        if (mine === newest)
            setBusy(false);
        refresh();
    });
    return running;
}

// Opens a file, or the sky if `file` is null, and bakes it. On failure the previous bake stays.
const bake = (file) => request(async () => {
    say(`Reading ${file ? file.name : 'the sky'}.`);
    const { size, sun, bearing, haze } = state, options = optionsOf(state);
    const source = file ? await engine.open(file.bytes, file.name)
                        : await engine.sky({ elevation: sun, azimuth: bearing, turbidity: haze });
    await engine.options(options);
    const made = await engine.bake({ size });
    performance.mark('baked');
    const key = [keyOf(file), placeKey(state), sunKey(state), size].join();
    if (stage.problem === '' && key !== lit) {
        const measured = await engine.histogram();
        const taken = await engine.sun(), scenery = await engine.scenery({ size });
        await stage.started;
        if (stage.ready) {
            await stage.upload(scenery);
            await stage.discs(taken);
        }
        [lights, range, lit] = [taken, measured, key];
    }
    baked = made;
    opened = file;
    state.source = file ? file.name : 'sky';
    say(describe(source));
    get('report').textContent = made.notes.map((note) => `${state.source}: ${note}.`).join(' ');
    showLevels();
    showRange();
    remember();
});

// --------------------------------------------------------------------------------- background work

const words = { textbook: '', check: '', truth: '' };
const speak = (who) => (sentence) => {
    words[who] = sentence;
    get('background').textContent = Object.values(words).filter(Boolean).join('; ');
    get('stop').hidden = !get('background').textContent;
};

const sourceKey = () => [keyOf(opened), placeKey(state), sunKey(state)].join();
// Opens what is open here in another worker, with the page's options.
const openWhole = async (worker) => {
    await (opened ? worker.open(opened.bytes, opened.name)
        : worker.sky({ elevation: state.sun, azimuth: state.bearing, turbidity: state.haze }));
    await worker.options(optionsOf(state));
};
const openIn = async (worker) => {
    await openWhole(worker);
    await worker.sun();
};

// The turned source with its lights, for three.js, which takes no lights out.
const openTurned = async (worker) => {
    await openWhole(worker);
    await worker.options({ ...optionsOf(state), sun: 'keep' });
    await worker.sun();
};

// The importance-sampled environment that scene compare shows, with few samples first.
const textbook = new BackgroundWork({
    onWords: speak('textbook'),
    onFailure: (problem) => complain(problem.message),
    async onResult(scenery, _, last) {
        await stage.upload(scenery, true);
        beside = null;
        canvas.dataset.textbook = last ? 'whole' : 'so far';
        view.change();
    },
});

function wantTextbook() {
    if (state.scene !== 'compare' || !baked || stopped.textbook === lit) {
        if (textbook.busy)
            textbook.stop();
        return;
    }
    const { size } = state;
    textbook.start({
        key: lit, source: sourceKey(), open: openIn,
        steps: [16, 64, 256, 1024].map((samples) => ({
            words: `Sampling the right side: ${samples} of 1024 samples for each texel`,
            work: (worker) => worker.scenery({ size, samples }),
        })),
    });
}

// The check of another file, whose levels scene check shows at the right.
let beside = null; // the result whose levels are in the sampled slot of the stage
const checking = new CheckPanel({
    engines, read: () => state, onWords: speak('check'), onChange: (name, value) => change(name, value),
    onFailure: (problem) => complain(problem.message), onResult: () => refresh(),
    onShow: () => change('scene', 'check'),
    source: () => ({ key: baked ? keyOf(opened) : '', open: openWhole }),
});

async function wantBeside() {
    const { result } = checking;
    if (state.scene !== 'check' || !stage.ready || !lit || !result?.scenery || beside === result)
        return;
    beside = result;
    textbook.stop(); // whose levels are replaced
    await stage.upload(structuredClone(result.scenery), true);
    view.change();
}

// The integrated reference, with much noise first, and the view's error against it.
const TRUTH_ROWS = 128;
let wrong = null;
const truth = new BackgroundWork({
    onWords: speak('truth'),
    onFailure: (problem) => complain(problem.message),
    async onResult(integral, { key, seen }, last) {
        wrong = { key, last, noise: integral.noise, ...await stage.error(seen, integral) };
        refresh();
    },
});

// The view whose error is measured, with one ray a pixel and TRUTH_ROWS rows, because integration
// is slow.
function wantedTruth() {
    const box = get('stage'), height = TRUTH_ROWS;
    const width = Math.max(1, Math.round(height * box.clientWidth / Math.max(1, box.clientHeight)));
    const seen = { ...viewOf(width / height), samples: 1 };
    const { noise, alone } = state;
    return { seen, width, height, noise, alone,
             key: [lit, beside && checking.work.key, stage.numbers(seen), width, height, noise, alone].join() };
}

function wantTruth() {
    clearTimeout(wantTruth.timer);
    const wanted = state.debug === 'error' && state.scene !== 'three' && stage.ready && baked ? wantedTruth() : null;
    if (!wanted || wanted.key === stopped.truth) {
        if (truth.busy)
            truth.stop();
        return;
    }
    const { seen, key, noise, ...rest } = wanted;
    const numbers = stage.numbers(seen);
    const noises = [8, 4, 2, 1].map((times) => Math.min(0.5, times * noise));
    wantTruth.timer = setTimeout(() => truth.start({
        key, source: sourceKey(), open: openIn,
        steps: noises.filter((value, i) => value !== noises[i + 1]).map((value) => ({
            key, seen,
            words: `Integrating all light paths until the noise is ${Number(value.toPrecision(2))}` +
                   (value > noise ? `, later ${noise}` : ''),
            work: (worker) => worker.truth({ numbers, ...rest, noise: value }),
        })),
    }), 250);
}

// Keys of the work that the user stopped. Work with such a key is not started again.
const stopped = { textbook: '', truth: '' };
get('stop').onclick = () => {
    if (textbook.busy)
        stopped.textbook = lit;
    if (truth.busy)
        stopped.truth = wantedTruth().key;
    textbook.stop();
    truth.stop();
    checking.stop();
};

function paint({ colours, width, height }) {
    const picture = new ImageData(width, height);
    for (let i = 0; i < width * height; i++) {
        for (let c = 0; c < 3; c++)
            picture.data[4 * i + c] = 255 * colours[3 * i + c];
        picture.data[4 * i + 3] = 255;
    }
    [flat.width, flat.height] = [width, height];
    flat.getContext('2d', { willReadFrequently: true }).putImageData(picture, 0, 0);
}

let stamps = 0;
// The bytes of a file of the user's; nothing, and a sentence, if the file cannot be read.
async function read(file) {
    try {
        return file && { name: file.name, bytes: new Uint8Array(await file.arrayBuffer()), stamp: `file ${++stamps}` };
    } catch (problem) {
        complain(`${file.name}: cannot be read: ${problem.message}`);
        return undefined;
    }
}

// Opens a panorama, and checks another file against the panorama that is open then. Either may be missing.
async function take({ panorama, checked }) {
    const source = await read(panorama), other = await read(checked);
    if (source)
        await bake(source);
    if (other)
        checking.take(other);
}

// ----------------------------------------------------------------------------------------- showing

function showLevels() {
    const list = get('levels'), exposure = middleGrey(baked.harmonics);
    list.replaceChildren(...baked.levels.map((level, k) => {
        const item = document.createElement('li'), button = document.createElement('button');
        const picture = document.createElement('canvas'), words = document.createElement('span');
        const roughness = Number(level.roughness.toFixed(3));
        setTimeout(() => unroll(level, exposure, picture, 112, 56)); // a task of its own
        words.textContent = `${level.size} · r ${roughness}`;
        button.type = 'button';
        button.append(picture, words);
        button.setAttribute('aria-label', `Level ${k}: size ${level.size}, roughness ${roughness}`);
        button.onclick = () => change('shown', state.shown === k ? -1 : k);
        item.append(button);
        return item;
    }));
}

function showRange() {
    get('range').hidden = !range;
    if (range)
        get('brightest').textContent = showHistogram(get('histogram'), range);
}

// The harmonic of degree 0 of the bake and of the lights that were taken out, for each channel. The
// bake's exposure scales its harmonics, but not the numbers of the lights.
function wholeLight() {
    const Y00 = 0.28209479177387814;
    return [0, 1, 2].map((c) => baked.harmonics[c] +
        lights.reduce((sum, light) => sum + Y00 * light[3 + c] * 2 ** state.stops, 0));
}

// The view to draw in a picture whose width is `aspect` times its height: the scene's defaults, the
// state, an exposure that fits the environment, and a distance at which all balls are seen.
function viewOf(aspect = stageAspect()) {
    const fit = state.auto && baked && state.scene !== 'furnace' && state.scene !== 'assignment';
    const exposure = fit ? Math.log2(middleGrey(wholeLight())) + FIT : state.stops;
    const debug = state.debug === 'error' ? 'none' : state.debug;
    const own = stage.view(sceneOf(state.scene));
    const view = { ...own, ...state, scene: sceneOf(state.scene), debug, level: 0, rotation: state.turn, exposure };
    const least = view.scene === 'assignment' && view.fov === own.fov ? own.distance : 0;
    view.distance = state.distance || stage.distance(view, aspect, least) / state.zoom;
    return view;
}
const FIT = 1.5; // stops between the exposure of the level strip and that of the tone-mapped view

function stageAspect() {
    const { clientWidth, clientHeight } = get('stage');
    return Math.max(1, clientWidth) / Math.max(1, clientHeight);
}

// Measures how white the white furnace is, and writes so under the picture.
async function tellFurnace() {
    const { largest, rms } = await stage.furnace(viewOf(2), 512, 256);
    if (state.scene === 'furnace')
        get('note').textContent = `The balls differ from the white background by ${largest.toExponential(1)} at ` +
                                  `most, ${rms.toExponential(1)} on average (RMS)`;
}

function noteOf(error) {
    if (!stage.ready)
        return stage.problem;
    if (error)
        return `Error against the reference, red too bright, blue too dark: ${error.screen.toFixed(1)} of ` +
               `255 RMS, ${error.rms.toPrecision(2)} of the mean light, noise ` +
               `${error.noise.toPrecision(2)}${error.last ? '' : ' so far'}`;
    if (state.scene === 'furnace' && state.debug === 'none')
        tellFurnace().catch((problem) => complain(problem.message));
    if (state.scene === 'three')
        return three.note;
    if (state.scene === 'check')
        return checking.result?.scenery ? `Left of the line exact levels, right of it ${checking.result.name}`
                                        : 'Choose or drop a file to check, and its levels are shown right of the line';
    return state.scene === 'compare' ? 'Left of the line exact levels, right of it levels by random sampling' : '';
}

function refresh() {
    const k = baked ? Math.min(state.shown, baked.levels.length - 1) : -1;
    const showsLevel = baked && (k >= 0 || !stage.ready);
    wantTextbook();
    wantTruth();
    checking.want();
    wantBeside().catch((problem) => complain(problem.message));
    const error = !showsLevel && state.debug === 'error' && baked && wrong?.key === wantedTruth().key
        ? wrong : null;
    flat.hidden = !showsLevel && !error;
    three.show(flat.hidden && state.scene === 'three' && Boolean(baked));
    canvas.hidden = !flat.hidden;
    flat.dataset.error = !error ? '' : error.last ? 'whole' : 'so far';
    flat.setAttribute('aria-label', error ? 'The error of the picture against the reference'
                                          : 'A baked level, unrolled as a panorama');
    if (error)
        paint(error);
    [...get('levels').children].forEach((item, i) => {
        item.firstChild.setAttribute('aria-pressed', String(i === k));
    });
    get('handle').hidden = !flat.hidden || sceneOf(state.scene) !== 'compare';
    get('handle').setAttribute('aria-valuenow', String(Math.round(100 * state.split)));
    if (state.scene !== 'furnace' || showsLevel || error)
        get('note').textContent = showsLevel && stage.ready ? `Level ${k}, unrolled as a panorama` : noteOf(error);
    else
        noteOf(null);
    if (showsLevel)
        unroll(baked.levels[Math.max(k, 0)], middleGrey(baked.harmonics), flat, 640, 320);
    canvas.setAttribute('aria-label', `${NAMES.scene[state.scene]}, ${NAMES.material[state.material]}, ` +
                                      `lost light added by ${NAMES.method[state.method]}, in ${stem()}`);
    canvas.hidden ||= three.shows;
    get('labels').hidden = !flat.hidden || !stage.ready || state.debug.startsWith('table');
    controls.update();
    files.show().catch((problem) => complain(problem.message));
    view.change();
}

// ----------------------------------------------------------------------------------------- changing

const BAKES = ['sun', 'bearing', 'haze', 'size', 'turn', 'pitch', 'roll', 'up', 'mirror', 'stops', 'lamps', 'count', 'clamp'];

// Called after state[name] has changed: bakes again if the bake depends on that value, and
// refreshes.
function changed(name) {
    if (name === 'scene')
        Object.assign(state, ownOf(state.scene));
    remember();
    clearTimeout(changed.timer);
    if (BAKES.includes(name)) {
        const sky = ['sun', 'bearing', 'haze'].includes(name);
        changed.timer = setTimeout(() => bake(sky ? null : opened), 150);
        document.body.setAttribute('aria-busy', 'true');
    }
    refresh();
}

// The scene's defaults for the camera, the material and the method.
function ownOf(scene) {
    const { method, material, azimuth, elevation, split, fov } = stage.view(sceneOf(scene));
    return { method, material, azimuth, elevation, split, fov, zoom: 1, distance: 0, debug: 'none', shown: -1 };
}

function change(name, value) {
    const kind = kindsOf(state.scene)[name];
    state[name] = bounded(kind, value);
    changed(name);
}

function next(name) {
    const words = stage.words[name];
    change(name, words[(words.indexOf(state[name]) + 1) % words.length]);
}

const controls = makeControls(get('controls'), state, stage.words, changed);
const files = new Files({
    engines, read: () => state, onChange: change, onFailure: (problem) => complain(problem.message),
    source: () => ({ key: baked ? [keyOf(opened), ...Object.values(optionsOf(state))].join() : '', stem: stem(),
                     open: openWhole }),
});
const three = new ThreeView({
    box: get('stage'), open: openTurned, engines, key: () => [keyOf(opened), placeKey(state)].join(),
    onFailure: (problem) => complain(problem.message),
    onNote: () => { if (state.scene === 'three') get('note').textContent = three.note; },
});

function draw(width, height) {
    const seen = viewOf(width / height), scene = sceneOf(state.scene);
    get('handle').style.left = `${100 * seen.split}%`;
    showLabels(get('labels'), { ...seen, scene: state.scene }, width / height, stage.ballsOf[scene]);
    if (three.shows)
        stage.balls(seen).then((balls) => three.draw({ ...seen, balls, aspect: width / height }, width, height));
    else if (stage.ready && (lit || scene === 'furnace' || scene === 'assignment'))
        stage.show(seen, width, height);
}
const view = new View({
    canvas, box: get('stage'), draw, read: () => ({ ...state, ...viewOf() }), onChange: change, onNext: next,
    handle: get('handle'), onScene: (index) => change('scene', SCENES[index]),
    onReset: () => change('scene', state.scene),
});

function showKeys() {
    get('keys').hidden = !get('keys').hidden;
    get('help').setAttribute('aria-expanded', String(!get('keys').hidden));
}
get('help').onclick = showKeys;
onDrawn = (how) => {
    get('stage').dataset.drawn = how;
    if (how === 'coarsely' && lit)
        performance.mark('pictured');
};
document.addEventListener('keydown', (event) => {
    if (event.target.closest?.('input, select, textarea') || event.ctrlKey || event.altKey || event.metaKey)
        return;
    if (event.key === '?' || event.key === 'h')
        showKeys();
    else if (event.key === 'Escape' && !get('keys').hidden)
        showKeys();
});
makeTheme(get('theme'), showRange);

get('keys').append(...KEYS.map(([keys, words]) => {
    const line = document.createElement('div'), key = document.createElement('kbd');
    key.textContent = keys;
    line.append(key, words);
    return line;
}));

// ---------------------------------------------------------------------------------------- downloads

// Adds a button that downloads a file; nameOf() gives the file's name and bytesOf(name) its bytes.
// `needs` names a flag of the state without which there is no such file.
function addDownload(label, nameOf, bytesOf, needs = '') {
    const button = document.createElement('button');
    button.dataset.needs = needs;
    button.type = 'button';
    button.disabled = true;
    button.textContent = label;
    button.onclick = async () => {
        try {
            const name = nameOf();
            save(name, await bytesOf(name));
        } catch (problem) {
            complain(problem.message);
        }
    };
    get('downloads').append(button);
}

const addFile = (label, ending, format) =>
    addDownload(label, () => `${stem()}${ending}`, (name) => engine.file(name, format));
const addTable = (label, kind) =>
    addDownload(label, () => `${kind}.ktx2`, (name) => engine.table(name, kind));

addFile('Cube, KTX2', '.ktx2', 'rgba16f');
addFile('Cube, KTX2 of 32 bits', '-32.ktx2', 'rgba32f');
addFile('Cube, DDS', '.dds', 'rgba16f');
addDownload('Irradiance, KTX2', () => `${stem()}-diffuse.ktx2`, (name) => engine.irradiance(name));
addDownload('Lights, JSON', () => `${stem()}-lights.json`, (name) => engine.lights(name), 'lights');
addFile('Harmonics, JSON', '.json');
addFile('Harmonics, C', '.h');
addTable('Table of E', 'e');
addTable('Table of E_avg', 'eavg');
addTable('Table of A, B', 'dfg');

// -------------------------------------------------------------------------------------------- input

get('choose').onclick = () => get('file').click();
get('file').onchange = async () => {
    await take(sortFiles(get('file').files, false));
    get('file').value = '';
};
get('check-choose').onclick = () => get('check-file').click();
get('check-file').onchange = async () => {
    await take(sortFiles(get('check-file').files, true));
    get('check-file').value = '';
};

// Skies to start with, made by kiln's own model of the sky.
const PRESETS = { Morning: { sun: 8, bearing: 120, haze: 3.5 }, Noon: { sun: 62, bearing: 20, haze: 2.5 },
                  Dusk: { sun: -2, bearing: -150, haze: 4 } };
for (const [name, sky] of Object.entries(PRESETS)) {
    const button = document.createElement('button');
    button.type = 'button';
    button.className = name.toLowerCase();
    button.textContent = name;
    button.title = `A clear sky with the sun ${Math.abs(sky.sun)} degrees ${sky.sun < 0 ? 'below' : 'above'} the horizon`;
    button.onclick = () => {
        Object.assign(state, sky);
        bake(null);
    };
    get('presets').append(button);
}
document.addEventListener('dragover', (event) => {
    event.preventDefault();
    document.body.classList.add('dropping');
});
document.addEventListener('dragleave', (event) => {
    if (!event.relatedTarget)
        document.body.classList.remove('dropping');
});
document.addEventListener('drop', (event) => {
    event.preventDefault();
    document.body.classList.remove('dropping');
    if (event.dataTransfer.files.length)
        take(sortFiles(event.dataTransfer.files, Boolean(event.target.closest?.('#check'))));
    else
        complain('The dropped item is not a file.');
});
window.addEventListener('hashchange', () => {
    Object.assign(state, readAddress());
    bake(state.source === 'sky' ? null : opened);
});

stage.started.then(() => refresh());
// The address holds the name of a file but not its bytes, so the message asks for that file.
const wanted = state.source;
await bake(null);
if (wanted !== 'sky')
    complain(`This address names the file ${wanted}, which this page does not have. Drop the file here.`);

// The web page's main module. In: the address, dropped files, controls, keys. Out: the rendered
// view, the strip of baked levels, files to download. A worker (engine.mjs) bakes; stage.mjs draws
// on the canvas; the state is kept in the address.
import { makeControls } from './controls.mjs';
import { Engine } from './engine.mjs';
import { ENGINES } from './engines.mjs';
import { BackgroundWork } from './background.mjs';
import { Stage } from './stage.mjs';
import { bounded, flag, fromHash, number, text, toHash, word } from './state.mjs';
import makeStageModule from './stage.js';
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
const stage = await Stage.make(makeStageModule, '#view');

// ------------------------------------------------------------------------------------------- state

// Name, kind and default of each value that the address may hold. Each scene has defaults of its
// own for camera, material and method.
function kindsOf(scene) {
    const own = stage.defaults(scene), { words } = stage;
    return {
        source: text('sky'),
        sun: number(30, -5, 90),
        bearing: number(150, -180, 180),
        haze: number(3, 1.7, 10),
        size: number(256, 16, 1024, 0),
        turn: number(0, -180, 180),
        stops: number(0, -16, 16),
        light: flag(false), // the strongest light is taken out of the bake and drawn as a disc
        // index of the level shown in place of the balls; -1 shows the balls
        shown: number(-1, -1, 15, 0),
        scene: word('ibl', ...words.scene),
        method: word(own.method, ...words.method),
        material: word(own.material, ...words.material),
        debug: word('none', ...words.debug, 'error'),
        // relative noise of the reference that the error is measured against
        noise: number(0.05, 0.01, 0.5, 3),
        alone: flag(false), // the reference leaves out light between balls
        azimuth: number(own.azimuth, -3600, 3600),
        elevation: number(own.elevation, -89, 89),
        distance: number(own.distance, 60, 3000, 1),
        split: number(own.split, 0, 1),
        background: number(own.background, 0, 1),
        occlusion: flag(Boolean(own.occlusion)),
        cubeDiffuse: flag(Boolean(own.cubeDiffuse)),
        bent: flag(Boolean(own.bent)),
        ground: flag(Boolean(own.ground)),
        asPrinted: flag(Boolean(own.asPrinted)),
        auto: flag(true),
        samples: number(own.samples, 1, 8, 0),
    };
}

function readAddress() {
    const { scene } = fromHash({ scene: word('ibl', ...stage.words.scene) }, location.hash);
    return fromHash(kindsOf(scene), location.hash);
}

const state = readAddress();
let opened = null; // bytes and name of the opened file; null for the sky
let baked = null, lit = '';
let lights = []; // taken out of the source, in the form of Baker.extract()

function remember() {
    history.replaceState(null, '', toHash(kindsOf(state.scene), state) || location.pathname);
}

// ------------------------------------------------------------------------------------------ baking

const stem = () => (opened ? opened.name.replace(/\.[^.]*$/, '') : 'sky');

function describe(source) {
    const from = `a ${source.shape} of ${source.width} x ${source.height}`;
    const made = `a cube of ${baked.levels[0].size} with ${baked.levels.length} levels`;
    return `${opened ? opened.name : 'The sky'}: from ${from}, ${made} baked in ` +
           `${baked.seconds.toFixed(2)} s here (${baked.cpu}). Nothing left this machine.`;
}

function setBusy(busy) {
    document.body.setAttribute('aria-busy', String(busy));
    bar.hidden = true;
    for (const button of get('downloads').children)
        button.disabled = busy || !baked || (button.dataset.needs === 'light' && !state.light);
    get('code').hidden = !state.light || !baked;
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
    const { size, sun, bearing, haze } = state;
    const source = file ? await engine.open(file.bytes, file.name)
                        : await engine.sky({ elevation: sun, azimuth: bearing, turbidity: haze });
    const extract = state.light;
    const made = await engine.bake({ size, rotation: state.turn, exposure: state.stops, extract });
    const key = [file ? file.stamp : [sun, bearing, haze], size, extract].join();
    const taken = extract ? await engine.extract() : { lights: [], words: '' };
    if (stage.ready && key !== lit) {
        stage.light(await engine.scenery({ size }));
        stage.discs(taken.lights);
        lit = key;
    }
    if (taken.words)
        made.notes.push(taken.words);
    baked = made;
    lights = taken.lights;
    opened = file;
    state.source = file ? file.name : 'sky';
    say(describe(source));
    get('report').textContent = made.notes.map((note) => `${state.source}: ${note}.`).join(' ');
    showLevels();
    remember();
});

// --------------------------------------------------------------------------------- background work

const words = { textbook: '', truth: '' };
const speak = (who) => (sentence) => {
    words[who] = sentence;
    get('background').textContent = Object.values(words).filter(Boolean).join('; ');
    get('stop').hidden = !get('background').textContent;
};

const sourceKey = () =>
    [opened ? opened.stamp : [state.sun, state.bearing, state.haze], state.light].join();
const openIn = async (worker) => {
    await (opened ? worker.open(opened.bytes, opened.name)
        : worker.sky({ elevation: state.sun, azimuth: state.bearing, turbidity: state.haze }));
    if (state.light)
        await worker.extract();
};

// The importance-sampled environment that scene compare shows, with few samples first.
const textbook = new BackgroundWork({
    onWords: speak('textbook'),
    onFailure: (problem) => complain(problem.message),
    onResult(scenery, _, last) {
        stage.light(scenery, true);
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
            words: `The textbook bakes the right side: ${samples} of its 1024 samples for each texel`,
            work: (worker) => worker.scenery({ size, samples }),
        })),
    });
}

// The integrated reference, with much noise first, and the view's error against it.
const TRUTH_ROWS = 128;
let wrong = null;
const truth = new BackgroundWork({
    onWords: speak('truth'),
    onFailure: (problem) => complain(problem.message),
    onResult(integral, { key, seen }, last) {
        wrong = { key, last, noise: integral.noise, ...stage.error(seen, integral) };
        refresh();
    },
});

// The view whose error is measured, with one ray a pixel and TRUTH_ROWS rows, because integration
// is slow.
function wantedTruth() {
    const box = get('stage'), height = TRUTH_ROWS;
    const width = Math.max(1, Math.round(height * box.clientWidth / Math.max(1, box.clientHeight)));
    const seen = { ...viewOf(), samples: 1 };
    const { noise, alone } = state;
    return { seen, width, height, noise, alone,
             key: [lit, stage.numbers(seen), width, height, noise, alone].join() };
}

function wantTruth() {
    clearTimeout(wantTruth.timer);
    const wanted = state.debug === 'error' && stage.ready && baked ? wantedTruth() : null;
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
};

function paint({ colours, width, height }) {
    const picture = new ImageData(width, height);
    for (let i = 0; i < width * height; i++) {
        for (let c = 0; c < 3; c++)
            picture.data[4 * i + c] = 255 * colours[3 * i + c];
        picture.data[4 * i + 3] = 255;
    }
    [flat.width, flat.height] = [width, height];
    flat.getContext('2d').putImageData(picture, 0, 0);
}

let stamps = 0;
async function take(file) {
    if (!file)
        return;
    let bytes;
    try {
        bytes = new Uint8Array(await file.arrayBuffer());
    } catch (problem) {
        complain(`${file.name}: cannot be read: ${problem.message}`);
        return;
    }
    await bake({ name: file.name, bytes, stamp: `file ${++stamps}` });
}

// ----------------------------------------------------------------------------------------- showing

function showLevels() {
    const list = get('levels'), exposure = middleGrey(baked.harmonics);
    list.replaceChildren(...baked.levels.map((level, k) => {
        const item = document.createElement('li'), button = document.createElement('button');
        const picture = document.createElement('canvas'), words = document.createElement('span');
        const roughness = Number(level.roughness.toFixed(3));
        unroll(level, exposure, picture, 112, 56);
        words.textContent = `${level.size} · r ${roughness}`;
        button.type = 'button';
        button.append(picture, words);
        button.setAttribute('aria-label', `Level ${k}: size ${level.size}, roughness ${roughness}`);
        button.onclick = () => change('shown', state.shown === k ? -1 : k);
        item.append(button);
        return item;
    }));
}

// The harmonic of degree 0 of the bake and of the lights that were taken out, for each channel. The
// bake's exposure scales its harmonics, but not the numbers of the lights.
function wholeLight() {
    const Y00 = 0.28209479177387814;
    return [0, 1, 2].map((c) => baked.harmonics[c] +
        lights.reduce((sum, light) => sum + Y00 * light[3 + c] * 2 ** state.stops, 0));
}

// The view to draw: the scene's defaults, the state, and an exposure that fits the environment.
function viewOf() {
    const fit = state.auto && baked && state.scene !== 'furnace' && state.scene !== 'assignment';
    const exposure = fit ? Math.log2(middleGrey(wholeLight())) + FIT : state.stops;
    const debug = state.debug === 'error' ? 'none' : state.debug;
    return { ...stage.defaults(state.scene), ...state, debug, level: 0, rotation: state.turn, exposure };
}
const FIT = 1.5; // stops between the exposure of the level strip and that of the tone-mapped view

function noteOf(error) {
    if (!stage.ready)
        return stage.problem;
    if (error)
        return `Error against the reference, red too bright, blue too dark: ${error.screen.toFixed(1)} of ` +
               `255 RMS, ${error.rms.toPrecision(2)} of the mean light, noise ` +
               `${error.noise.toPrecision(2)}${error.last ? '' : ' so far'}`;
    if (state.scene === 'furnace') {
        const { largest, rms } = stage.furnace(viewOf(), 512, 256);
        return `Furnace: the balls differ from the background by ${largest.toExponential(1)} at most, ` +
               `${rms.toExponential(1)} RMS`;
    }
    return state.scene === 'compare' ? 'Left of the line the exact bake, right of it the textbook\'s bake' : '';
}

function refresh() {
    const k = baked ? Math.min(state.shown, baked.levels.length - 1) : -1;
    const showsLevel = baked && (k >= 0 || !stage.ready);
    wantTextbook();
    wantTruth();
    const error = !showsLevel && state.debug === 'error' && baked && wrong?.key === wantedTruth().key
        ? wrong : null;
    flat.hidden = !showsLevel && !error;
    canvas.hidden = !flat.hidden;
    flat.dataset.error = !error ? '' : error.last ? 'whole' : 'so far';
    flat.setAttribute('aria-label', error ? 'The error of the picture against the reference'
                                          : 'A baked level, unrolled as a panorama');
    if (error)
        paint(error);
    [...get('levels').children].forEach((item, i) => {
        item.firstChild.setAttribute('aria-pressed', String(i === k));
    });
    get('handle').hidden = !flat.hidden || state.scene !== 'compare';
    get('handle').setAttribute('aria-valuenow', String(Math.round(100 * state.split)));
    try {
        get('note').textContent = showsLevel && stage.ready ? `Level ${k}, unrolled as a panorama` : noteOf(error);
    } catch (problem) {
        get('note').textContent = problem.message;
    }
    if (showsLevel)
        unroll(baked.levels[Math.max(k, 0)], middleGrey(baked.harmonics), flat, 1024, 512);
    canvas.setAttribute('aria-label', `Scene ${state.scene}, ${state.material}, ${state.method}, ` +
                                      `in ${stem()}`);
    controls.update();
    view.change();
}

// ----------------------------------------------------------------------------------------- changing

const BAKES = ['sun', 'bearing', 'haze', 'size', 'turn', 'stops', 'light'];

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
    const { method, material, azimuth, elevation, distance, split } = stage.defaults(scene);
    return { method, material, azimuth, elevation, distance, split, debug: 'none', shown: -1 };
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

const controls = makeControls(get('controls'), state, stage.ready ? stage.words : null, changed);
const view = new View({
    canvas, stage, read: viewOf, onChange: change, onNext: next, handle: get('handle'),
    onScene: (index) => change('scene', stage.words.scene[index]),
    onReset: () => change('scene', state.scene),
    onKeys: () => { get('keys').hidden = !get('keys').hidden; },
});

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
            const name = nameOf(), bytes = await bytesOf(name);
            const link = document.createElement('a');
            link.href = URL.createObjectURL(new Blob([bytes]));
            link.download = name;
            link.click();
            setTimeout(() => URL.revokeObjectURL(link.href), 10000);
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
addDownload('Lights, JSON', () => `${stem()}-lights.json`, (name) => engine.lights(name), 'light');
addFile('Harmonics, JSON', '.json');
addFile('Harmonics, C', '.h');
addTable('Table of E', 'e');
addTable('Table of E_avg', 'eavg');
addTable('Table of A, B', 'dfg');

// ------------------------------------------------------------------------------------------- code

// Shows the lines of code for the chosen engine, which the build takes out of the engine's documentation.
async function showLines() {
    const name = get('engine').value, answer = await fetch(`lights/${name}.txt`);
    if (name === get('engine').value)
        get('lines').textContent = answer.ok ? await answer.text() : `lights/${name}.txt is not there.`;
}

get('engine').append(...ENGINES.map(([name, title]) => new Option(title, name)));
get('engine').onchange = showLines;
get('copy').onclick = async () => {
    try {
        await navigator.clipboard.writeText(get('lines').textContent);
    } catch (problem) {
        complain(`The lines could not be copied: ${problem.message}`);
    }
};
showLines();

// -------------------------------------------------------------------------------------------- input

get('choose').onclick = () => get('file').click();
get('file').onchange = async () => {
    await take(get('file').files[0]);
    get('file').value = '';
};
get('sky').onclick = () => bake(null);
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
        take(event.dataTransfer.files[0]);
    else
        complain('The dropped item is not a file.');
});
window.addEventListener('hashchange', () => {
    Object.assign(state, readAddress());
    bake(state.source === 'sky' ? null : opened);
});

// The address holds the name of a file but not its bytes, so the message asks for that file.
const wanted = state.source;
await bake(null);
if (wanted !== 'sky')
    complain(`This address names the file ${wanted}, which this page does not have. Drop the file here.`);

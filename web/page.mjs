// The page: takes a panorama, has it baked, shows and hands out what comes of it.
import GUI from './lil-gui.mjs';
import { Engine } from './engine.mjs';
import { flag, fromHash, number, text, toHash, word } from './state.mjs';
import { middleGrey, unroll } from './unroll.mjs';

const KINDS = {
    source: text('sky'),
    elevation: number(30, -5, 90),
    azimuth: number(0, -180, 180),
    turbidity: number(3, 1.7, 10),
    size: number(256, 16, 1024, 0),
    turn: number(0, -180, 180),
    stops: number(0, -16, 16),
    level: number(0, 0, 15, 0),
};

const get = (id) => document.getElementById(id);
const status = get('status'), bar = get('progress'), error = get('error');

const state = fromHash(KINDS, location.hash);
let opened = null; // the file's own bytes and name; null for the sky
let baked = null;

function say(sentence) {
    status.textContent = sentence;
}

function complain(sentence) {
    error.textContent = sentence;
    error.hidden = false;
}

const engine = new Engine({
    onProgress(stage, fraction) {
        bar.hidden = false;
        bar.value = fraction;
        say(`${stage[0].toUpperCase()}${stage.slice(1)}, ${Math.round(100 * fraction)} %.`);
    },
});

// ------------------------------------------------------------------------------------------ baking

const stem = () => (opened ? opened.name.replace(/\.[^.]*$/, '') : 'sky');
const bakeOptions = () => ({ size: state.size, rotation: state.turn, exposure: state.stops });

function describe(source) {
    const from = `a ${source.shape} of ${source.width} x ${source.height}`;
    const made = `a cube of ${baked.levels[0].size} with ${baked.levels.length} levels`;
    return `${opened ? opened.name : 'The sky'}: from ${from}, ${made} baked in ` +
           `${baked.seconds.toFixed(2)} s here (${baked.cpu}). Nothing left this machine.`;
}

function setBusy(busy) {
    document.body.setAttribute('aria-busy', String(busy));
    for (const button of get('downloads').children)
        button.disabled = busy || !baked;
}

// Takes a file, or the sky where there is none, and bakes it. What was shown before stays where
// that fails. Of several wishes at once the last counts.
let wish = 0, running = Promise.resolve();
function bakeSoon(file) {
    const mine = ++wish;
    running = running.then(() => (mine === wish ? bakeNow(file) : undefined));
    return running;
}

async function bakeNow(file) {
    error.hidden = true;
    setBusy(true);
    try {
        say(`Reading ${file ? file.name : 'the sky'}.`);
        const source = file ? await engine.open(file.bytes, file.name)
                            : await engine.sky({ elevation: state.elevation, azimuth: state.azimuth,
                                                 turbidity: state.turbidity });
        baked = await engine.bake(bakeOptions());
        opened = file;
        state.source = file ? file.name : 'sky';
        say(describe(source));
        showLevels();
        remember();
    } catch (problem) {
        complain(`${problem.message}${/[.!]$/.test(problem.message) ? '' : '.'}`);
        say(baked ? `${stem()} is still here.` : 'Nothing is baked yet.');
    }
    bar.hidden = true;
    setBusy(false);
    refresh();
}

async function take(file) {
    if (!file)
        return;
    try {
        await bakeSoon({ name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) });
    } catch (problem) {
        complain(`${file.name}: cannot be read: ${problem.message}.`);
    }
}

// ----------------------------------------------------------------------------------------- showing

function showLevels() {
    const list = get('levels'), exposure = middleGrey(baked.harmonics);
    list.replaceChildren(...baked.levels.map((level, k) => {
        const item = document.createElement('li'), button = document.createElement('button');
        const picture = document.createElement('canvas'), words = document.createElement('span');
        unroll(level, exposure, picture, 112, 56);
        words.textContent = `${level.size} · roughness ${Number(level.roughness.toFixed(3))}`;
        button.type = 'button';
        button.append(picture, words);
        button.setAttribute('aria-label', `Level ${k}: size ${level.size}, roughness ` +
                                          `${Number(level.roughness.toFixed(3))}`);
        button.onclick = () => {
            state.level = k;
            refresh();
            remember();
        };
        item.append(button);
        return item;
    }));
}

function refresh() {
    if (!baked)
        return;
    const k = Math.min(state.level, baked.levels.length - 1);
    [...get('levels').children].forEach((item, i) => {
        item.firstChild.setAttribute('aria-pressed', String(i === k));
    });
    unroll(baked.levels[k], middleGrey(baked.harmonics), get('view'), 1024, 512);
    get('view').setAttribute('aria-label', `Level ${k} of ${stem()}, unrolled as a panorama`);
}

function remember() {
    history.replaceState(null, '', toHash(KINDS, state) || location.pathname);
}

// ----------------------------------------------------------------------------------------- handing out

function addDownload(label, name, format) {
    const button = document.createElement('button');
    button.type = 'button';
    button.disabled = true;
    button.textContent = label;
    button.onclick = async () => {
        try {
            const bytes = await engine.file(`${stem()}${name}`, format);
            const link = document.createElement('a');
            link.href = URL.createObjectURL(new Blob([bytes]));
            link.download = `${stem()}${name}`;
            link.click();
            setTimeout(() => URL.revokeObjectURL(link.href), 10000);
        } catch (problem) {
            complain(problem.message);
        }
    };
    get('downloads').append(button);
}

addDownload('Cube, KTX2', '.ktx2', 'rgba16f');
addDownload('Cube, KTX2 of 32 bits', '-32.ktx2', 'rgba32f');
addDownload('Cube, DDS', '.dds', 'rgba16f');
addDownload('Harmonics, JSON', '.json');
addDownload('Harmonics, C', '.h');

// ---------------------------------------------------------------------------------------- controls

const gui = new GUI({ container: get('controls'), title: 'Controls', injectStyles: false });
const sky = gui.addFolder('Sky'), cube = gui.addFolder('Bake');

function again() {
    remember();
    clearTimeout(again.timer);
    again.timer = setTimeout(() => bakeSoon(opened), 150);
}

function skyAgain() {
    opened = null;
    again();
}

sky.add(state, 'elevation', -5, 90, 0.5).name('sun, degrees up').onChange(skyAgain);
sky.add(state, 'azimuth', -180, 180, 1).name('sun, degrees right').onChange(skyAgain);
sky.add(state, 'turbidity', 1.7, 10, 0.1).name('haze').onChange(skyAgain);
cube.add(state, 'size', [16, 32, 64, 128, 256, 512, 1024]).name('face, texels').onChange(again);
cube.add(state, 'turn', -180, 180, 1).name('turn, degrees').onChange(again);
cube.add(state, 'stops', -16, 16, 0.5).name('exposure, stops').onChange(again);

get('choose').onclick = () => get('file').click();
get('file').onchange = async () => {
    await take(get('file').files[0]);
    get('file').value = '';
};
get('sky').onclick = () => bakeSoon(null);

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
        complain('What was dropped is no file.');
});
window.addEventListener('hashchange', () => {
    Object.assign(state, fromHash(KINDS, location.hash));
    gui.controllersRecursive().forEach((controller) => controller.updateDisplay());
    bakeSoon(state.source === 'sky' ? null : opened);
});

// An address cannot hold a file: it says which one to drop.
const wanted = state.source;
await bakeSoon(null);
if (wanted !== 'sky')
    complain(`This address shows ${wanted}, which is on somebody's disk: drop it here.`);

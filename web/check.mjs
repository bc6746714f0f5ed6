// The panel that checks a file of any tool against the open panorama: the user drops or chooses the file, and reads
// what is right and wrong with the file in words, in numbers for each level, and as a picture of the differences.
// The balls show the file's levels beside kiln's.
import { BackgroundWork } from './background.mjs';

const get = (id) => document.getElementById(id);
const TOLERANCE = 0.01; // largest relative error of a right file, as that of the command

// Endings of files that hold no panorama.
const BAKED = /\.(env|glb|json|txt|h)$/i;
const PICTURE = /\.(exr|hdr|png|jpe?g)$/i;

// Sorts dropped files into the panorama and the file to check, either of which may be missing. `there` says whether
// the files were dropped on the panel.
export function sortFiles(files, there) {
    const list = [...files];
    if (list.length > 1) {
        const panorama = list.find(({ name }) => PICTURE.test(name)) ?? list.find(({ name }) => !BAKED.test(name));
        return { panorama, checked: list.find((file) => file !== panorama) };
    }
    return there || BAKED.test(list[0]?.name) ? { checked: list[0] } : { panorama: list[0] };
}

const percent = (value) => (value !== 0 && Math.abs(value) < 5e-7 ? `${value < 0 ? 'above −' : 'below '}0.0001 %`
                                                                  : `${Number((100 * value).toPrecision(3))} %`);
const COLUMNS = [
    ['Level', 'Number of the level; level 0 is the mirror', (_, k) => k],
    ['Size', 'Texels along an edge of a face', ({ size }) => size],
    ['Roughness', 'The roughness with whose exact level the level is compared', ({ roughness }) => roughness.toFixed(3)],
    ['Like', 'The roughness whose exact level is most like the level', ({ found }) => (found < 0 ? '–' : found.toFixed(3))],
    ['Error', 'Root mean square difference from the exact level, relative to the root mean square of that',
     ({ rms }) => percent(rms)],
    ['Largest', 'Largest difference, relative to the same', ({ largest }) => percent(largest)],
    ['Mean', 'Mean difference, relative to the mean of the exact level', ({ bias }) => percent(bias)],
];

function row(cells, kind, titles = []) {
    const made = document.createElement('tr');
    made.append(...cells.map((words, i) => {
        const cell = document.createElement(kind);
        cell.textContent = words;
        cell.title = titles[i] ?? '';
        return cell;
    }));
    return made;
}

// One sentence that says whether the file is right.
function verdictOf({ name, checks, worst, bands, harmonics, findings }) {
    const faults = findings.filter(({ fault }) => fault).length;
    const right = !faults && worst <= TOLERANCE && harmonics <= TOLERANCE;
    const errors = [checks.length ? `the largest error of a level is ${percent(worst)}` : '',
                    bands.length ? `harmonics err by ${percent(harmonics)}` : ''].filter(Boolean).join(', ');
    return { right, text: `${name} is ${right ? 'right' : 'wrong'}: ${errors}.` };
}

export class CheckPanel {
    // read() gives the page's state, source() gives { key, open } as for Files. onChange(name, value) is called for a
    // changed choice, onWords(sentence) for progress, onResult() when `result` has changed, and onShow() when the
    // user wants to see the file on the balls.
    constructor({ engines, read, source, onChange, onWords, onFailure, onResult, onShow }) {
        Object.assign(this, { engines, read, source, onResult, file: null, result: null });
        this.work = new BackgroundWork({
            onWords,
            onFailure: (problem) => {
                this.file = null; // the same file is not tried again
                this.show();
                onFailure(problem);
            },
            onResult: (result) => {
                this.result = result;
                this.show();
                onResult();
            },
        });
        get('check-engine').append(new Option('What it states, or found out', ''),
                                   ...engines.map(({ name, title }) => new Option(title, name)));
        get('check-engine').onchange = () => onChange('checkFor', get('check-engine').value);
        get('check-balls').onclick = onShow;
    }

    // Checks a file { name, bytes, stamp } as soon as a panorama is open.
    take(file) {
        this.file = file;
        this.want();
    }

    // Forgets the file if its check runs still.
    stop() {
        if (!this.work.busy)
            return;
        this.work.stop();
        this.file = null;
    }

    // Starts the check of the file, unless that runs or is done for the open panorama.
    want() {
        const { key, open } = this.source(), { file } = this, name = this.read().checkFor;
        get('check-engine').value = name;
        if (!file || !key)
            return;
        const engine = this.engines.findIndex((each) => each.name === name);
        const wanted = [key, file.stamp, name].join();
        if (wanted !== this.work.key)
            this.result = null;
        this.work.start({ key: wanted, source: key, open, steps: [{
            words: `Checking ${file.name}`,
            work: (worker) => worker.check(file.bytes, file.name, engine),
        }] });
    }

    show() {
        const { result } = this;
        get('check-report').hidden = !result;
        if (!result)
            return;
        const { right, text } = verdictOf(result);
        get('check-verdict').textContent = text;
        get('check-verdict').classList.toggle('wrong', !right);
        get('check-findings').replaceChildren(...result.findings.map((finding) => {
            const item = document.createElement('li');
            const text = finding.harmonic && result.checks.length ? `harmonics: ${finding.text}` : finding.text;
            item.textContent = `${text[0].toUpperCase()}${text.slice(1)}.`;
            item.className = finding.fault ? 'wrong' : '';
            return item;
        }));
        for (const id of ['check-balls', 'check-table', 'check-picture'])
            get(id).hidden = !result.checks.length;
        get('check-levels').replaceChildren();
        if (!result.checks.length)
            return;
        get('check-levels').append(
            row(COLUMNS.map(([title]) => title), 'th', COLUMNS.map(([, sentence]) => sentence)),
            ...result.checks.map((level, k) => row(COLUMNS.map(([, , of]) => of(level, k)), 'td')));
        this.paint(result.picture);
    }

    // The picture has one panorama for each level, one below the other.
    paint({ colours, width, height, count }) {
        get('check-canvases').replaceChildren(...Array.from({ length: count }, (_, k) => {
            const canvas = document.createElement('canvas'), picture = new ImageData(width, height);
            for (let i = 0, from = 3 * width * height * k; i < width * height; i++, from += 3)
                picture.data.set([...colours.subarray(from, from + 3)].map((value) => Math.round(255 * value)).concat(255), 4 * i);
            Object.assign(canvas, { width, height });
            canvas.getContext('2d').putImageData(picture, 0, 0);
            canvas.title = `Level ${k}`;
            return canvas;
        }));
    }
}

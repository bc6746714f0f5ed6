// bake() and kiln() on workers. index.mjs and node.mjs say how a module is loaded and a worker is started.
import { engines } from './engines.mjs';
import { plain } from './memory.mjs';

const SPECIAL = new Set(['name', 'output', 'onProgress', 'signal', 'json']);
const REFUSED = ['help', 'verbose']; // what these print would take the report's place
const HARMONICS = 'kiln-harmonics.json'; // where the command writes them, unless an option says where

// ------------------------------------------------------------------------------------------- input

const isPicture = (input) => ArrayBuffer.isView(input?.data) && 'width' in input;

// A DDS file of a flat picture of floats (DXGI_FORMAT_R32G32B32_FLOAT or R32G32B32A32_FLOAT).
function ddsOf({ data, width, height }) {
    const channels = data.length / (width * height);
    if (!(width > 0 && height > 0 && Number.isInteger(width) && Number.isInteger(height)))
        throw new TypeError(`kiln-ibl: a picture of ${width} x ${height} texels has no texels`);
    if (!(data instanceof Float32Array) || (channels !== 3 && channels !== 4))
        throw new TypeError(`kiln-ibl: a picture of ${width} x ${height} texels needs a Float32Array of ` +
            `${3 * width * height} or ${4 * width * height} numbers`);
    const file = new ArrayBuffer(148 + data.byteLength), view = new DataView(file);
    const fields = [[0, 0x20534444], [4, 124], [8, 0x1007], [12, height], [16, width], [76, 32], [80, 4],
        [84, 0x30315844], [108, 0x1000], [128, channels === 3 ? 6 : 2], [132, 3], [140, 1]];
    for (const [at, value] of fields)
        view.setUint32(at, value, true);
    new Uint8Array(file, 148).set(new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
    return new Uint8Array(file);
}

async function bytesOf(input) {
    if (isPicture(input))
        return ddsOf(input);
    if (typeof Blob !== 'undefined' && input instanceof Blob)
        input = await input.arrayBuffer();
    if (input instanceof ArrayBuffer)
        return new Uint8Array(input);
    if (ArrayBuffer.isView(input))
        return new Uint8Array(input.buffer, input.byteOffset, input.byteLength);
    throw new TypeError('kiln-ibl: the input is neither bytes nor a picture { data, width, height }');
}

// A name that the command does not take for an option or for standard input.
const harmless = (name) => (name.startsWith('-') ? `./${name}` : name);

// The input as files: one, or the six faces of a cube, which name themselves.
async function filesOf(input, name) {
    if (name !== undefined && (typeof name !== 'string' || name === ''))
        throw new TypeError(`kiln-ibl: the option name must be a text that is not empty, not ${JSON.stringify(name)}`);
    const files = Array.isArray(input) ? input : [{ name: name ?? 'input', bytes: input }];
    if (files.length === 0 || files.some((file) => typeof file?.name !== 'string' || file.name === ''))
        throw new TypeError('kiln-ibl: an array as the input must hold the six faces of a cube as { name, bytes }');
    return Promise.all(files.map(async (file) => ({ name: harmless(file.name), bytes: await bytesOf(file.bytes) })));
}

// ----------------------------------------------------------------------------------------- options

const dashed = (name) => name.replace(/[A-Z]/g, (letter) => `-${letter.toLowerCase()}`);

function wordsOf(options) {
    const words = [], refused = REFUSED.find((name) => options[name]);
    if (refused)
        throw new TypeError(`kiln-ibl: bake() has no option ${refused}; call kiln(['bake', '--${refused}'])`);
    for (const [name, value] of Object.entries(options)) {
        if (SPECIAL.has(name) || value === undefined || value === null || value === false)
            continue;
        const text = Array.isArray(value) || ArrayBuffer.isView(value) ? value.join(',') : String(value);
        words.push(value === true ? `--${dashed(name)}` : `--${dashed(name)}=${text}`);
    }
    return words;
}

// The output's name where the caller gives none: the input's without its folder and ending, and the ending of the
// engine's file in this format. An engine of several files has no ending: the command adds to the name.
function outputOf(name, engineName, format) {
    const engine = engines.find((each) => each.name === engineName);
    const last = name.slice(name.lastIndexOf('/') + 1), dot = last.lastIndexOf('.');
    const ending = engine ? engine.endings[engine.formats.indexOf(format)] ?? engine.ending : 'ktx2';
    return ((dot > 0 ? last.slice(0, dot) : last) || 'output') + (ending && `.${ending}`);
}

// ------------------------------------------------------------------------------------------ errors

const MOST_SIZE = 2048; // largest power of two whose cube with all levels fits into a module's 4 GB as half floats

// What the command cannot know: its ranges of sizes are those of machines with more memory.
function adviceOf({ size, irradianceSize }) {
    return Math.max(Number(size) || 0, Number(irradianceSize) || 0) > 32768
        ? `; in WebAssembly's 4 GB of memory, cubes of up to ${MOST_SIZE} fit` : '';
}

// The command's own sentence, without "kiln: " and without the hint at --help.
function failureOf({ code, stderr }, options) {
    const said = stderr.split('\n').filter((line) => /^kiln: (?!warning: |note: )/.test(line));
    const message = said[said.length - 1]?.slice('kiln: '.length) ?? `the command ended with the code ${code}`;
    return Object.assign(new Error(message + adviceOf(options)), { name: 'KilnError', exitCode: code, stderr });
}

const reasonOf = (signal) => signal.reason ?? Object.assign(new Error('the work was stopped'), { name: 'AbortError' });

// ---------------------------------------------------------------------------------------- functions

// `loadModule` returns a promise of the compiled module. `startWorker` returns an object with the functions
// post(message, buffers), listen(onMessage, onError), end() and rest(), which lets the program end meanwhile.
export function makeApi(loadModule, startWorker) {
    const MOST_IDLE = 2;
    const idle = [];
    let loaded;

    function load() {
        loaded ??= loadModule();
        loaded.catch(() => {
            loaded = undefined; // the next call tries again
        });
        return loaded;
    }

    // Throws a sentence for arguments that would fail later, where nobody could catch the error.
    function check(words, { files, onProgress, signal }) {
        if (!Array.isArray(words))
            throw new TypeError(`kiln-ibl: kiln() takes an array of words, such as ['info', 'city.exr']`);
        if (!Array.isArray(files))
            throw new TypeError('kiln-ibl: the option files must be an array of { name, bytes }');
        if (onProgress && typeof onProgress !== 'function')
            throw new TypeError('kiln-ibl: the option onProgress must be a function');
        if (signal && typeof signal.addEventListener !== 'function')
            throw new TypeError('kiln-ibl: the option signal must be an AbortSignal');
    }

    async function kiln(words, options) {
        const { files = [], input, onProgress, signal } = options ?? {};
        check(words, { files, onProgress, signal });
        if (signal?.aborted)
            throw reasonOf(signal);
        const module = await load();
        if (signal?.aborted)
            throw reasonOf(signal);
        const worker = idle.pop() ?? startWorker();
        return new Promise((resolve, reject) => {
            // A worker that was stopped or has failed is not used again.
            const finish = (settle, value, good) => {
                signal?.removeEventListener('abort', stop);
                if (good && idle.length < MOST_IDLE) {
                    worker.rest();
                    idle.push(worker);
                } else {
                    worker.end();
                }
                settle(value);
            };
            const stop = () => finish(reject, reasonOf(signal), false);
            signal?.addEventListener('abort', stop);
            // An error that onProgress throws ends the work, and the promise is rejected with the error.
            const tell = (progress) => {
                try {
                    onProgress?.(...progress);
                } catch (error) {
                    finish(reject, error, false);
                }
            };
            worker.listen(({ progress, done, error }) => {
                if (progress)
                    tell(progress);
                else if (done)
                    finish(resolve, done, true);
                else
                    finish(reject, new Error(error), false);
            }, (error) => finish(reject, error, false));
            worker.post({ module, words: words.map(String), files, input });
        });
    }

    async function bake(input, options) {
        options ??= {};
        const named = await filesOf(input, options.name);
        const output = harmless(options.output ?? outputOf(options.name ?? named[0].name, options.for, options.format));
        const words = ['bake', ...named.map(({ name }) => name), '--output', output, ...wordsOf(options), '--json'];
        if (!options.sh)
            words.push('--sh', HARMONICS);
        const result = await kiln(words, { ...options, files: named });
        if (result.code !== 0)
            throw failureOf(result, options);
        const report = JSON.parse(new TextDecoder().decode(result.stdout));
        const text = result.files.find(({ name }) => name === plain(options.sh ?? HARMONICS));
        if (!options.sh) { // the caller did not ask for this file
            delete report.output.sh;
            report.output.file_count--;
        }
        return {
            files: result.files.filter(({ name }) => name !== HARMONICS),
            levels: report.output.levels,
            sh: text?.name.endsWith('.json') ? JSON.parse(new TextDecoder().decode(text.bytes)) : null,
            lights: report.lights ?? [],
            report,
        };
    }

    return { bake, kiln };
}

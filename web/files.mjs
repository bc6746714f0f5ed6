// The panel for downloads: the user chooses an engine, sees the lines of code that load the engine's files, and
// presses a button that bakes the files in a worker and downloads them.
import { Engine } from './engine.mjs';
import { linesOf, named } from './lines.mjs';
import { zip } from './zip.mjs';

const get = (id) => document.getElementById(id);

// Hands bytes to the browser as a download.
export function save(name, bytes) {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([bytes]));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

async function textOf(path) {
    const answer = await fetch(path);
    if (!answer.ok)
        throw new Error(`${path} is not there: the server answers ${answer.status}`);
    return answer.text();
}

const size = (bytes) => (bytes < 1e4 ? `${bytes} bytes` : bytes < 1e6 ? `${Math.round(bytes / 1e3)} kB`
                                                                       : `${(bytes / 1e6).toFixed(1)} MB`);

const TUNES = { auto: 'As recommended', none: 'Exact', sharp: 'Tuned, mirror stays sharp', soft: 'Tuned, mirror may blur' };

export class Files {
    // `engines` is Baker.engines(). read() gives the page's state, source() gives { key, stem, open },
    // where open(engine) opens the panorama with the page's options in a worker. onChange(name, value)
    // is called for a changed choice.
    constructor({ engines, read, source, onChange, onFailure }) {
        Object.assign(this, { engines, read, source, onChange, onFailure, key: '', made: null, busy: false });
        this.pages = new Map();
        get('engine').append(...engines.map(({ name, title }) => new Option(title, name)));
        get('tune').append(...Object.entries(TUNES).map(([name, title]) => new Option(title, name)));
        for (const name of ['engine', 'format', 'tune'])
            get(name).onchange = () => onChange(name, get(name).value);
        get('engine-size').onchange = () => onChange('engineSize', Number(get('engine-size').value));
        get('copy').onclick = () => this.copy();
    }

    get chosen() {
        return this.engines.find(({ name }) => name === this.read().engine);
    }

    // The engine's page of the documentation. Names like three-cubeuv share the page of their first word.
    async lines() {
        const page = `engines/${this.chosen.name.split('-')[0]}.md`;
        if (!this.pages.has(page))
            this.pages.set(page, await textOf(page));
        return linesOf(this.pages.get(page), this.chosen.name, this.read().format);
    }

    // What a bake depends on.
    wanted() {
        const { engine, engineSize, format, tune } = this.read();
        return [this.source().key, engine, engineSize, format, tune].join();
    }

    // Shows the state: choices that the engine has, its files and its lines.
    async show() {
        const round = this.round = (this.round ?? 0) + 1;
        const { chosen } = this, state = this.read(), { stem } = this.source();
        get('engine').value = chosen.name;
        get('engine-size').replaceChildren(
            new Option(`${chosen.size} (usual)`, 0),
            ...[64, 128, 256, 512, 1024].filter((n) => n !== chosen.size).map((n) => new Option(n, n)));
        get('engine-size').value = state.engineSize;
        get('format').replaceChildren(...chosen.formats.map(
            (name, i) => (i ? new Option(name, name) : new Option(`${name} (usual)`, 'auto'))));
        get('format').value = state.format;
        get('format-row').hidden = chosen.formats.length < 2;
        get('tune').value = state.tune;
        get('tune-row').hidden = /panorama/.test(chosen.files);
        const lines = await this.lines();
        if (round !== this.round)
            return;
        const lights = state.lamps === 'extract' && lines.lights;
        const shown = [lines.load, ...(lights ? [lights] : [])].join('\n\n');
        const code = get('lines').textContent = named(shown, stem, `${stem}-lights.json`);
        const [, loader] = code.match(/from '\.\/([\w-]+\.mjs)'/) ?? [];
        const what = /^\d\. /.test(code) ? 'Steps' : 'Lines';
        get('code-title').textContent = `${what} that load these files${loader ? ` (${loader} is in the .zip)` : ''}`;
        get('lines').classList.toggle('steps', what === 'Steps');
        this.buttons(named(lines.output, stem, ''));
    }

    // Before a bake: one button for the engine's files and one for the bundle; afterwards each file.
    buttons(output) {
        const { chosen } = this, fresh = this.made && this.key === this.wanted();
        const several = !chosen.ending || this.read().lamps === 'extract';
        const button = (label, sentence, work, first) => {
            const made = document.createElement('button');
            made.type = 'button';
            made.textContent = label;
            made.title = sentence;
            made.className = first ? 'primary' : '';
            made.disabled = this.busy || !this.source().key;
            made.onclick = () => this.work(work);
            return made;
        };
        const length = fresh && this.bundle ? ` · ${size(this.bundle.length)}` : '';
        const bundle = button(`Download all (.zip)${length}`, 'The files, their loader and a README with the lines of code',
                              () => this.takeBundle(), several);
        const files = fresh
            ? this.made.files.map(({ name, bytes }) =>
                button(`${name} · ${size(bytes.length)}`, `Download ${name}`, () => save(name, bytes), !several))
            : several ? [] : [button(`Download ${output}`, 'Bakes for this engine and downloads the file',
                                     () => this.takeOnly(), true)];
        get('get').replaceChildren(...(several ? [bundle, ...files] : [...files, bundle]));
    }

    // Bakes unless the files are there, then runs `work`.
    async work(work) {
        this.busy = true;
        for (const button of get('get').children)
            button.disabled = true;
        try {
            await this.bake();
            await work();
        } catch (problem) {
            get('engine-status').textContent = '';
            this.onFailure(problem);
        }
        this.busy = false;
        await this.show();
    }

    async bake() {
        const key = this.wanted(), { chosen } = this, { stem, open, key: opened } = this.source();
        if (this.made && this.key === key)
            return;
        this.engine ??= new Engine({
            onProgress: (stage, fraction) => {
                get('engine-status').textContent = `Baking for ${chosen.title}: ${stage}, ${Math.round(100 * fraction)} %`;
            },
        });
        get('engine-status').textContent = `Baking for ${chosen.title}`;
        const { engineSize, format, tune, lamps } = this.read(), lines = await this.lines();
        if (this.opened !== opened) {
            this.opened = '';
            await open(this.engine);
            this.opened = opened;
        }
        const lightsName = lamps === 'extract' ? `${stem}-lights.json` : '';
        const made = await this.engine.engineFiles({
            index: this.engines.indexOf(chosen), size: engineSize, tune, format, lightsName,
            name: named(lines.output, stem, ''),
        }).catch((problem) => { this.opened = ''; throw problem; });
        Object.assign(this, { key, made, bundle: null });
        get('engine-status').textContent = made.note ? `${made.files[0].name}: ${made.note}.` : '';
    }

    takeOnly() {
        const { name, bytes } = this.made.files[0];
        save(name, bytes);
    }

    // The modules of kiln that `code` imports, and the modules that these import.
    async loaders(code, found = new Map()) {
        for (const [, name] of code.matchAll(/from '\.\/([\w-]+\.mjs)'/g))
            if (!found.has(name)) {
                found.set(name, await textOf(`loaders/${name}`));
                await this.loaders(found.get(name), found);
            }
        return [...found].map(([name, text]) => ({ name, text }));
    }

    async takeBundle() {
        const { chosen } = this, { stem } = this.source(), lines = get('lines').textContent;
        const encode = (text) => new TextEncoder().encode(text), loaders = await this.loaders(lines);
        const all = [...this.made.files, ...loaders.map(({ name, text }) => ({ name, bytes: encode(text) }))];
        const readme = `${stem} for ${chosen.title}\n\nFiles: ${all.map(({ name }) => name).join(', ')}\n\n` +
                       `Lines that load them:\n\n${lines}\n\n` +
                       `docs/engines/${chosen.name.split('-')[0]}.md of kiln says more.\n`;
        this.bundle ??= await zip([{ name: 'README.txt', bytes: encode(readme) }, ...all]);
        save(`${stem}-${chosen.name}.zip`, this.bundle);
    }

    async copy() {
        try {
            await navigator.clipboard.writeText(get('lines').textContent);
            get('copy').textContent = 'Copied';
            setTimeout(() => { get('copy').textContent = 'Copy'; }, 1500);
        } catch (problem) {
            this.onFailure(new Error(`The lines could not be copied: ${problem.message}`));
        }
    }
}

// Vite plugin that bakes panoramas when a project is built:
//     import env from './city.hdr?kiln&for=three';      // the address of the file that three.js loads
//     import env, { files, lights, sh } from './city.hdr?kiln&for=three&size=128&sun=extract';
// The query names options of `kiln bake`; an option without a value is a flag. What is baked is kept in Vite's cache
// folder under a hash of the panorama, the options and the version of kiln, so that the same import is baked once.
// In development, the files are served from there; a build copies them to its assets.
//
// three.js up to r186 loads other files than later versions. With for=three, the plugin looks at the version that the
// project has installed, and bakes for that one.
import { createHash, randomBytes } from 'node:crypto';
import fs from 'node:fs/promises';
import { createRequire } from 'node:module';
import path from 'node:path';
import { bake, version } from 'kiln-ibl';

const SERVED = '/@kiln-ibl/'; // where the development server has the files
const TYPES = { '.json': 'application/json', '.png': 'image/png' };

// { file, options } of an import that asks for kiln, else null. Vite adds parts of its own to queries: import, t, v.
function parse(id) {
    const at = id.indexOf('?');
    if (at < 0)
        return null;
    const query = new URLSearchParams(id.slice(at + 1));
    if (!query.has('kiln'))
        return null;
    const options = {};
    for (const [name, value] of query)
        if (!['kiln', 'import', 't', 'v'].includes(name))
            options[name] = value === '' || value === 'true' ? true : value === 'false' ? false : value;
    return { file: id.slice(0, at), options };
}

// The number N of three.js rN that modules in `root` import, or NaN.
async function revisionOf(root) {
    try {
        let folder = path.dirname(createRequire(path.join(root, 'index.js')).resolve('three'));
        for (; folder !== path.dirname(folder); folder = path.dirname(folder)) {
            const text = await fs.readFile(path.join(folder, 'package.json'), 'utf8').catch(() => '{}');
            const { name, version: number } = JSON.parse(text);
            if (name === 'three')
                return Number(number.split('.')[1]);
        }
    } catch { // three.js is not installed
    }
    return NaN;
}

// With for=three, the engine whose files the installed three.js loads. The size of CubeUV files is that of the cube
// that they are made of, which is twice the size of a face.
async function forInstalled(options, root) {
    if (options.for !== 'three' || !(await revisionOf(root) < 187))
        return options;
    return { ...options, for: 'three-cubeuv', ...(options.size && { size: 2 * options.size }) };
}

async function readKept(folder) {
    try {
        return JSON.parse(await fs.readFile(path.join(folder, 'baked.json'), 'utf8'));
    } catch {
        return null;
    }
}

// Writes a bake to a folder that appears whole or not at all.
async function keep(folder, { files, levels, sh, lights }) {
    const made = { files: files.map(({ name }) => name), levels, sh, lights };
    const part = `${folder}.${randomBytes(6).toString('hex')}`;
    for (const { name, bytes } of files) {
        await fs.mkdir(path.dirname(path.join(part, name)), { recursive: true });
        await fs.writeFile(path.join(part, name), bytes);
    }
    await fs.writeFile(path.join(part, 'baked.json'), JSON.stringify(made));
    await fs.rename(part, folder).catch(async (error) => { // another process was quicker
        await fs.rm(part, { recursive: true, force: true });
        if (!await readKept(folder))
            throw error;
    });
    return made;
}

export default function kiln({ cache } = {}) {
    let config, kept;
    const running = new Map(); // bakes that are under way, by their key

    // The bake of an import: { key, made }.
    async function bakeOnce({ file, options }) {
        const bytes = await fs.readFile(file), chosen = await forInstalled(options, config.root);
        const name = path.basename(file);
        const key = createHash('sha256').update(JSON.stringify([version, name, Object.entries(chosen).sort()]))
            .update('\0').update(bytes).digest('hex').slice(0, 32);
        const folder = path.join(kept, key);
        if (!running.has(key))
            running.set(key, readKept(folder).then(async (made) =>
                made ?? keep(folder, await bake(new Uint8Array(bytes), { name, ...chosen }))));
        try {
            return { key, made: await running.get(key) };
        } finally {
            running.delete(key);
        }
    }

    return {
        name: 'kiln-ibl',
        enforce: 'pre',

        // The package finds its worker and its WebAssembly beside its modules, which bundling would separate.
        config: () => ({ optimizeDeps: { exclude: ['kiln-ibl'] } }),

        configResolved(resolved) {
            config = resolved;
            kept = cache ? path.resolve(config.root, cache) : path.join(config.cacheDir, 'kiln-ibl');
        },

        configureServer(server) {
            server.middlewares.use(async (request, response, next) => {
                const address = decodeURIComponent((request.url ?? '').replace(/[?#].*$/, ''));
                const at = address.indexOf(SERVED);
                const file = path.join(kept, address.slice(at + SERVED.length));
                if (at < 0 || !file.startsWith(kept + path.sep))
                    return next();
                try {
                    const bytes = await fs.readFile(file);
                    response.setHeader('Content-Type', TYPES[path.extname(file)] ?? 'application/octet-stream');
                    response.setHeader('Cache-Control', 'no-cache');
                    return response.end(bytes);
                } catch {
                    return next();
                }
            });
        },

        async load(id) {
            const asked = parse(id);
            if (!asked)
                return null;
            this.addWatchFile(asked.file);
            const { key, made } = await bakeOnce(asked).catch((error) => this.error(error.message));
            const addresses = {};
            for (const name of made.files)
                addresses[name] = config.command === 'build'
                    ? `__VITE_ASSET__${this.emitFile({
                        type: 'asset', name: path.basename(name), source: await fs.readFile(path.join(kept, key, name)),
                    })}__`
                    : `${config.base.replace(/\/$/, '')}${SERVED}${key}/${name}`;
            const lines = ['levels', 'sh', 'lights'].map((field) =>
                `export const ${field} = ${JSON.stringify(made[field])};`);
            return [`export const files = ${JSON.stringify(addresses)};`,
                    `export default ${JSON.stringify(addresses[made.files[0]])};`, ...lines].join('\n');
        },
    };
}

// kiln-ibl in browsers. index.d.ts describes the functions; node.mjs offers the same in Node.
import { makeApi } from './api.mjs';
import { hasVectors } from './module.mjs';

// Development servers answer with a web page where a file is missing. Vite's server misses the module when it has
// bundled the package's JavaScript into a folder of its own.
function checkModule(bytes, url) {
    if (bytes[0] === 0 && bytes[1] === 0x61 && bytes[2] === 0x73 && bytes[3] === 0x6d)
        return;
    const found = bytes[0] === 0x3c ? 'a web page (HTML)' : `${bytes.length} bytes that are no WebAssembly`;
    throw new Error(`kiln-ibl: ${url} was asked for the WebAssembly module, and the server answered with ${found}. ` +
        `With Vite, write  optimizeDeps: { exclude: ['kiln-ibl'] }  into vite.config.js, or add the plugin of ` +
        'kiln-ibl/vite; with other servers, serve kiln.wasm next to index.mjs of the package');
}

async function loadModule() {
    const url = hasVectors() ? new URL('./kiln.wasm', import.meta.url) : new URL('./kiln-scalar.wasm', import.meta.url);
    const response = await fetch(url);
    if (!response.ok)
        throw new Error(`kiln-ibl: ${url} cannot be loaded: ${response.status} ${response.statusText}`);
    const bytes = new Uint8Array(await response.arrayBuffer());
    checkModule(bytes, url);
    return WebAssembly.compile(bytes);
}

// A page may start no worker whose script is of another origin, but one of its own that imports that script.
function foreignWorker() {
    const base = import.meta.url; // apart from the file's name, so that bundlers do not copy the file once more
    const script = `import ${JSON.stringify(new URL('worker.mjs', base).href)};`;
    return new Worker(URL.createObjectURL(new Blob([script], { type: 'text/javascript' })), { type: 'module' });
}

function ownWorker() {
    try {
        return new Worker(new URL('./worker.mjs', import.meta.url), { type: 'module' });
    } catch (error) {
        if (error.name !== 'SecurityError')
            throw error;
        return foreignWorker();
    }
}

function startWorker() {
    const worker = ownWorker();
    return {
        post: (message) => worker.postMessage(message),
        listen(onMessage, onError) {
            worker.onmessage = ({ data }) => onMessage(data);
            worker.onerror = (event) => onError(new Error(`kiln-ibl: the worker failed: ${event.message ??
                'its script cannot be loaded'}`));
        },
        end: () => worker.terminate(),
        rest() {},
    };
}

export const { bake, kiln } = makeApi(loadModule, startWorker);
export { engines, version } from './engines.mjs';

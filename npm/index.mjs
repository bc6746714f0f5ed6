// kiln-ibl in browsers. index.d.ts describes the functions; node.mjs offers the same in Node.
import { makeApi } from './api.mjs';
import { hasVectors } from './module.mjs';

async function loadModule() {
    const url = hasVectors() ? new URL('./kiln.wasm', import.meta.url) : new URL('./kiln-scalar.wasm', import.meta.url);
    const response = await fetch(url);
    if (!response.ok)
        throw new Error(`kiln-ibl: ${url} cannot be loaded: ${response.status} ${response.statusText}`);
    return WebAssembly.compile(await response.arrayBuffer());
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

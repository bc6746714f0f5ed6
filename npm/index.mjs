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

function startWorker() {
    const worker = new Worker(new URL('./worker.mjs', import.meta.url), { type: 'module' });
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

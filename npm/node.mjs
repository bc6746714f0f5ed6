// kiln-ibl in Node. index.d.ts describes the functions; index.mjs offers the same in browsers.
import { readFile } from 'node:fs/promises';
import { Worker } from 'node:worker_threads';
import { makeApi } from './api.mjs';
import { hasVectors } from './module.mjs';

async function loadModule() {
    return WebAssembly.compile(await readFile(new URL(hasVectors() ? './kiln.wasm' : './kiln-scalar.wasm',
        import.meta.url)));
}

function startWorker() {
    const worker = new Worker(new URL('./thread.mjs', import.meta.url));
    return {
        post(message) {
            worker.ref();
            worker.postMessage(message);
        },
        listen(onMessage, onError) {
            worker.removeAllListeners();
            worker.on('message', onMessage);
            worker.on('error', onError);
        },
        end: () => worker.terminate(),
        rest: () => worker.unref(),
    };
}

export const { bake, kiln } = makeApi(loadModule, startWorker);
export { engines, version } from './engines.mjs';

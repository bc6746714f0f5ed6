// The worker in which the baker runs. It receives messages {id, work, values} and handles them in
// order. It answers {id, result} or {id, error, fatal}, and reports progress as {stage, fraction}.
import makeModule from './baker.js';
import { Baker } from './baker.mjs';

let told = 0;
const ready = Baker.make(makeModule, {
    progress(stage, fraction) {
        const now = performance.now();
        if (now - told < 50)
            return;
        told = now;
        postMessage({ stage, fraction });
    },
});

async function answer({ id, work, values }) {
    try {
        const baker = await ready;
        const result = baker[work](...values);
        const moved = [...(result?.levels ?? result?.scenery?.levels ?? []).map((level) => level.texels.buffer),
                       ...(result?.files ?? []).map((file) => file.bytes.buffer)];
        postMessage({ id, result }, moved);
    } catch (error) {
        postMessage({ id, error: error.message, fatal: error instanceof WebAssembly.RuntimeError });
    }
}

onmessage = ({ data }) => answer(data);

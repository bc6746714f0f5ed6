// The command kiln on real files. In: workerData of bin.mjs. Out: a message with the exit code.
import fs from 'node:fs';
import { parentPort, workerData } from 'node:worker_threads';
import { disk } from './disk.mjs';
import { run } from './host.mjs';
import { hasVectors } from './module.mjs';

const { words, flag, columns } = workerData;
const file = new URL(hasVectors() ? './kiln.wasm' : './kiln-scalar.wasm', import.meta.url);
parentPort.postMessage(run(new WebAssembly.Module(fs.readFileSync(file)), words, disk(flag, columns)));

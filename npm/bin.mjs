#!/usr/bin/env node
// The command kiln. The work is done by a thread (bin-thread.mjs), so that this thread can take signals.
import os from 'node:os';
import { Worker } from 'node:worker_threads';

const GRACE = 2000; // milliseconds that the command has to remove its temporary files after a signal

// On Windows, backslashes separate the names of a path.
const words = process.argv.slice(2)
    .map((word) => (process.platform === 'win32' && !word.startsWith('\\\\?\\') ? word.replaceAll('\\', '/') : word));
const flag = new Int32Array(new SharedArrayBuffer(4));
const worker = new Worker(new URL('./bin-thread.mjs', import.meta.url),
    { workerData: { words, flag, columns: process.stdout.columns ?? 0 } });

for (const name of ['SIGINT', 'SIGTERM', 'SIGHUP'])
    process.on(name, () => {
        const number = os.constants.signals[name];
        Atomics.store(flag, 0, number);
        setTimeout(() => process.exit(128 + number), GRACE).unref();
    });
worker.on('message', (code) => {
    process.exitCode = code;
});
worker.on('error', (error) => {
    process.stderr.write(`kiln: the command broke down: ${error.message}\n`);
    process.exitCode = 1;
});

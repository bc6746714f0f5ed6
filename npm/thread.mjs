// A thread of Node: work.mjs by messages.
import { parentPort } from 'node:worker_threads';
import { work } from './work.mjs';

parentPort.on('message', (data) => work(data, (message, buffers) => parentPort.postMessage(message, buffers)));

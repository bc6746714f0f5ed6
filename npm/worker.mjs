// A worker of a browser: work.mjs by messages.
import { work } from './work.mjs';

self.onmessage = ({ data }) => work(data, (message, buffers) => self.postMessage(message, buffers));

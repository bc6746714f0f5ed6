// Runs the baker in a worker: engine.bake({...}) and the other methods return promises. A worker
// that fails is replaced by a new worker without an open source, and the waiting promises are
// rejected.
const WORK = ['open', 'sky', 'bake', 'extract', 'scenery', 'truth', 'file', 'irradiance', 'lights',
              'table'];

export class Engine {
    constructor({ onProgress = () => {} } = {}) {
        this.onProgress = onProgress;
        this.waiting = new Map();
        this.count = 0;
        this.start();
        for (const work of WORK)
            this[work] = (...values) => this.ask(work, values);
    }

    start() {
        this.worker = new Worker(new URL('worker.mjs', import.meta.url), { type: 'module' });
        this.worker.onmessage = ({ data }) => this.hear(data);
        this.worker.onerror = (event) => {
            event.preventDefault();
            this.restart(`The baker stopped: ${event.message || 'its files cannot be loaded'}.`);
        };
    }

    restart(sentence) {
        this.worker.terminate();
        const waiting = [...this.waiting.values()];
        this.waiting.clear();
        this.start();
        for (const { reject } of waiting)
            reject(new Error(sentence));
    }

    ask(work, values) {
        return new Promise((resolve, reject) => {
            const id = ++this.count;
            this.waiting.set(id, { resolve, reject });
            this.worker.postMessage({ id, work, values });
        });
    }

    hear({ id, result, error, fatal, stage, fraction }) {
        if (stage)
            return this.onProgress(stage, fraction);
        const asked = this.waiting.get(id);
        this.waiting.delete(id);
        if (fatal) {
            asked.reject(new Error(`The baker stopped: ${error}`));
            return this.restart('The baker stopped.');
        }
        return error === undefined ? asked.resolve(result) : asked.reject(new Error(error));
    }
}

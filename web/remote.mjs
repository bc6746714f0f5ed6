// Calls of functions in a worker. A message to the worker is {id, work, values}, its answer
// {id, result} or {id, error, fatal}; any other message goes to onEvent.
export class Remote {
    // `url` is the worker's address; each name in `work` becomes a method that returns a promise.
    constructor(url, work, onEvent = () => {}) {
        Object.assign(this, { url, onEvent, waiting: new Map(), count: 0 });
        this.start();
        for (const name of work)
            this[name] = (...values) => this.ask(name, values);
    }

    start() {
        this.worker = new Worker(this.url, { type: 'module' });
        this.worker.onmessage = ({ data }) => this.hear(data);
        this.worker.onerror = (event) => {
            event.preventDefault();
            this.fail(event.message || 'its files cannot be loaded');
        };
    }

    // Rejects all promises that wait.
    reject(sentence) {
        const waiting = [...this.waiting.values()];
        this.waiting.clear();
        for (const { reject } of waiting)
            reject(new Error(sentence));
    }

    // Called when the worker itself fails.
    fail(reason) {
        this.reject(`A part of the page stopped: ${reason}.`);
    }

    ask(work, values, transfer = []) {
        return new Promise((resolve, reject) => {
            const id = ++this.count;
            this.waiting.set(id, { resolve, reject });
            this.worker.postMessage({ id, work, values }, transfer);
        });
    }

    hear(data) {
        if (data.id === undefined)
            return this.onEvent(data);
        const asked = this.waiting.get(data.id);
        this.waiting.delete(data.id);
        if (data.error === undefined)
            return asked?.resolve(data.result);
        asked?.reject(new Error(data.error));
        return data.fatal ? this.fail(data.error) : undefined;
    }
}

// Work that takes long runs in a worker of its own while the page stays usable. The first steps
// give a coarse result and later steps better results. Work whose result is no longer wanted is
// stopped.
import { Engine } from './engine.mjs';

// Runs a series of steps, each of which gives a result to show. start() does nothing if the same
// key is running or finished.
export class BackgroundWork {
    // onWords(sentence) reports progress, and '' when work ends. onResult(result, step, last)
    // receives the result of each step and may return a promise; `last` is true for the final step. onFailure(error)
    // receives an exception.
    constructor({ onWords, onResult, onFailure }) {
        Object.assign(this, { onWords, onResult, onFailure, key: '', opened: '', round: 0, busy: false });
    }

    get works() {
        return this.busy;
    }

    stop() {
        this.round++;
        this.key = '';
        if (this.busy)
            this.engine.restart('Stopped.'); // a new worker without an open source
        if (this.busy)
            this.opened = '';
        this.busy = false;
        this.onWords('');
    }

    // `steps` is an array of { words, work(engine) }. open(engine) opens the source in the worker,
    // unless the worker has the source named `source` open already.
    async start({ key, source, open, steps }) {
        if (key === this.key)
            return;
        this.stop();
        this.key = key;
        this.busy = true;
        this.words = steps[0].words; // progress is told while the source is opened, too
        const round = ++this.round;
        this.engine ??= new Engine({
            onProgress: (stage, fraction) => {
                if (this.busy)
                    this.onWords(`${this.words}, ${Math.round(100 * fraction)} %`);
            },
        });
        try {
            if (this.opened !== source) {
                await open(this.engine);
                this.opened = source;
            }
            for (const [i, step] of steps.entries()) {
                if (round !== this.round)
                    return;
                this.words = step.words;
                this.onWords(step.words);
                const result = await step.work(this.engine);
                if (round !== this.round)
                    return;
                await this.onResult(result, step, i === steps.length - 1);
            }
        } catch (problem) {
            if (round !== this.round)
                return;
            this.key = '';
            this.opened = '';
            this.onFailure(problem);
        }
        this.busy = false;
        this.onWords('');
    }
}

// Runs the baker in a worker: engine.bake({...}) and the other methods return promises. A worker
// that fails is replaced by a new worker without an open source, and the waiting promises are
// rejected.
import { Remote } from './remote.mjs';

const WORK = ['open', 'sky', 'options', 'bake', 'sun', 'scenery', 'truth', 'histogram', 'panorama', 'engines',
              'engineFiles', 'check', 'file', 'irradiance', 'lights', 'table'];

export class Engine extends Remote {
    constructor({ onProgress = () => {} } = {}) {
        super(new URL('worker.mjs', import.meta.url), WORK,
              ({ stage, fraction }) => onProgress(stage, fraction));
    }

    restart(sentence) {
        this.worker.terminate();
        this.start();
        this.reject(sentence);
    }

    fail(reason) {
        this.restart(`The baker stopped: ${reason}.`);
    }
}

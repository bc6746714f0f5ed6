// The stage for the page: it draws in a worker (stage_worker.mjs) on a canvas that is handed over, and
// this class keeps what the page asks for often.
import { wholeDistance } from './camera.mjs';
import { Remote } from './remote.mjs';
import { numbersOf } from './stage.mjs';

const WORK = ['names', 'start', 'light', 'discs', 'error', 'furnace', 'balls', 'draw'];

export class StageClient extends Remote {
    // Resolves as soon as names and default views are known; `started` resolves when the stage draws or
    // `problem` says why not. onDrawn() is called when the newest view has been drawn finely.
    static async make(canvas, onDrawn) {
        const stage = new StageClient(new URL('stage_worker.mjs', import.meta.url), WORK,
                                      (event) => stage.drawn(event));
        Object.assign(stage, { canvas, onDrawn, ready: false, problem: '', serial: 0 });
        Object.assign(stage, await stage.ask('names', []));
        stage.started = stage.begin().catch((problem) => { stage.problem = problem.message; });
        return stage;
    }

    async begin() {
        if (!this.canvas.transferControlToOffscreen) {
            this.problem = 'this browser cannot draw in a worker, which the balls need';
            return;
        }
        const canvas = this.canvas.transferControlToOffscreen();
        const { problem } = await this.ask('start', [canvas], [canvas]);
        this.problem = problem;
        this.ready = !problem;
    }

    fail(reason) {
        this.ready = false;
        this.problem = `the balls cannot be drawn any more: ${reason}`;
        this.reject(this.problem);
    }

    drawn({ serial, drawn }) {
        if (serial !== this.serial)
            return;
        this.canvas.dataset.drawn = drawn;
        this.onDrawn(drawn);
    }

    // A scene's default view.
    view(scene) {
        return this.defaults[scene];
    }

    // The distance at which all balls are whole, or `least` if that is farther.
    distance(view, aspect, least = 0) {
        return Math.max(least, wholeDistance(view, this.ballsOf[view.scene], aspect));
    }

    numbers(view) {
        return numbersOf(this.words, view);
    }

    show(view, width, height) {
        this.canvas.dataset.drawn = '';
        this.worker.postMessage({ work: 'draw', values: [view, width, height, ++this.serial] });
    }

    // Uploads an environment and hands its texels over.
    upload(scenery, textbook = false) {
        const moved = scenery.levels.map((level) => level.texels.buffer);
        return this.ask('light', [scenery, textbook], moved);
    }
}

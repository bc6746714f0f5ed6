// The same balls drawn by three.js: the upper row lit by kiln's file for three.js, the lower row by what
// three.js' own filter makes of the same panorama. three.js is loaded only when this view is asked for.
import { Engine } from './engine.mjs';
import { Remote } from './remote.mjs';

export class ThreeView {
    // `box` receives the canvas. open(engine) opens the panorama in a worker, key() names it.
    constructor({ box, open, engines, key, onNote, onFailure }) {
        Object.assign(this, { box, open, engines, key, onNote, onFailure, shows: false, note: '', lit: '' });
    }

    say(sentence) {
        this.note = sentence;
        this.onNote();
    }

    show(shows) {
        this.shows = shows;
        if (shows && !this.canvas)
            this.make();
        if (this.canvas)
            this.canvas.hidden = !shows;
        if (shows && this.lit !== this.key())
            this.light();
    }

    make() {
        this.canvas = document.createElement('canvas');
        this.canvas.id = 'three';
        this.canvas.setAttribute('role', 'img');
        this.canvas.setAttribute('aria-label',
                                 'Balls drawn by three.js, above with kiln\'s file, below with three.js\' own filter');
        this.box.prepend(this.canvas);
        this.worker = new Remote(new URL('three_worker.mjs', import.meta.url), []);
        const canvas = this.canvas.transferControlToOffscreen();
        this.started = this.worker.ask('start', [canvas], [canvas]);
    }

    // Bakes the file for three.js and hands it with the panorama to three.js.
    async light() {
        const key = this.lit = this.key();
        this.ready = false;
        try {
            this.say('Baking the file for three.js');
            this.engine ??= new Engine();
            await this.open(this.engine);
            await this.engine.options({});
            const panorama = await this.engine.panorama();
            const index = this.engines.findIndex(({ name }) => name === 'three');
            const { files: [{ bytes }] } = await this.engine.engineFiles({ index, name: 'three.ktx2' });
            if (key !== this.lit)
                return;
            this.say('three.js filters the same panorama');
            await this.started;
            const { milliseconds } = await this.worker.ask('light', [panorama, bytes],
                                                           [panorama.texels.buffer, bytes.buffer]);
            this.ready = true;
            this.done = `Both rows are drawn by three.js. Its own filter took ${(milliseconds / 1000).toFixed(1)} s, and ` +
                        'cuts off what half floats cannot hold.';
            this.again();
        } catch (problem) {
            if (key !== this.lit)
                return;
            this.say('');
            this.onFailure(problem);
        }
    }

    again() {
        if (this.last && this.ready && this.shows)
            this.draw(...this.last);
    }

    // Draws the newest view, after the picture that is being drawn.
    async draw(view, width, height) {
        this.last = [view, width, height];
        if (!this.ready || this.drawing)
            return;
        this.drawing = true;
        try {
            for (let drawn; drawn !== this.last;) {
                drawn = this.last;
                this.canvas.dataset.drawn = '';
                for (const scale of [0.4, 1])
                    if (drawn === this.last)
                        await this.worker.ask('draw', [...drawn, scale]);
            }
            this.canvas.dataset.drawn = 'finely';
            this.say(this.done);
        } catch (problem) {
            this.onFailure(problem);
        }
        this.drawing = false;
    }
}

// JavaScript class around stage.h; views are objects whose keys are the names in NUMBERS.
const NUMBERS = ['scene', 'method', 'material', 'targetX', 'targetY', 'targetZ', 'azimuth',
                 'elevation', 'distance', 'fov', 'rotation', 'exposure', 'debug', 'level', 'split',
                 'background', 'samples', 'asPrinted', 'occlusion', 'cubeDiffuse',
                 'reflections', 'ground'];
const WORDS = ['scene', 'method', 'material', 'debug', 'reflections'];

// A view as the array of numbers that web/view_numbers.h names. `words` are Stage's.
export function numbersOf(words, view) {
    return NUMBERS.map((name) => (WORDS.includes(name) ? words[name].indexOf(view[name])
                                                       : Number(view[name])));
}

export class Stage {
    // A stage that does not draw before start().
    static async make(makeModule, options = {}) {
        const stage = new Stage(), module = await makeModule(options);
        stage.module = module;
        stage.self = module._stage_create();
        if (!stage.self)
            throw new Error('the stage cannot start: there is no memory for it');
        stage.words = Object.fromEntries(WORDS.map((name, kind) => {
            const words = [];
            for (let at; (at = module._stage_word(kind, words.length));)
                words.push(module.UTF8ToString(at));
            return [name, words];
        }));
        return stage;
    }

    // Starts to draw in a WebGL 2 context. Returns a sentence if that is impossible, else ''.
    start(gl) {
        const { module, self } = this;
        const handle = gl ? module.GL.registerContext(gl, { majorVersion: 2, minorVersion: 0 }) : 0;
        if (!module._stage_start(self, handle))
            return this.message();
        this.renderer = module.UTF8ToString(module._stage_gl_name(self));
        return '';
    }

    // What the page must know before the stage draws: the words, and each scene's default view and
    // balls.
    names() {
        const each = (of) => Object.fromEntries(this.words.scene.map((scene) => [scene, of(scene)]));
        const defaults = each((scene) => this.defaults(scene));
        return { words: this.words, defaults, ballsOf: each((scene) => this.balls(defaults[scene])) };
    }

    message() {
        return this.module.UTF8ToString(this.module._stage_message(this.self));
    }

    // The balls of a view, each as the ten numbers of stage_ball.
    balls(view) {
        const { module, self } = this;
        this.set(view);
        return Array.from({ length: module._stage_balls(self) }, (_, i) => {
            const at = module._stage_ball(self, i) >>> 3;
            return [...module.HEAPF64.slice(at, at + 10)];
        });
    }

    // The scene's default view. Scene, method, material and debug view are given by name.
    defaults(scene) {
        this.module._stage_defaults(this.self, this.words.scene.indexOf(scene));
        const at = this.module._stage_numbers(this.self) >>> 3;
        return Object.fromEntries(NUMBERS.map((name, i) => {
            const value = this.module.HEAPF64[at + i];
            return [name, WORDS.includes(name) ? this.words[name][value] : value];
        }));
    }

    set(view) {
        this.module.HEAPF64.set(numbersOf(this.words, view), this.module._stage_numbers(this.self) >>> 3);
    }

    draw(view, width, height) {
        this.set(view);
        if (!this.module._stage_draw(this.self, width, height))
            throw new Error(this.message());
    }

    // Uploads an environment, in the form that Baker.scenery() returns, to the exact or the sampled
    // slot.
    light({ levels, irradiance, harmonics }, textbook = false) {
        const { module, self } = this;
        if (!module._stage_room(self, levels[0].size, levels.length, irradiance.size))
            throw new Error(this.message());
        const put = (level, texels) =>
            module.HEAPF32.set(texels, module._stage_texels(self, level) >>> 2);
        put(-1, irradiance.texels);
        levels.forEach((level, k) => {
            put(k, level.texels);
            module._stage_roughness(self, k, level.roughness);
        });
        module.HEAPF64.set(harmonics, module._stage_harmonics(self) >>> 3);
        if (!module._stage_light(self, textbook ? 1 : 0))
            throw new Error(this.message());
    }

    // Shows lights, in the form that Baker.extract() returns, as discs.
    discs(lights) {
        const { module, self } = this, at = module._malloc(56 * lights.length + 8);
        module.HEAPF64.set(lights.flat(), at >>> 3);
        module._stage_discs(self, at, lights.length);
        module._free(at);
    }

    // Compares the view with a reference picture. Returns colours (RGB floats, 0 to 1) and the
    // figures of stage_error.
    error(view, { width, height, texels }) {
        const { module, self } = this, at = module._stage_truth(self, width, height);
        if (!at)
            throw new Error(this.message());
        module.HEAPF32.set(texels, at >>> 2);
        this.set(view);
        const off = module._malloc(24), good = module._stage_error(self, off);
        const [rms, largest, screen] = module.HEAPF64.slice(off >>> 3, (off >>> 3) + 3);
        module._free(off);
        if (!good)
            throw new Error(this.message());
        const from = module._stage_colours(self) >>> 2;
        return { rms, largest, screen, width, height,
                 colours: module.HEAPF32.slice(from, from + 3 * width * height) };
    }

    // Residual of the furnace: largest and RMS difference from 1 of the balls with compensation.
    furnace(view, width, height) {
        this.set(view);
        const off = this.module._malloc(16);
        const good = this.module._stage_furnace(this.self, width, height, off);
        const [largest, rms] = this.module.HEAPF64.subarray(off >>> 3, (off >>> 3) + 2);
        this.module._free(off);
        if (!good)
            throw new Error(this.message());
        return { largest, rms };
    }
}

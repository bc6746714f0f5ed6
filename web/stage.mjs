// The view as an object: what stage.h says, with names for its numbers.
const NUMBERS = ['scene', 'method', 'material', 'targetX', 'targetY', 'targetZ', 'azimuth',
                 'elevation', 'distance', 'fov', 'rotation', 'exposure', 'debug', 'level', 'split',
                 'background', 'samples', 'asPrinted', 'occlusion', 'cubeDiffuse',
                 'bent'];
const WORDS = ['scene', 'method', 'material', 'debug'];

export class Stage {
    // `canvas` is a CSS selector. Where there is no WebGL 2, `problem` says so and nothing is drawn.
    static async make(makeModule, canvas, options = {}) {
        const stage = new Stage(), module = await makeModule(options);
        stage.module = module;
        stage.self = module.ccall('stage_create', 'number', ['string'], [canvas]);
        stage.ready = Boolean(module._stage_ready(stage.self));
        stage.problem = stage.ready ? '' : stage.message();
        stage.renderer = module.UTF8ToString(module._stage_gl_name(stage.self));
        stage.words = Object.fromEntries(WORDS.map((name, kind) => {
            const words = [];
            for (let at; (at = module._stage_word(kind, words.length));)
                words.push(module.UTF8ToString(at));
            return [name, words];
        }));
        return stage;
    }

    message() {
        return this.module.UTF8ToString(this.module._stage_message(this.self));
    }

    // The numbers of a scene as it is meant to be seen, with words for what has words.
    defaults(scene) {
        this.module._stage_defaults(this.self, this.words.scene.indexOf(scene));
        const at = this.module._stage_numbers(this.self) >>> 3;
        return Object.fromEntries(NUMBERS.map((name, i) => {
            const value = this.module.HEAPF64[at + i];
            return [name, WORDS.includes(name) ? this.words[name][value] : value];
        }));
    }

    numbers(view) {
        return NUMBERS.map((name) => (WORDS.includes(name) ? this.words[name].indexOf(view[name])
                                                           : Number(view[name])));
    }

    set(view) {
        this.module.HEAPF64.set(this.numbers(view), this.module._stage_numbers(this.self) >>> 3);
    }

    draw(view, width, height) {
        this.set(view);
        this.module._stage_draw(this.self, width, height);
    }

    // An environment as the baker's scenery() gives it.
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

    // The error of what draw() shows against its truth: colours, RGB floats of 0 to 1, and figures.
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

    // How far the furnace's compensated balls are from vanishing.
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

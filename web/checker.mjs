// JavaScript class around checker.h: what is wrong with a file of any tool, compared with a baker's source.
const LEVEL = ['size', 'roughness', 'found', 'rms', 'largest', 'bias', 'energy', 'seam'];
const LEVELS = 0, FINDINGS = 1, BANDS = 2; // of checker_count
const WIDTH = 256, HEIGHT = 128; // of the picture of one level's differences

export class Checker {
    constructor(baker) {
        this.baker = baker;
        this.self = baker.module._checker_create(baker.self);
        if (!this.self)
            throw new Error('the file cannot be checked: there is no memory for it');
    }

    call(name, ...values) {
        this.baker.callOf(this.self, name, ...values);
    }

    // Checks a file of levels, of harmonics or of both. `engine` is the index of the engine that the file is for, or
    // -1. Returns { levels, worst, picture, scenery } for levels, { bands, harmonics } for harmonics, the error of
    // which is `harmonics`, and { findings } with { text, fault, harmonic } for each. `scenery` has the levels of the file as
    // they are shown, in the form that Stage.light takes; what is no level is kiln's.
    check(bytes, name, engine = -1) {
        const { module } = this.baker, { self } = this, path = name.replaceAll('/', '_');
        module.FS.writeFile(`/${path}`, bytes);
        try {
            this.call('checker_run', path, engine);
        } finally {
            module.FS.unlink(`/${path}`);
        }
        const list = (what, each) => Array.from({ length: module._checker_count(self, what) }, (_, i) => each(i));
        const levels = list(LEVELS, (k) => Object.fromEntries(
            LEVEL.map((field, i) => [field, module._checker_level(self, k, i)])));
        return {
            name,
            checks: levels,
            worst: module._checker_error(self, 0),
            bands: list(BANDS, (band) => module._checker_band(self, band)),
            harmonics: module._checker_error(self, 1),
            findings: list(FINDINGS, (i) => ({ text: module.UTF8ToString(module._checker_finding(self, i)),
                                               fault: Boolean(module._checker_is_fault(self, i)),
                                               harmonic: Boolean(module._checker_is_harmonic(self, i)) })),
            picture: levels.length ? this.picture(levels.length) : null,
            scenery: levels.length ? this.scenery() : null,
        };
    }

    picture(count) {
        const { module } = this.baker, at = module._checker_picture(this.self) >>> 2;
        return { width: WIDTH, height: HEIGHT, count,
                 colours: module.HEAPF32.slice(at, at + 3 * WIDTH * HEIGHT * count) };
    }

    scenery() {
        this.baker.call('baker_scenery', 16, 0); // its irradiance and its harmonics are used
        this.call('checker_scenery');
        return this.baker.readScenery();
    }
}

// JavaScript class around baker.h; failures throw an Error with baker_message's text.
//   const baker = await Baker.make(makeModule, { progress(stage, fraction) {} })
import { Checker } from './checker.mjs';

const TUNES = ['auto', 'none', 'sharp', 'soft'];
const SUNS = ['keep', 'extract', 'clamp'];
const UPS = ['y', 'z', '-z'];
export const TABLES = ['e', 'eavg', 'dfg'];
export const SHAPES = ['auto', 'panorama', 'cube', 'octahedron'];

export class Baker {
    static async make(makeModule, options = {}) {
        const baker = new Baker();
        baker.module = await makeModule(options);
        baker.self = baker.module._baker_create();
        if (!baker.self)
            throw new Error('kiln cannot start: there is no memory for it');
        baker.formats = []; // names of the formats, in the order of kiln_format
        for (let at; (at = baker.module._baker_format_name(baker.formats.length));)
            baker.formats.push(baker.module.UTF8ToString(at));
        return baker;
    }

    call(name, ...values) {
        this.callOf(this.self, name, ...values);
    }

    // Calls a function whose first argument is the pointer `self`, and throws the message of a failure.
    callOf(self, name, ...values) {
        const types = values.map((value) => (typeof value === 'string' ? 'string' : 'number'));
        const good = this.module.ccall(name, 'boolean', ['number', ...types], [self, ...values]);
        if (!good)
            throw new Error(this.module.UTF8ToString(this.module._baker_message(this.self)));
    }

    // Opens an image file from its bytes, which are copied; error messages quote `name`. Returns
    // the source's shape and size.
    open(bytes, name) {
        const at = this.module._malloc(bytes.length);
        if (!at)
            throw new Error(`${name}: its ${bytes.length} bytes do not fit into the page's memory`);
        try {
            this.module.HEAPU8.set(bytes, at);
            this.call('baker_open', at, bytes.length, name);
        } finally {
            this.module._free(at);
        }
        return this.source();
    }

    sky({ size = 512, elevation = 30, azimuth = 0, turbidity = 3 } = {}) {
        this.call('baker_sky', size, elevation, azimuth, turbidity);
        return this.source();
    }

    source() {
        const { module, self } = this;
        const shape = SHAPES[module._baker_source_shape(self)];
        const size = module._baker_source_size(self);
        return { shape, width: shape === 'panorama' ? 2 * size : size, height: size };
    }

    // Copies the RGB floats of six faces.
    texels(at, size) {
        return this.module.HEAPF32.slice(at >>> 2, (at >>> 2) + 18 * size * size);
    }

    // What was found in the source and cut off by the last bake, in sentences without a full stop.
    notes() {
        const { module, self } = this, notes = [];
        for (let at; (at = module._baker_note(self, notes.length)) !== 0;)
            notes.push(module.UTF8ToString(at));
        return notes;
    }

    // Sets the options of later bakes, as the command has them. `sun` is 'keep', 'extract' or
    // 'clamp'; `clamp` is the largest radiance, 0 for the baker's choice; `up` is 'y', 'z' or '-z'.
    options({ yaw = 0, pitch = 0, roll = 0, exposure = 0, sun = 'keep', lights = 1, clamp = 0, up = 'y',
              mirror = false } = {}) {
        const { module, self } = this;
        module._baker_options(self, yaw, pitch, roll, exposure, SUNS.indexOf(sun), lights, clamp);
        module._baker_place(self, UPS.indexOf(up), mirror);
    }

    // Bakes the source with the options. Returns each level's size, roughness and texels, the
    // harmonics, the notes and the time.
    bake({ size = 256, levels = 0 } = {}) {
        const { module, self } = this, began = performance.now();
        this.call('baker_bake', size, levels);
        const seconds = (performance.now() - began) / 1000;
        const sh = module._baker_harmonics(self) >>> 3;
        return {
            seconds,
            cpu: module.UTF8ToString(module._baker_cpu(self)),
            notes: this.notes(),
            harmonics: module.HEAPF64.slice(sh, sh + 27),
            levels: Array.from({ length: module._baker_level_count(self) }, (_, k) => {
                const side = module._baker_level_size(self, k);
                return { size: side, roughness: module._baker_roughness(self, k),
                         texels: this.texels(module._baker_texels(self, k), side) };
            }),
        };
    }

    // Turns the source, and takes lights out of the source or clamps it, as baker_sun. Returns an array of
    // the lights that were taken out, each as the seven numbers of baker_light.
    sun() {
        const { module, self } = this;
        this.call('baker_sun');
        return Array.from({ length: module._baker_light_count(self) }, (_, i) => {
            const at = module._baker_light(self, i) >>> 3;
            return [...module.HEAPF64.slice(at, at + 7)];
        });
    }

    // The part of the source's texels of each stop, as baker_histogram, the exponent of the first
    // stop, and the largest value.
    histogram() {
        const { module, self } = this, at = module._baker_histogram(self) >>> 3;
        return { first: -14, parts: [...module.HEAPF64.slice(at, at + 40)],
                 largest: module._baker_largest(self) };
    }

    // The source if it is a panorama: RGB floats, row 0 at the top.
    panorama() {
        const { module, self } = this, { shape, width, height } = this.source();
        if (shape !== 'panorama')
            throw new Error(`three.js filters panoramas, and this picture is a ${shape}`);
        const at = module._baker_source_texels(self) >>> 2;
        return { width, height, texels: module.HEAPF32.slice(at, at + 3 * width * height) };
    }

    // kiln's list of engines: `formats` are names, the default first.
    engines() {
        const { module } = this, list = [];
        for (let i = 0; module._baker_engine_text(i, 0); i++) {
            const [name, title, files, ending] =
                [0, 1, 2, 3].map((what) => module.UTF8ToString(module._baker_engine_text(i, what)));
            const [size, tuned, ...formats] =
                [0, 1, 2, 3, 4, 5].map((what) => module._baker_engine_number(i, what));
            list.push({ name, title, files, ending, size, tuned: Boolean(tuned),
                        formats: formats.filter(Boolean).map((format) => this.formats[format]) });
        }
        return list;
    }

    // The files of an engine, baked with the options: { files: [{ name, bytes }], note }.
    engineFiles({ index, size = 0, tune = 'auto', format = 'auto', name, lightsName = '' }) {
        const { module, self } = this;
        this.call('baker_engine_files', index, size, TUNES.indexOf(tune), this.formats.indexOf(format), name,
                  lightsName);
        const note = module._baker_files_note(self);
        return {
            note: note ? module.UTF8ToString(note) : '',
            files: Array.from({ length: module._baker_file_count(self) }, (_, i) => {
                const at = module._baker_file_bytes(self, i);
                return { name: module.UTF8ToString(module._baker_file_name(self, i)),
                         bytes: module.HEAPU8.slice(at, at + module._baker_file_size(self, i)) };
            }),
        };
    }

    // Returns the textures that light the view, in the form that Stage.light takes. With `samples`
    // above 0 the levels are importance-sampled with that many samples a texel.
    scenery({ size = 256, samples = 0 } = {}) {
        const began = performance.now();
        this.call('baker_scenery', size, samples);
        return { ...this.readScenery(), seconds: (performance.now() - began) / 1000 };
    }

    readScenery() {
        const { module, self } = this, sh = module._baker_scenery_harmonics(self) >>> 3;
        const level = (k) => {
            const side = module._baker_scenery_size(self, k);
            return { size: side, roughness: k < 0 ? 1 : module._baker_scenery_roughness(self, k),
                     texels: this.texels(module._baker_scenery_texels(self, k), side) };
        };
        return {
            harmonics: module.HEAPF64.slice(sh, sh + 27),
            irradiance: level(-1),
            levels: Array.from({ length: module._baker_scenery_levels(self) }, (_, k) => level(k)),
        };
    }

    // Checks a file of any tool: see Checker.check.
    check(bytes, name, engine) {
        this.checker ??= new Checker(this);
        return this.checker.check(bytes, name, engine);
    }

    // Integrates a view until its pixels reach the relative standard error `noise`. Returns RGB
    // floats and the noise reached.
    truth({ numbers, width, height, noise, alone }) {
        const { module, self } = this, at = module._malloc(8 * numbers.length);
        try {
            module.HEAPF64.set(numbers, at >>> 3);
            this.call('baker_truth', at, width, height, noise, alone);
        } finally {
            module._free(at);
        }
        const from = module._baker_truth_texels(self) >>> 2;
        return { width, height, noise: module._baker_truth_noise(self),
                 texels: module.HEAPF32.slice(from, from + 3 * width * height) };
    }

    // Bytes of the baked irradiance cube as a file: .ktx2 or .dds.
    irradiance(name, format = 'rgba16f') {
        this.call('baker_save_irradiance', `/${name}`, this.formats.indexOf(format));
        return this.written(`/${name}`);
    }

    // Bytes of the file that the command would write; the ending of the name selects the kind:
    // .ktx2, .dds, .json, .txt or .h.
    file(name, format = 'rgba16f') {
        this.call('baker_save', `/${name}`, this.formats.indexOf(format));
        return this.written(`/${name}`);
    }

    // Bytes of the .json file of the lights that the last bake took out.
    lights(name) {
        this.call('baker_save_lights', `/${name}`);
        return this.written(`/${name}`);
    }

    // Bytes of a table of the reflection model as a file: .ktx2, .raw, .h or .glsl.
    table(name, kind) {
        this.call('baker_table', `/${name}`, TABLES.indexOf(kind));
        return this.written(`/${name}`);
    }

    written(path) {
        const bytes = this.module.FS.readFile(path);
        this.module.FS.unlink(path);
        return bytes;
    }
}

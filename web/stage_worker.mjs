// The worker in which the stage draws on a canvas that the page has handed over, so that neither
// shaders nor tables keep the page waiting. Messages and answers are those of remote.mjs; {drawn,
// serial} tells that a view has been drawn.
import { Painter } from './painter.mjs';
import { Stage } from './stage.mjs';
import makeModule from './stage.js';

const making = Stage.make(makeModule);
let stage, painter;

const WORK = {
    async names() {
        stage = await making;
        return stage.names();
    },
    start(canvas) {
        // With alpha, the canvas has the format of the painter's framebuffer, so that drivers compile the
        // shaders once.
        const gl = canvas?.getContext('webgl2', { alpha: true, depth: false, antialias: false,
                                                  preserveDrawingBuffer: true });
        const problem = stage.start(gl);
        // Drivers compile a shader again when it first draws: this goes on while the panorama is baked.
        if (!problem)
            stage.draw({ ...stage.defaults('ibl'), samples: 1 }, 1, 1);
        if (!problem)
            painter = new Painter(stage, gl, (serial, drawn) => postMessage({ serial, drawn }));
        return { problem, renderer: stage.renderer };
    },
    draw: (...values) => painter.want(...values),
    light: (...values) => painter.aside(() => stage.light(...values)),
    discs: (lights) => painter.aside(() => stage.discs(lights)),
    error: (...values) => painter.aside(() => stage.error(...values)),
    balls: (view) => stage.balls(view),
    furnace: (...values) => painter.aside(() => stage.furnace(...values)),
};

onmessage = async ({ data: { id, work, values } }) => {
    try {
        const result = await WORK[work](...values);
        if (id !== undefined)
            postMessage({ id, result });
    } catch (error) {
        postMessage({ id, error: error.message, fatal: error instanceof WebAssembly.RuntimeError });
    }
};

// The panel of controls at the right of the page, made with lil-gui: each control has a name in plain
// words and a sentence that the browser shows on hover.
import GUI from './lil-gui.mjs';

const SIZES = [16, 32, 64, 128, 256, 512, 1024];

// Names that the page gives to the words of viewer.h.
export const NAMES = {
    scene: { ibl: 'Two rows of balls', grid: 'Paint to metal', compare: 'Exact beside sampled',
             three: 'three.js beside kiln', check: 'A checked file beside exact', furnace: 'White furnace', assignment: 'GAMES202 assignment' },
    material: { gold: 'Gold', copper: 'Copper', aluminium: 'Aluminium', silver: 'Silver', iron: 'Iron',
                titanium: 'Titanium', white: 'White metal', handout: 'Copper of the assignment',
                plastic: 'Red plastic', chalk: 'Chalk' },
    method: { single: 'Nothing', 'kulla-conty': 'Kulla and Conty', handout: 'Kulla and Conty, assignment',
              'fdez-aguera': 'Fdez-Agüera', turquin: 'Turquin' },
    debug: { none: 'The picture', error: 'Error of the picture', e: 'Reflected share on balls',
             f: 'Fresnel reflectance on balls', 'table-e': 'Table of the reflected share',
             'table-e-average': 'Table of its average', 'table-split': 'Table of the split sum' },
    reflections: { straight: 'Where a mirror looks', bent: 'Bent towards the normal', one: 'One fitted place',
                   two: 'Two fitted places', three: 'Three fitted places' },
};

// Keys whose entries are among `words`, as lil-gui wants a list: name to word.
const list = (names, words) => Object.fromEntries(
    Object.entries(names).filter(([word]) => words.includes(word)).map(([word, name]) => [name, word]));

// The folders of the panel with their titles, and each folder's controls: the name of the value in the
// state, the name on the page, the sentence, and what lil-gui wants, which is a list or a range.
function rows(words) {
    const sky = [
        ['sun', 'Sun height', 'How high the sun stands above the horizon, in degrees.', -5, 90, 0.5],
        ['bearing', 'Sun direction',
         'The compass direction of the sun, in degrees to the right of the panorama\'s centre.', -180, 180, 1],
        ['haze', 'Haze', 'How hazy the air is: 2 is a clear mountain sky, 10 is thick haze.', 1.7, 10, 0.1],
    ];
    const bake = [
        ['turn', 'Rotation, degrees', 'Turns the surroundings about the vertical axis.', -180, 180, 1],
        ['pitch', 'Pitch, degrees', 'Tilts the surroundings: what is ahead moves up.', -180, 180, 1],
        ['roll', 'Roll, degrees', 'Tilts the surroundings sideways: what is above moves to the right.', -180, 180, 1],
        ['up', 'Axis that points up', 'The axis of the picture\'s own directions that is up: programs such as Blender have z up.',
         { Y: 'y', Z: 'z', '-Z': '-z' }],
        ['mirror', 'Mirrored', 'Swaps left and right, for pictures that are seen from outside.'],
        ['stops', 'Exposure, stops', 'Makes the baked light brighter or darker: each stop doubles it.', -16, 16, 0.5],
        ['lamps', 'Sun and lamps',
         'What becomes of very bright, small lights: they can stay in the texture, be taken out to become a real ' +
         'light with sharp highlights and shadows, or be limited to a brightness.',
         { 'Stay in the texture': 'keep', 'Take out as lights': 'extract', 'Limit their brightness': 'clamp' }],
        ['count', 'Lights to take out', 'At most this many lights are taken out, the strongest first.', 1, 16, 1],
        ['clamp', 'Largest brightness', 'Brighter texels are darkened to this radiance; 0 lets kiln choose.', 0, 65504, 1],
        ['size', 'Size of the preview', 'Texels along an edge of the baked cube that this page shows.', SIZES],
    ];
    const see = [
        ['scene', 'Scene', 'What is drawn in the baked light.', list(NAMES.scene, [...words.scene, 'three', 'check'])],
        ['material', 'Material', 'What the balls are made of. The metals have measured colours.',
         list(NAMES.material, words.material)],
        ['method', 'Lost light added by',
         'A rough metal bounces light several times between its microscopic facets. Simple shaders lose the light ' +
         'of later bounces; this formula adds it back.', list(NAMES.method, words.method)],
        ['auto', 'Automatic brightness', 'Shows every panorama at a comfortable brightness; the files are not changed.'],
        ['background', 'Blurred background', 'Blurs the surroundings behind the balls; the light stays as it is.', 0, 1, 0.01],
        ['ground', 'Ground with shadows',
         'Puts a matte floor under the balls, with the shadows of lights that were taken out.'],
        ['occlusion', 'Balls shade each other',
         'Darkens places where a neighbouring ball hides a part of the surroundings.'],
        ['split', 'Dividing line', 'Where the two halves of the picture meet.', 0, 1, 0.01],
        ['fov', 'Lens angle, degrees',
         'Vertical field of view of the camera: a small angle is a long lens, which keeps balls round.', 5, 90, 1],
        ['samples', 'Finest picture',
         'Rays for each pixel when nothing moves: 4 means 4 x 4 rays and smooth edges.', 1, 8, 1],
    ];
    const expert = [
        ['debug', 'Show',
         'The picture, its error against a slow and exact integration of all light paths, or a table that the ' +
         'shader reads.', list(NAMES.debug, [...words.debug.filter((word) => word !== 'level'), 'error'])],
        ['noise', 'Noise of the error',
         'The integration goes on until its own noise is below this part of each pixel.', 0.01, 0.5, 0.01],
        ['alone', 'Without light between balls',
         'The integration leaves out light that goes from one ball to another, as real-time shaders do.'],
        ['cubeDiffuse', 'Soft light from a cube',
         'Takes the light of matte surfaces from a small cube map instead of nine numbers (spherical harmonics).'],
        ['reflections', 'Rough reflections',
         'How a rough surface finds its reflection in the blurred levels: where a mirror would, nearer to its ' +
         'normal, or as one, two or three places that are fitted to what it really reflects.',
         list(NAMES.reflections, words.reflections)],
        ['asPrinted', 'Repeat a known mistake',
         'Draws the assignment\'s figure 6 with the mistake that it was printed with.'],
    ];
    return { sky: ['Sky', sky], bake: ['Light', bake], see: ['View', see], expert: ['For experts', expert] };
}

// Each control writes to `state` and then calls changed(name).
export function makeControls(container, state, words, changed) {
    const gui = new GUI({ container, title: 'Controls', injectStyles: false });
    const narrow = matchMedia('(max-width: 800px)').matches;
    for (const [name, [title, controls]] of Object.entries(rows(words))) {
        const folder = gui.addFolder(title);
        if (name === 'expert' || (narrow && name !== 'see'))
            folder.close();
        for (const [property, label, sentence, ...range] of controls) {
            const controller = folder.add(state, property, ...range).name(label).onChange(() => changed(property));
            controller.domElement.title = sentence;
        }
    }
    const bare = (scene) => scene === 'furnace' || scene === 'assignment';
    const shown = {
        sun: () => state.source === 'sky', bearing: () => state.source === 'sky', haze: () => state.source === 'sky',
        count: () => state.lamps === 'extract', clamp: () => state.lamps === 'clamp',
        split: () => ['compare', 'check'].includes(state.scene), asPrinted: () => state.scene === 'assignment',
        noise: () => state.debug === 'error', alone: () => state.debug === 'error',
        material: () => !bare(state.scene), method: () => state.scene !== 'three',
        auto: () => !bare(state.scene), ground: () => !bare(state.scene) && state.scene !== 'three',
        background: () => !bare(state.scene), occlusion: () => !bare(state.scene) && state.scene !== 'three',
        debug: () => state.scene !== 'three', cubeDiffuse: () => state.scene !== 'three',
        reflections: () => !bare(state.scene) && state.scene !== 'three',
    };
    return {
        // Shows the present state, after it has changed elsewhere; hides controls without effect.
        update() {
            for (const controller of gui.controllersRecursive()) {
                controller.updateDisplay();
                controller.show(shown[controller.property]?.() ?? true);
            }
            for (const folder of gui.folders)
                folder.show(folder.controllers.some((controller) => !controller._hidden));
        },
    };
}

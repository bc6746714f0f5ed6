// The panel of controls at the right of the page, made with lil-gui.
import GUI from './lil-gui.mjs';

const SIZES = [16, 32, 64, 128, 256, 512, 1024];

// Each control writes to `state` and then calls changed(name).
export function makeControls(container, state, words, changed) {
    const gui = new GUI({ container, title: 'Controls', injectStyles: false });
    const folders = { sky: gui.addFolder('Sky'), bake: gui.addFolder('Bake'),
                      see: gui.addFolder('See') };
    const add = (folder, name, label, ...range) =>
        folders[folder].add(state, name, ...range).name(label).onChange(() => changed(name));
    add('sky', 'sun', 'sun elevation, degrees', -5, 90, 0.5);
    add('sky', 'bearing', 'sun azimuth, degrees', -180, 180, 1);
    add('sky', 'haze', 'haze (turbidity)', 1.7, 10, 0.1);
    add('bake', 'size', 'face size, texels', SIZES);
    add('bake', 'turn', 'rotation, degrees', -180, 180, 1);
    add('bake', 'stops', 'exposure, stops', -16, 16, 0.5);
    add('bake', 'light', 'take the sun out as a light');
    if (words) {
        add('see', 'scene', 'scene', words.scene);
        add('see', 'material', 'material', words.material);
        add('see', 'method', 'lost energy returned by', words.method);
        add('see', 'background', 'background blur', 0, 1, 0.01);
        add('see', 'split', 'dividing line', 0, 1, 0.01);
        add('see', 'occlusion', 'balls shade each other');
        add('see', 'ground', 'ground with shadows');
        add('see', 'cubeDiffuse', 'diffuse light from a cube');
        add('see', 'bent', 'bend towards the normal');
        add('see', 'asPrinted', 'mistake of figure 6');
        add('see', 'auto', 'automatic brightness');
        add('see', 'samples', 'samples per pixel, N x N', 1, 8, 1);
        add('see', 'debug', 'debug view', [...words.debug.filter((word) => word !== 'level'), 'error']);
        add('see', 'noise', 'error: noise limit', 0.01, 0.5, 0.01);
        add('see', 'alone', 'error: balls alone');
    }
    const only = { split: 'compare', asPrinted: 'assignment', method: null };
    return {
        // Shows the present state, after it has changed elsewhere; hides controls without effect in
        // the scene.
        update() {
            for (const controller of gui.controllersRecursive()) {
                controller.updateDisplay();
                const scene = only[controller.property];
                if (scene)
                    controller.show(state.scene === scene);
                if (controller.property === 'noise' || controller.property === 'alone')
                    controller.show(state.debug === 'error');
            }
        },
    };
}

// Environments for <Environment map={...}> of @react-three/drei, inside <Canvas> of @react-three/fiber:
//     <Environment map={useEnvironmentMap('city.ktx2')} background />
// Both hooks suspend until the texture is there, so a <Suspense> must stand around the component, and throw the
// loader's error. Textures are kept for all components, by source, options and renderer.
import { useThree } from '@react-three/fiber';
import { bakeEnvironment, loadEnvironment } from './three.mjs';

const kept = new WeakMap(); // of each renderer: a map from key to { promise, texture, error }
const places = new WeakMap(); // number of each source that is an object, as part of a key
let count = 0;

// A key that is equal for equal sources and options. Functions and signals among the options do not count.
function keyOf(what, source, options) {
    const word = (value) => {
        if (typeof value !== 'object' || value === null || value instanceof URL)
            return String(value);
        if (Object.getPrototypeOf(value) === Object.prototype)
            return `{${Object.keys(value).sort().map((key) => `${key}:${word(value[key])}`).join()}}`;
        if (!places.has(value))
            places.set(value, count++);
        return `#${places.get(value)}`;
    };
    const { onProgress, signal, ...rest } = options;
    return [what, word(source), word(rest)].join('\n');
}

function read(renderer, key, start) {
    if (!kept.has(renderer))
        kept.set(renderer, new Map());
    const entries = kept.get(renderer);
    if (!entries.has(key)) {
        const entry = {};
        entry.promise = start().then((texture) => { entry.texture = texture; }, (error) => { entry.error = error; });
        entries.set(key, entry);
    }
    const { promise, texture, error } = entries.get(key);
    if (error) {
        entries.delete(key); // the next attempt starts anew
        throw error;
    }
    if (!texture)
        throw promise;
    return texture;
}

// Loads a file that kiln baked: loadEnvironment() of kiln-ibl/three.
export function useEnvironmentMap(files) {
    const renderer = useThree((state) => state.gl);
    return read(renderer, keyOf('load', files, {}), () => loadEnvironment(files, renderer));
}

// Bakes a panorama in a worker: bakeEnvironment() of kiln-ibl/three.
export function useBakedEnvironmentMap(panorama, options = {}) {
    const renderer = useThree((state) => state.gl);
    return read(renderer, keyOf('bake', panorama, options), () => bakeEnvironment(panorama, renderer, options));
}

// Environments for <Environment map={...}> of @react-three/drei, inside <Canvas> of @react-three/fiber:
//     <Environment map={useEnvironmentMap('city.ktx2')} background />
// Both hooks suspend until the texture is there, so a <Suspense> must stand around the component, and throw the
// loader's error. Components with equal sources, options and renderers share a texture, which is disposed when the last
// of them is unmounted.
import { useThree } from '@react-three/fiber';
import { useEffect } from 'react';
import { Kept } from './kept.mjs';
import { bakeEnvironment, loadEnvironment } from './three.mjs';

const kept = new WeakMap(); // of each renderer: its textures
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

function useKept(renderer, key, start) {
    if (!kept.has(renderer))
        kept.set(renderer, new Kept());
    const textures = kept.get(renderer), entry = textures.read(key, start);
    useEffect(() => textures.use(key, entry), [textures, key, entry]);
    return entry.texture;
}

// Loads a file that kiln baked: loadEnvironment() of kiln-ibl/three.
export function useEnvironmentMap(files) {
    const renderer = useThree((state) => state.gl);
    return useKept(renderer, keyOf('load', files, {}), () => loadEnvironment(files, renderer));
}

// Bakes a panorama in a worker: bakeEnvironment() of kiln-ibl/three.
export function useBakedEnvironmentMap(panorama, options = {}) {
    const renderer = useThree((state) => state.gl);
    return useKept(renderer, keyOf('bake', panorama, options), () => bakeEnvironment(panorama, renderer, options));
}

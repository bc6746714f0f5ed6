import type { Texture } from 'three';
import type { BakeEnvironmentOptions, Files, Found, Source } from 'kiln-ibl/three';

/** Loads an environment that kiln baked, for `<Environment map={...}>` of @react-three/drei. A hook for components
 * inside `<Canvas>` that suspends until the texture is there. Throws where the running three.js cannot show the file.
 * Components that ask for the same file share the texture, which is disposed when the last of them is unmounted. */
export function useEnvironmentMap(files: Files): Texture;

/** Bakes a panorama in a worker, for `<Environment map={...}>`. A hook for components inside `<Canvas>` that suspends
 * until the texture is there. Components with equal panoramas and options share the texture, which is disposed when the
 * last of them is unmounted. */
export function useBakedEnvironmentMap(panorama: Source | Texture, options?: BakeEnvironmentOptions):
    Texture & { userData: { kiln: Found } };

import type { Texture } from 'three';
import type { BakeEnvironmentOptions, Files, Found, Source } from 'kiln-ibl/three';

/** Loads an environment that kiln baked, for `<Environment map={...}>` of @react-three/drei. A hook for components
 * inside `<Canvas>` that suspends until the texture is there. Throws where the running three.js cannot show the file.
 * The texture is kept for all components that ask for the same file. */
export function useEnvironmentMap(files: Files): Texture;

/** Bakes a panorama in a worker, for `<Environment map={...}>`. A hook for components inside `<Canvas>` that suspends
 * until the texture is there. Panorama and options that are equal give the same texture. */
export function useBakedEnvironmentMap(panorama: Source | Texture, options?: BakeEnvironmentOptions):
    Texture & { userData: { kiln: Found } };

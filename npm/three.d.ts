import type { DirectionalLight, MeshStandardMaterial, Scene, Texture } from 'three';
import type { Baked, CommonBakeOptions, Control, Harmonics, Light, Value } from 'kiln-ibl';

/** The engine of `kiln bake --for` whose files the running three.js shows. */
export const engine: 'three' | 'three-cubeuv';

/** An address, a File or Blob, or bytes. */
export type Source = string | URL | Blob | ArrayBuffer | Uint8Array;

/** One file, or the files of both engines by their names, of which the one that the running three.js shows is
 * fetched: `{ three: 'city.ktx2', 'three-cubeuv': 'city.exr' }`. */
export type Files = Source | { three?: Source; 'three-cubeuv'?: Source };

/** Loads an environment that kiln baked with `--for three` (three.js from r187 on) or `--for three-cubeuv` (r150 to
 * r186), for `scene.environment`, `scene.background` or a material's `envMap`. Is rejected with an error if the file
 * cannot be shown by the running three.js. `renderer` is the WebGLRenderer, or from r186 on the WebGPURenderer, that
 * draws the scene: the two need different textures. */
export function loadEnvironment(files: Files, renderer: object, options?: LoadOptions): Promise<Texture>;

export interface LoadOptions {
    signal?: AbortSignal;
    /** A KTX2Loader of three.js with its transcoder's path that has detected the renderer's support. Is needed for
     * KTX2 files with compressed texels, and for those in CubeUV layout. */
    ktx2Loader?: object;
}

/** Options of bake() except for the name and format of the output, which follow from the running three.js. */
export interface BakeEnvironmentOptions extends Omit<CommonBakeOptions, 'for' | 'output' | 'format'> {
    /** Texels along the edge of a face of the finest level, by default 256. */
    size?: number;
    /** Need not be given: it must be `engine`. */
    for?: typeof engine;
    output?: never;
    format?: never;
    [option: string]: Value | Control[keyof Control];
}

/** What a bake found, in `texture.userData.kiln`. */
export type Found = Omit<Baked, 'files'>;

/** Bakes a panorama (EXR, HDR, PNG, JPEG, or a texture that a loader of three.js made of a panorama) in a worker,
 * and loads the result like loadEnvironment(). Replaces `PMREMGenerator.fromEquirectangular(texture).texture`.
 * Options are those of bake(). `texture.userData.kiln` holds lights and spherical harmonics. */
export function bakeEnvironment(panorama: Source | Texture, renderer: object, options?: BakeEnvironmentOptions):
    Promise<Texture & { userData: { kiln: Found } }>;

export interface LightOptions {
    /** Radius of the sphere around the origin in which objects cast and receive shadows; 0 is without shadows. */
    shadows?: number;
    /** The scene's renderer. Up to r164, its useLegacyLights decides what an intensity means. */
    renderer?: object;
}

/** Adds directional lights to a scene: those that kiln took out of the environment with `--sun extract`, as read from
 * the file of `--lights-file` or as `lights` of a bake. Their intensity is the irradiance of a surface that faces the
 * light. Returns the lights, which may be changed. */
export function addLights(scene: Scene, lights: readonly Light[] | { lights: readonly Light[] },
                          options?: LightOptions): DirectionalLight[];

export interface TrueReflectionsOptions {
    /** Number of directions in which each pixel reads the environment; by default 2. */
    taps?: 1 | 2 | 3;
    /** Spherical harmonics of the environment's radiance, as `kiln bake --sh sh.json` writes them. Are needed where the
     * environment has none: those of kiln's cubes, of CubeUV pictures in .exr files and of bakeEnvironment() have them. */
    sh?: Harmonics;
}

/** Makes a MeshStandardMaterial or a MeshPhysicalMaterial reflect `environment`, which is the scene's environment or the
 * material's envMap, by the lobe that a rough surface has in place of one round lobe. Changes the material's shader by
 * onBeforeCompile, for WebGLRenderer of r150 to r187; is rejected with an error for other versions, for anisotropic
 * materials, and for an environment without spherical harmonics. Call the function again after the environment or the
 * number of taps has changed, and for clones of the material. Resolves to the material. */
export function trueReflections<M extends MeshStandardMaterial>(
    material: M, environment: Texture, options?: TrueReflectionsOptions): Promise<M>;

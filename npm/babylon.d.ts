import type { Baked, CommonBakeOptions, Harmonics, Light } from 'kiln-ibl';

/** An address, a File or Blob, or bytes. */
export type Source = string | URL | Blob | ArrayBuffer | Uint8Array;

/** A class of Babylon.js, from babylonjs or @babylonjs/core. */
type Class<T> = new (...values: any[]) => T;
type Made<C> = C extends { CubeTexture: Class<infer T> } ? T : any;
type MadeLight<C> = C extends { DirectionalLight: Class<infer T> } ? T : any;

/** Classes of Babylon.js that make environments; needed where Babylon.js is not the global BABYLON. */
export interface EnvironmentClasses {
    CubeTexture: Class<any>;
}

/** Classes of Babylon.js that make lights; ShadowGenerator is needed for shadows alone. */
export interface LightClasses {
    Color3: Class<any>;
    DirectionalLight: Class<any>;
    Vector3: Class<any>;
    ShadowGenerator?: Class<any>;
}

/** Loads an environment that kiln baked with `--for babylon` (.env) or `--for babylon-dds` (.dds), for
 * `scene.environmentTexture`. Resolves to a CubeTexture whose texels have arrived. */
export function loadEnvironment<C extends EnvironmentClasses>(source: Source, scene: object,
    options?: { babylon?: C; signal?: AbortSignal }): Promise<Made<C>>;

/** Options of bake() except for the name of the output. */
export interface BakeEnvironmentOptions<C> extends Omit<CommonBakeOptions, 'output'> {
    for?: 'babylon' | 'babylon-dds';
    output?: never;
    babylon?: C;
    [option: string]: unknown;
}

/** Bakes a panorama (EXR, HDR, PNG, JPEG) in a worker, and loads the result like loadEnvironment().
 * `texture.metadata.kiln` holds lights and spherical harmonics, as Found describes them. */
export function bakeEnvironment<C extends EnvironmentClasses>(
    source: Source, scene: object, options?: BakeEnvironmentOptions<C>): Promise<Made<C>>;

/** What a bake found, in `texture.metadata.kiln`. */
export type Found = Omit<Baked, 'files'>;

export interface LightOptions<C> {
    /** Radius of the sphere around the origin in which meshes cast and receive shadows. Each light then has a shadow
     * generator, which must be told the meshes: `light.getShadowGenerator().addShadowCaster(mesh)`. Meshes with
     * `receiveShadows` show the shadows. 0 is without shadows. */
    shadows?: number;
    babylon?: C;
}

/** Adds directional lights to a scene: those that kiln took out of the environment with `--sun extract`, as read from
 * the file of `--lights-file` or as `lights` of a bake. Their intensity is the irradiance of a surface that faces the
 * light. Returns the lights. */
export function addLights<C extends LightClasses>(
    scene: object, lights: readonly Light[] | { lights: readonly Light[] }, options?: LightOptions<C>): MadeLight<C>[];

/** Classes of Babylon.js, from version 5 on, that change a material's shader. */
export interface ReflectionClasses {
    MaterialPluginBase: Class<any>;
    RawTexture: Class<any>;
}

export interface TrueReflectionsOptions<C> {
    /** Number of directions in which each pixel reads the environment; by default 2. */
    taps?: 1 | 2 | 3;
    /** Spherical harmonics of the environment's radiance, as `kiln bake --sh sh.json` writes them. Are needed for .dds
     * files; .env files and bakeEnvironment() have them. */
    sh?: Harmonics;
    babylon?: C;
}

/** Makes a PBRMaterial, PBRMetallicRoughnessMaterial or PBRSpecularGlossinessMaterial reflect `environment`, which is the
 * scene's environmentTexture or the material's reflectionTexture, by the lobe that a rough surface has in place of one
 * round lobe. Adds a material plugin for WebGL 2. Is rejected with an error for anisotropic materials and for an
 * environment without spherical harmonics. Call the function again after the environment has changed. Resolves to the
 * material. */
export function trueReflections<M extends object, C extends ReflectionClasses>(
    material: M, environment: object, options?: TrueReflectionsOptions<C>): Promise<M>;

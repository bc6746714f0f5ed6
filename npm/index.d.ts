// Types of the package kiln-ibl. The same functions stand in Node and in browsers; each call works in a worker of
// its own, which is a thread in Node.

/** A picture in memory: linear radiance, rows from the top, texels from the left. */
export interface Picture {
    /** 3 or 4 numbers for each texel; a fourth number is ignored. */
    data: Float32Array;
    /** Texels in a row. */
    width: number;
    /** Rows: `width / 2` for a panorama; `6 * width` for the six faces of a cube below each other, in the order
     * +X -X +Y -Y +Z -Z. */
    height: number;
}

/** The bytes of a picture file that kiln reads (EXR, HDR, PNG, JPEG, KTX2, DDS, KTX), or a picture in memory. */
export type Input = Uint8Array | ArrayBuffer | Blob | Picture;

/** A file in memory. `name` may hold folders, separated by slashes. */
export interface File {
    name: string;
    bytes: Uint8Array;
}

export interface Control {
    /** Is told how far the work is: a fraction from 0 to 1 of a stage such as "filtering". */
    onProgress?: (fraction: number, stage: string) => void;
    /** Ends the work; the promise is then rejected with the signal's reason. */
    signal?: AbortSignal;
}

export type Value = string | number | boolean | readonly number[] | null | undefined;

/** The common options of the command `kiln bake`. */
export interface CommonBakeOptions extends Control {
    /** The name of the input, such as "city.exr". The file's format is read from its content. */
    name?: string;
    /** The engine whose files are wanted, one of the names in `engines`. */
    for?: string;
    /** Texels along the edge of a cubemap face, or rows of a panorama. */
    size?: number;
    /** Number of mip levels. */
    levels?: number;
    /** Names of the files to make. By default the input's name with the ending of the engine's files, or .ktx2. */
    output?: string;
    format?: string;
    tune?: 'none' | 'sharp' | 'soft';
    /** Compression of KTX2 files by Zstandard, 1 to 22; `true` is level 3. */
    zstd?: number | boolean;
    /** Yaw, or yaw, pitch and roll, in degrees. */
    rotate?: number | readonly number[];
    /** In stops: radiance is multiplied by 2^exposure. */
    exposure?: number;
    /** What becomes of the sun: 'keep', 'extract', 'clamp=auto' or 'clamp=RADIANCE'. */
    sun?: string;
}

/** Every option of the command `kiln bake`, by its name with or without camel case: `irradianceSize: 32` is
 * `--irradiance-size 32`, `mirror: true` is `--mirror`, a list of numbers is joined by commas. The command checks
 * them; `kiln help bake` describes all. */
export interface BakeOptions extends CommonBakeOptions {
    [option: string]: Value | Control[keyof Control];
}

/** A light that was taken out of the environment. */
export interface Light {
    /** Unit vector towards the light. */
    direction: [number, number, number];
    /** Irradiance of a surface that faces the light: red, green, blue. */
    irradiance: [number, number, number];
    /** Angular radius in degrees. */
    angular_radius: number;
    /** Part of the light of the whole environment. */
    share: number;
    /** Number of the input's texels that held the light. */
    texels: number;
}

/** What `kiln bake` writes with --sh to a .json file. */
export interface Harmonics {
    bands: number;
    /** Whether the coefficients are those of irradiance, else of radiance. */
    irradiance: boolean;
    window: number;
    /** The basis and its order, in words. */
    basis: string;
    /** Red, green and blue of each coefficient. */
    coefficients: [number, number, number][];
}

/** What `bake` is rejected with if the command fails. */
export interface KilnError extends Error {
    name: 'KilnError';
    /** The command's sentence, with the numbers and the way out. */
    message: string;
    /** 1 for bad input, 2 for options that are not there or contradict each other. */
    exitCode: number;
    /** All that the command printed on standard error. */
    stderr: string;
}

export interface Baked {
    /** The files that the engine loads, and those that were asked for by options. */
    files: File[];
    /** Size in texels and roughness of each mip level. */
    levels: { size: number; roughness: number }[];
    /** Spherical harmonics of the radiance, unless options ask for others; null if the option `sh` names a file
     * that is no .json. */
    sh: Harmonics | null;
    /** The lights that were taken out with `sun: 'extract'`. */
    lights: Light[];
    /** What `kiln bake --json` reports, with what was found in the input and cut off in the output. */
    report: any;
}

/** Bakes one environment: a file, a picture, or the files of six faces, whose names say which face each is, such as
 * px.png. Is rejected with a KilnError, whose message is the command's own. */
export function bake(input: Input | readonly { name: string; bytes: Input }[], options?: BakeOptions): Promise<Baked>;

export interface Run {
    /** 0, or 1 for bad input and 2 for a wrong command line. */
    code: number;
    stdout: Uint8Array;
    /** Notes, warnings and error messages, each on a line. */
    stderr: string;
    /** The files that the command wrote. */
    files: File[];
}

/** Runs the command `kiln` with the words of a command line on files in memory, for example
 * `kiln(['info', 'city.exr'], { files: [{ name: 'city.exr', bytes }] })`. */
export function kiln(words: readonly string[], options?: Control & {
    files?: readonly File[];
    /** Standard input, which the name `-` reads. */
    input?: Uint8Array;
}): Promise<Run>;

export interface Engine {
    name: string;
    title: string;
    /** Which files the engine loads, in words. */
    files: string;
    /** The ending of the engine's files without its dot; empty where any ending will do. */
    ending: string;
    /** How mip levels follow from roughness, in words. */
    mapping: string;
    /** Texels along the edge of a face and number of levels, by default. */
    size: number;
    level_count: number;
    /** Greatest radiance that the files hold in the default format. */
    limit: number;
    /** The formats of the files, the default first. */
    formats: string[];
    /** Why the first format is the default, for engines with a choice. */
    format_reason?: string;
    /** The ending of the engine's files in each of these formats. */
    endings: string[];
    tune: 'none' | 'sharp';
    proof: string;
}

/** The engines that `for` names: what `kiln engines --json` prints. */
export const engines: readonly Engine[];

/** The version of the package and of the command in it. */
export const version: string;

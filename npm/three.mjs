// Prefiltered environments in three.js, r150 and later:
//     scene.environment = await loadEnvironment('city.ktx2', renderer);   // a file that kiln baked
//     scene.environment = await bakeEnvironment('city.hdr', renderer);    // any panorama, baked in a worker
//     addLights(scene, lights);                                           // lights taken out of the environment
//     await trueReflections(material, scene.environment);                 // the lobe of a rough surface as it is
// From r187 on, three.js keeps a prefiltered environment in a cube map, before in one flat picture called CubeUV.
// kiln's engines "three" and "three-cubeuv" write these two. A file of the wrong one would be shown black or be
// filtered again, so the functions check the file and the running version, and throw an error.
import { Color, CompressedTexture, CubeReflectionMapping, CubeTexture, DataTexture, DataUtils, DirectionalLight, HalfFloatType,
         LinearFilter, LinearMipmapLinearFilter, REVISION, RGBAFormat } from 'three';
import { kindOf, openFile } from './fetch.mjs';

export { trueReflections } from './three-lobes.mjs';

// The first versions that show CubeUV files, CubeUV files in WebGPURenderer, and cubes; and the first whose KTX2Loader
// reads UASTC HDR.
const OLDEST = 150, OLDEST_GPU = 186, CUBES = 187, OLDEST_UASTC = 170;
const CUBE_UV_MAPPING = 306;     // CubeUVReflectionMapping, which r187 no longer exports
const RGB_FORMAT = 1022, UNSIGNED_INT_5999 = 35902; // RGBFormat and UnsignedInt5999Type, which r150 does not export
const revision = parseInt(REVISION, 10);

// The engine of `kiln bake --for` whose files the running three.js shows.
export const engine = revision >= CUBES ? 'three' : 'three-cubeuv';

function checkVersion(renderer) {
    if (revision < OLDEST)
        throw new Error(`kiln-ibl/three: this is three.js r${REVISION}; environments are loaded from r${OLDEST} on`);
    if (!renderer?.isWebGLRenderer && !renderer?.isWebGPURenderer)
        throw new Error('kiln-ibl/three: the second argument must be the renderer of the scene, a WebGLRenderer or ' +
                        'a WebGPURenderer');
    if (renderer.isWebGPURenderer && revision < OLDEST_GPU)
        throw new Error(`kiln-ibl/three: WebGPURenderer of three.js r${REVISION} shows loaded environments upside ` +
                        `down; use WebGLRenderer, or three.js from r${OLDEST_GPU} on`);
}

// ---------------------------------------------------------------------------------------------- cubes (KTX2)

const RGBA16F = 97, RGB9E5 = 123, UASTC = 1000066000, ZSTD = 2; // VkFormats and a supercompression scheme of KTX2

// Header, levels and metadata of a KTX2 file. All numbers are little-endian, and those of 64 bits are below 2^53.
function readKtx2({ name, bytes }) {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const u32 = (at) => view.getUint32(at, true), u64 = (at) => Number(view.getBigUint64(at, true));
    try {
        const levels = Array.from({ length: Math.max(1, u32(40)) }, (_, k) => {
            const at = 80 + 24 * k, [offset, length] = [u64(at), u64(at + 8)];
            if (offset + length > bytes.length)
                throw new RangeError();
            return { data: bytes.slice(offset, offset + length), size: u64(at + 16) };
        });
        const metadata = new TextDecoder('latin1').decode(bytes.subarray(u32(56), u32(56) + u32(60)));
        return { format: u32(12), width: u32(20), height: u32(24), faces: u32(36), scheme: u32(44), levels, metadata };
    } catch (error) {
        if (error instanceof RangeError)
            throw new Error(`${name}: the KTX2 file ends after ${bytes.length} bytes, before its texels end`);
        throw error;
    }
}

// Levels for three.js have the roughness r = 1 - sqrt(1 - k / (n - 1)), as PMREMGenerator.lodToRoughness has.
function checkRoughness(name, metadata, count) {
    const text = metadata.match(/kiln:roughness\0([\d.e+ -]+)/)?.[1];
    const found = text?.trim().split(' ').map(Number) ?? [];
    if (found.some((r, k) => Math.abs(r - (1 - Math.sqrt(1 - k / (count - 1)))) > 1e-4))
        throw new Error(`${name}: the levels have the roughnesses ${found.map((r) => +r.toFixed(3)).join(' ')}, ` +
                        'which are not those of three.js; bake the file with --for three');
}

// The spherical harmonics of the radiance that the metadata hold in the axes of three.js, in kiln's axes, in which
// bake() gives them: kiln's (x, y, z) is (z, y, -x) of three.js.
function readHarmonics(metadata) {
    const text = metadata.match(/kiln:sh\0bands 3\nirradiance 0\nwindow 0\n([\d.e+\- \n]+)/)?.[1];
    if (!text)
        return null;
    const c = text.trim().split('\n').map((line) => line.split(' ').map(Number));
    const minus = (a) => a.map((x) => -x), half = Math.sqrt(3) / 2;
    const coefficients = [c[0], c[1], minus(c[3]), c[2], c[5], minus(c[4]), c[8].map((x, i) => half * x - c[6][i] / 2),
                          minus(c[7]), c[6].map((x, i) => half * x + c[8][i] / 2)];
    return { bands: 3, irradiance: false, window: 0, coefficients };
}

async function unzip(levels) {
    const { ZSTDDecoder } = await import('three/addons/libs/zstddec.module.js');
    const decoder = new ZSTDDecoder();
    await decoder.init();
    return levels.map(({ data, size }) => decoder.decode(data, size));
}

// What three.js must know of a cube: that it need not be filtered again, and that it is not mirrored in x, as cubes are
// that are not render targets. WebGPURenderer would not upload the texels of a render target, so that the texels
// themselves are mirrored for it.
const CUBE = { minFilter: LinearMipmapLinearFilter, isPMREMTexture: true, isRenderTargetTexture: true };

// The six faces of each level as an array of halves, or of words that hold a texel each: [level][face].
const splitFaces = (levels, Numbers) => levels.map((all) => Array.from({ length: 6 }, (_, face) => {
    const length = all.length / 6;
    return new Numbers(all.slice(face * length, (face + 1) * length).buffer);
}));

// Returns the texels of rgb9e5, of which a word holds three whole numbers of 9 bits and the exponent of two by which
// all three are multiplied, as four halves each. Halves hold all these values exactly.
function toHalves(words) {
    const halves = new Uint16Array(4 * words.length).fill(0x3c00);
    words.forEach((word, i) => {
        const scale = 2 ** ((word >>> 27) - 24);
        for (let c = 0; c < 3; c++)
            halves[4 * i + c] = DataUtils.toHalfFloat((word >>> 9 * c & 511) * scale);
    });
    return halves;
}

// The mirror image of a cube in x: +X and -X change places, and the rows of all faces are reversed.
function mirror([right, left, ...others], width) {
    const faces = [left, right, ...others];
    for (const halves of faces) {
        const texels = new BigUint64Array(halves.buffer); // of four halves
        for (let at = 0; at < texels.length; at += width)
            texels.subarray(at, at + width).reverse();
    }
    return faces;
}

// Reads a compressed file by KTX2Loader, which knows what the GPU can hold. Up to r162 the loader reads from addresses
// alone.
async function readByLoader({ name, bytes }, format, { ktx2Loader }) {
    if (!ktx2Loader)
        throw new Error(`${name}: its texels have the VkFormat ${format}, which KTX2Loader reads; pass the option ` +
                        'ktx2Loader: new KTX2Loader().setTranscoderPath(PATH).detectSupport(renderer)');
    const url = URL.createObjectURL(new Blob([bytes]));
    try {
        return await ktx2Loader.loadAsync(url);
    } catch (error) {
        throw new Error(`${name}: KTX2Loader cannot read the file: ${error?.message ?? error}`);
    } finally {
        URL.revokeObjectURL(url);
    }
}

async function makeCube(file, ktx2, renderer, options) {
    const { name } = file, { format, width, scheme, levels, metadata } = ktx2;
    if (engine !== 'three')
        throw new Error(`${name}: three.js shows cubes like this from r${CUBES} on, and this is r${REVISION}; ` +
                        `bake the file with --for ${engine}`);
    checkRoughness(name, metadata, levels.length);
    const gpu = Boolean(renderer.isWebGPURenderer);
    if (![RGBA16F, RGB9E5].includes(format) || (scheme !== 0 && scheme !== ZSTD)) {
        if (gpu)
            throw new Error(`${name}: for WebGPURenderer the cube must be mirrored, which its VkFormat ${format} ` +
                            'does not allow; bake it with --format rgba16f, or use WebGLRenderer');
        return Object.assign(await readByLoader(file, format, options), CUBE);
    }
    const texels = scheme === ZSTD ? await unzip(levels) : levels.map(({ data }) => data);
    const cubes = splitFaces(texels, format === RGBA16F ? Uint16Array : Uint32Array);
    if (format === RGB9E5 && !gpu)
        return makeSharedExponents(cubes, width);
    return makeHalves(cubes.map((cube, k) => {
        const halves = format === RGBA16F ? cube : cube.map(toHalves);
        return gpu ? mirror(halves, width >> k) : halves;
    }), width, gpu);
}

// Makes a texture of the halves of all levels and faces.
function makeHalves(cubes, width, gpu) {
    const sides = Array.from({ length: 6 }, (_, face) => ({
        width, height: width,
        mipmaps: cubes.map((cube, k) => ({ width: width >> k, height: width >> k, data: cube[face] })),
    }));
    // This is a CompressedCubeTexture, which r150 does not have. The formats of CompressedTexture may be uncompressed.
    const texture = new CompressedTexture([], width, width, RGBAFormat, HalfFloatType, CubeReflectionMapping);
    return Object.assign(texture, {
        image: sides, isCubeTexture: true, isCompressedCubeTexture: true, ...CUBE, isRenderTargetTexture: !gpu,
    });
}

// Makes a texture of texels of rgb9e5. three.js passes the levels of a CompressedTexture to WebGL as blocks unless they
// are RGBA, so that this is a CubeTexture, whose mipmaps are the levels after the first. The shader takes the number of
// levels from the first face of a texture that is called a CompressedCubeTexture.
function makeSharedExponents(cubes, width) {
    const [first, ...others] = cubes.map((cube, k) => cube.map((data) => ({
        isDataTexture: true, image: { width: width >> k, height: width >> k, data },
    })));
    first[0].mipmaps = cubes.map((_, k) => ({ width: width >> k, height: width >> k }));
    const texture = new CubeTexture(first, CubeReflectionMapping);
    return Object.assign(texture, {
        mipmaps: others.map((image) => ({ image })), format: RGB_FORMAT, type: UNSIGNED_INT_5999,
        magFilter: LinearFilter, isCompressedCubeTexture: true, ...CUBE,
    });
}

// ------------------------------------------------------------------------------------- CubeUV (EXR and KTX2)

const CUBE_UV = { mapping: CUBE_UV_MAPPING, magFilter: LinearFilter, minFilter: LinearFilter };

function checkCubeUv(name, width, height) {
    if (3 * height !== 4 * width || height & (height - 1))
        throw new Error(`${name}: a picture of ${width} x ${height} is not an environment in CubeUV layout, which ` +
                        `has 3/4 as many columns as rows; bake it with --for ${engine}, or call bakeEnvironment()`);
}

async function makeCubeUv({ name, bytes }) {
    if (engine !== 'three-cubeuv')
        throw new Error(`${name}: three.js shows EXR environments up to r${CUBES - 1}, and this is r${REVISION}; ` +
                        `bake the panorama with --for ${engine}, or call bakeEnvironment()`);
    const { EXRLoader } = await import('three/addons/loaders/EXRLoader.js');
    const { data, width, height, format, type } = new EXRLoader().parse(bytes.slice().buffer);
    checkCubeUv(name, width, height);
    return Object.assign(new DataTexture(data, width, height, format, type), CUBE_UV);
}

async function makeKtx2(file, renderer, options) {
    const { name } = file, ktx2 = readKtx2(file), { format, width, height, faces } = ktx2;
    if (faces === 6) {
        const texture = await makeCube(file, ktx2, renderer, options);
        texture.userData.kiln = { sh: readHarmonics(ktx2.metadata) };
        return texture;
    }
    if (engine !== 'three-cubeuv')
        throw new Error(`${name}: the KTX2 file holds a flat picture and not a cube; bake it with --for ${engine}`);
    checkCubeUv(name, width, height);
    if (format === UASTC && revision < OLDEST_UASTC)
        throw new Error(`${name}: KTX2Loader reads UASTC HDR from r${OLDEST_UASTC} on, and this is r${REVISION}; ` +
                        `bake an .exr with --for ${engine}`);
    return Object.assign(await readByLoader(file, format, options), CUBE_UV);
}

// ------------------------------------------------------------------------------------------------ functions

// Makes a texture for a renderer from the bytes of a file that kiln baked.
async function makeTexture(file, renderer, options) {
    const kind = kindOf(file.bytes);
    if (kind !== 'KTX2' && kind !== 'EXR')
        throw new Error(`${file.name}: the file is of the kind "${kind}", and not an environment that kiln baked ` +
                        `with --for ${engine}; bakeEnvironment() bakes panoramas`);
    const texture = await (kind === 'KTX2' ? makeKtx2 : makeCubeUv)(file, renderer, options);
    texture.name = file.name;
    texture.generateMipmaps = false;
    texture.needsUpdate = true;
    return texture;
}

export async function loadEnvironment(source, renderer, options = {}) {
    checkVersion(renderer);
    if (!source)
        throw new Error(`kiln-ibl/three: the first argument must be a file of kiln bake --for ${engine}: an address, ` +
                        'a File, or bytes');
    const files = source.three ?? source['three-cubeuv'] ? source : { [engine]: source };
    if (!files[engine])
        throw new Error(`kiln-ibl/three: three.js r${REVISION} needs the file of kiln bake --for ${engine}, ` +
                        `and only ${Object.keys(files).join()} is given`);
    return makeTexture(await openFile(files[engine], { signal: options.signal }), renderer, options);
}

export async function bakeEnvironment(source, renderer, { size, ...options } = {}) {
    checkVersion(renderer);
    if (options.for !== undefined && options.for !== engine)
        throw new Error(`kiln-ibl/three: bakeEnvironment() bakes for the running three.js r${REVISION}, which shows ` +
                        `files of --for ${engine}; leave out the option for, which is ${JSON.stringify(options.for)}`);
    const { bake, readPanorama } = await import('./three-bake.mjs'); // which those who only load do not need
    const input = source?.isTexture ? { name: source.name || 'panorama', bytes: readPanorama(source) }
                                    : await openFile(source, options);
    // The size of CubeUV files is that of the cube that they are made of, which is twice the size of a face.
    const texels = size && { size: engine === 'three' ? size : 2 * size };
    const { files, levels, sh, lights, report } = await bake(input.bytes, { name: input.name, ...options, ...texels,
                                                                           for: engine });
    const texture = await makeTexture(files[0], renderer, {});
    texture.userData.kiln = { levels, sh: sh ?? texture.userData.kiln?.sh, lights, report };
    return texture;
}

// Up to r154, renderers multiply the intensity of lights by pi unless useLegacyLights is false.
const scaleOf = (renderer) => (renderer?.useLegacyLights ?? revision < 155 ? 1 / Math.PI : 1);

// The intensity of a light is set to the irradiance of a surface that faces the light. A white diffuse surface then
// reflects the radiance irradiance / pi. A direction (x, y, z) of kiln is (-z, y, x) in three.js.
export function addLights(scene, lights, { shadows = 0, renderer } = {}) {
    const scale = scaleOf(renderer);
    return (lights.lights ?? lights).map(({ direction: [x, y, z], irradiance }) => {
        const brightest = Math.max(...irradiance);
        const light = new DirectionalLight(new Color(...irradiance.map((e) => e / brightest)), scale * brightest);
        light.position.set(-z, y, x).multiplyScalar(2 * (shadows || 1)); // shines to the origin
        if (shadows) {
            light.castShadow = true;
            light.shadow.mapSize.set(2048, 2048);
            Object.assign(light.shadow.camera, { left: -shadows, right: shadows, bottom: -shadows, top: shadows,
                                                 near: shadows, far: 3 * shadows });
        }
        scene.add(light);
        return light;
    });
}

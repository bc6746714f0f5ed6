// True reflections in three.js, WebGLRenderer of r150 to r187:
//     scene.environment = await loadEnvironment('city.ktx2', renderer);
//     await trueReflections(material, scene.environment, { taps: 2 });
// A rough surface reflects a lobe that leans towards the normal and is longer than it is wide. three.js shows one round
// lobe instead. The function replaces the radiance of that lobe, in the shader of a MeshStandardMaterial or a
// MeshPhysicalMaterial, by what a table of kiln and nine spherical harmonics tell.
import * as three from 'three';
import { DataTexture, DataUtils, HalfFloatType, LinearFilter, REVISION, RGBAFormat, Vector3 } from 'three';
import { SIZE, basisAt, checkHarmonics, decodeTable, lightOf, shader } from './lobes.mjs';

const OLDEST = 150, NEWEST = 187, CUBES = 187; // the versions whose shaders are known, and the first with cubes
const CUBE_UV_MAPPING = 306;
const revision = parseInt(REVISION, 10);
const WHO = 'kiln-ibl/three: trueReflections()';

// A direction (x, y, z) of three.js is (z, y, -x) in kiln.
const AXES = [[0, 0, -1], [0, 1, 0], [1, 0, 0]];

// Each number of taps has a module of its own, of which only the one asked for is loaded.
const TABLES = revision >= CUBES
    ? [() => import('./lobes/three-1.mjs'), () => import('./lobes/three-2.mjs'), () => import('./lobes/three-3.mjs')]
    : [() => import('./lobes/three-cubeuv-1.mjs'), () => import('./lobes/three-cubeuv-2.mjs'),
       () => import('./lobes/three-cubeuv-3.mjs')];

// How the shader reads a level of the table's chain: a level of a cube with 6 levels, to which the levels of a cube with
// another number are stretched, or a level of a CubeUV picture with faces of 256 texels, whose mip 8 is level 0. Larger
// CubeUV pictures have further levels before, and smaller ones lack the first.
const READ = revision >= CUBES
    ? 'return textureLod( envMap, way, lod / 5.0 * ENVMAP_MAX_LOD ).rgb;'
    : `float mip = clamp( 8.0 - lod, cubeUV_m0, CUBEUV_MAX_MIP ), low = floor( mip );
	return mix( bilinearCubeUV( envMap, way, low ), bilinearCubeUV( envMap, way, low + 1.0 ), mip - low );`;
const TYPE = revision >= CUBES ? 'ENVMAP_TYPE_PMREM' : 'ENVMAP_TYPE_CUBE_UV';

// The statement of three.js that reads the environment for a lobe that is not anisotropic.
const CALL = /getIBLRadiance\(\s*(\w+\.?\w*),\s*(\w+\.?\w*),\s*material\.roughness\s*\)/g;

// Parts of shaders, which the build of three.js with WebGPURenderer does not have.
const chunk = (name) => three.ShaderChunk?.[name] ?? '';

function checkVersion() {
    if (!three.ShaderChunk)
        throw new Error(`${WHO} changes shaders of WebGLRenderer, and this is the build of three.js that has ` +
                        'WebGPURenderer; import three in place of three/webgpu');
    const known = chunk('lights_fragment_maps').match(CALL)?.length === 1 &&
                  chunk('envmap_physical_pars_fragment').includes(TYPE);
    if (revision < OLDEST || revision > NEWEST || !known)
        throw new Error(`${WHO} knows the shaders of three.js r${OLDEST} to r${NEWEST}, and this is r${REVISION}`);
}

function checkMaterial(material) {
    if (!material?.isMeshStandardMaterial)
        throw new Error(`${WHO}: the first argument must be a MeshStandardMaterial or a MeshPhysicalMaterial, and is ` +
                        `${material?.type ?? typeof material}`);
    if (material.anisotropy > 0)
        throw new Error(`${WHO}: the material's anisotropy is ${material.anisotropy}, and the tables are those of ` +
                        'isotropic lobes; set it to 0, or leave this material as it is');
}

// What is added to the shader. Vectors of the shader are in the camera's frame, and `turn` turns them into the frame of
// the environment.
const makeFunctions = (taps) => `
#if defined( USE_ENVMAP ) && defined( ${TYPE} )
${shader(taps, READ)}
vec3 kilnRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
	mat3 turn = transpose( mat3( viewMatrix ) );
	${chunk('envmap_physical_pars_fragment').includes('envMapRotation') ? 'turn = envMapRotation * turn;' : ''}
	return envMapIntensity * kilnReflection( viewDir, normal, roughness, turn );
}
#elif defined( USE_ENVMAP )
#define kilnRadiance getIBLRadiance
#endif
`;

function replaceOnce(text, include, by) {
    const parts = text.split(include);
    if (parts.length !== 2)
        throw new Error(`${WHO}: the shader of the material has ${include} ${parts.length - 1} times, and must have ` +
                        'it once; other code in onBeforeCompile has changed it');
    return parts.join(by);
}

// Direction of a point of each face of a CubeUV picture in kiln's axes, s to the right and t upwards, -1 to 1.
const FACES = [(s, t) => [s, t, -1], (s, t) => [-t, 1, s], (s, t) => [1, t, s], (s, t) => [-s, t, 1],
               (s, t) => [t, -1, s], (s, t) => [-1, t, -s]];

// The spherical harmonics of a CubeUV picture whose texels are in memory: the sum over all texels of the finest faces,
// which stand at the bottom, three beside each other in two rows, each with a border of one texel.
function sumHarmonics({ image: { data, width }, type }) {
    const size = width / 3, inner = size - 2, sums = Array.from({ length: 9 }, () => [0, 0, 0]);
    const decode = type === HalfFloatType ? DataUtils.fromHalfFloat : (x) => x;
    FACES.forEach((toWay, face) => {
        for (let i = 0; i < inner * inner; i++) {
            const x = i % inner, y = Math.floor(i / inner);
            const way = toWay(2 * (x + 0.5) / inner - 1, 2 * (y + 0.5) / inner - 1), length = Math.hypot(...way);
            const basis = basisAt(...way.map((a) => a / length)), angle = 4 / (inner * inner * length ** 3);
            const at = 4 * ((Math.floor(face / 3) * size + y + 1) * width + face % 3 * size + x + 1);
            for (let c = 0; c < 3; c++) {
                const light = angle * decode(data[at + c]);
                basis.forEach((value, k) => { sums[k][c] += light * value; });
            }
        }
    });
    return { bands: 3, irradiance: false, window: 0, coefficients: sums };
}

// Harmonics that the loader kept, or those of texels in memory.
function findHarmonics(environment) {
    environment.userData ??= {};
    const kept = environment.userData.kiln ??= {};
    if (!kept.sh && environment.mapping === CUBE_UV_MAPPING && environment.image?.data)
        kept.sh = sumHarmonics(environment);
    return kept.sh;
}

const textures = new Map(); // of tables, by the number of taps
async function loadTable(taps) {
    if (!textures.has(taps)) {
        const halves = decodeTable((await TABLES[taps - 1]()).default);
        const texture = new DataTexture(halves, SIZE, SIZE * (taps + 1), RGBAFormat, HalfFloatType);
        Object.assign(texture, { minFilter: LinearFilter, magFilter: LinearFilter, generateMipmaps: false,
                                 needsUpdate: true, name: `kiln lobes ${taps}` });
        textures.set(taps, texture);
    }
    return textures.get(taps);
}

const changed = new WeakMap(); // materials that have been changed, with what their shaders read
function change(material, state) {
    const { onBeforeCompile, customProgramCacheKey } = material;
    material.onBeforeCompile = function (program, renderer) {
        onBeforeCompile.call(this, program, renderer);
        Object.assign(program.uniforms, { kilnLobes: state.lobes, kilnLight: state.light });
        const functions = chunk('envmap_physical_pars_fragment') + makeFunctions(state.taps);
        program.fragmentShader = replaceOnce(
            replaceOnce(program.fragmentShader, '#include <envmap_physical_pars_fragment>', functions),
            '#include <lights_fragment_maps>',
            chunk('lights_fragment_maps').replace(CALL, 'kilnRadiance( $1, $2, material.roughness )'));
    };
    material.customProgramCacheKey = function () {
        return `${customProgramCacheKey.call(this)} kiln ${state.taps}`;
    };
}

// The nine vectors of the shader.
function makeLight(environment, sh) {
    if (!environment?.isTexture)
        throw new Error(`${WHO}: the second argument must be the texture that lights the material`);
    const found = sh ?? findHarmonics(environment);
    if (!found)
        throw new Error(`${WHO}: the environment has no spherical harmonics; pass the option sh with what "kiln bake ` +
                        '--sh sh.json" writes');
    return lightOf(checkHarmonics(found, WHO), AXES).map((rgb) => new Vector3(...rgb));
}

export async function trueReflections(material, environment, { taps = 2, sh } = {}) {
    checkVersion();
    checkMaterial(material);
    if (![1, 2, 3].includes(taps))
        throw new Error(`${WHO}: taps is ${taps}, and must be 1, 2 or 3`);
    const light = makeLight(environment, sh), lobes = await loadTable(taps);
    const state = changed.get(material) ?? { lobes: {}, light: {} };
    state.lobes.value = lobes;
    state.light.value = light;
    state.taps = taps;
    if (!changed.has(material)) {
        changed.set(material, state);
        change(material, state);
    }
    material.needsUpdate = true;
    return material;
}

// Prefiltered environments in Babylon.js 5 and later:
//     scene.environmentTexture = await loadEnvironment('city.env', scene);  // a file that kiln baked
//     scene.environmentTexture = await bakeEnvironment('city.hdr', scene);  // any panorama, baked in a worker
//     addLights(scene, lights);                                             // lights taken out of the environment
//     await trueReflections(material, scene.environmentTexture);            // the lobe of a rough surface as it is
// The option `babylon` of each function holds Babylon's classes where they are not global, from babylonjs or
// @babylonjs/core: CubeTexture for environments, and Color3, DirectionalLight, ShadowGenerator and Vector3 for lights.
import { kindOf, openFile } from './fetch.mjs';
import { harmonicsOf } from './lobes.mjs';

export { trueReflections } from './babylon-lobes.mjs';

function classesOf(babylon, ...names) {
    const missing = names.filter((name) => !babylon?.[name]);
    if (missing.length)
        throw new Error(`kiln-ibl/babylon: ${missing.join(', ')} of Babylon.js is not global; import these classes ` +
                        `from @babylonjs/core and pass the option babylon: { ${missing.join(', ')} }`);
    return babylon;
}

const ENDINGS = { '.env': '.env', DDS: '.dds' };

// The spherical harmonics that an .env file holds: the file begins with 8 bytes of magic numbers and with JSON that a
// zero ends.
function readHarmonics(bytes) {
    const { irradiance } = JSON.parse(new TextDecoder().decode(bytes.subarray(8, bytes.indexOf(0, 8))));
    return irradiance ? harmonicsOf(irradiance) : null;
}

// Makes a texture of a file's bytes, which Babylon.js loads from an address of their own. The address lasts as long as
// the texture, since Babylon.js loads again when the browser has lost what was on the GPU.
function makeTexture({ name, bytes }, scene, { CubeTexture }) {
    const kind = kindOf(bytes), ending = ENDINGS[kind];
    if (!ending)
        throw new Error(`${name}: the file is of the kind "${kind}", and not an environment that kiln baked with ` +
                        '--for babylon or --for babylon-dds; bakeEnvironment() bakes panoramas');
    const url = URL.createObjectURL(new Blob([bytes])), free = () => URL.revokeObjectURL(url);
    return new Promise((resolve, reject) => {
        const fail = (message, error) => {
            free();
            reject(new Error(`${name}: Babylon.js cannot load the file: ${message || error?.message || 'no reason'}`));
        };
        const texture = new CubeTexture(url, scene, null, false, null, () => resolve(texture), fail, undefined, true,
                                        ending, true);
        texture.name = name;
        texture.metadata = { kiln: { sh: kind === '.env' ? readHarmonics(bytes) : null } };
        texture.onDisposeObservable.add(free);
    });
}

export async function loadEnvironment(source, scene, { babylon = globalThis.BABYLON, signal } = {}) {
    const classes = classesOf(babylon, 'CubeTexture');
    return makeTexture(await openFile(source, { signal }), scene, classes);
}

export async function bakeEnvironment(source, scene, { babylon = globalThis.BABYLON, ...options } = {}) {
    const classes = classesOf(babylon, 'CubeTexture');
    const { bake } = await import('./index.mjs'); // which those who only load do not need
    const input = await openFile(source, options);
    const { files, levels, sh, lights, report } = await bake(input.bytes, { name: input.name, for: 'babylon',
                                                                            ...options });
    const texture = await makeTexture(files[0], scene, classes);
    texture.metadata = { ...texture.metadata, kiln: { levels, sh: sh ?? texture.metadata.kiln.sh, lights, report } };
    return texture;
}

// The intensity of a light is set to the irradiance of a surface that faces the light. A white diffuse surface of
// PBRMaterial then reflects the radiance irradiance / pi. A direction (x, y, z) of kiln is (x, y, -z) in Babylon's
// left-handed scenes.
export function addLights(scene, lights, { shadows = 0, babylon = globalThis.BABYLON } = {}) {
    const { Color3, DirectionalLight, ShadowGenerator, Vector3 } =
        classesOf(babylon, 'Color3', 'DirectionalLight', 'Vector3', ...(shadows ? ['ShadowGenerator'] : []));
    return (lights.lights ?? lights).map(({ direction: [x, y, z], irradiance }, i) => {
        const light = new DirectionalLight(`kiln light ${i}`, new Vector3(-x, -y, z), scene); // the way it shines
        light.intensity = Math.max(...irradiance);
        light.diffuse = new Color3(...irradiance.map((e) => e / light.intensity));
        light.specular = light.diffuse;
        if (shadows) {
            light.position = light.direction.scale(-2 * shadows);
            Object.assign(light, { shadowFrustumSize: 2 * shadows, shadowMinZ: shadows, shadowMaxZ: 3 * shadows });
            new ShadowGenerator(2048, light);
        }
        return light;
    });
}

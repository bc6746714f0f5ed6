// True reflections in Babylon.js, WebGL 2, version 5 and later:
//     scene.environmentTexture = await loadEnvironment('city.env', scene);
//     await trueReflections(material, scene.environmentTexture, { taps: 2 });
// A rough surface reflects a lobe that leans towards the normal and is longer than it is wide. Babylon.js shows one
// round lobe instead. A material plugin replaces the radiance of that lobe, in the shader of a PBRMaterial, by what a
// table of kiln and nine spherical harmonics tell.
import { SIZE, checkHarmonics, decodeTable, lightOf, shader } from './lobes.mjs';

const WHO = 'kiln-ibl/babylon: trueReflections()';

// A direction (x, y, z) of Babylon's environments is (x, y, -z) in kiln.
const AXES = [[1, 0, 0], [0, 1, 0], [0, 0, -1]];

// Each number of taps has a module of its own, of which only the one asked for is loaded.
const TABLES = [() => import('./lobes/babylon-1.mjs'), () => import('./lobes/babylon-2.mjs'),
                () => import('./lobes/babylon-3.mjs')];
const RGBA = 5, BILINEAR = 2, HALF_FLOAT = 2; // constants of Babylon.js

// How the shader reads a level of the table's chain, which is that of a cube of 256 texels. Levels of equal roughness of
// a larger cube come later, by 0.8 for each doubling.
const READ = `vec4 texel = textureLod( reflectionSampler, way, lod + 0.8 * log2( vReflectionMicrosurfaceInfos.x / 256.0 ) );
	#ifdef RGBDREFLECTION
		texel.rgb = fromRGBD( texel );
	#endif
	#ifdef GAMMAREFLECTION
		texel.rgb = toLinearSpace( texel.rgb );
	#endif
	return texel.rgb;`;

// Shaders that read a prefiltered cube for lobes that are not anisotropic.
const KIND = ['REFLECTION', 'REFLECTIONMAP_CUBIC', 'LODBASEDMICROSFURACE', '!ANISOTROPIC', '!REALTIME_FILTERING',
              '!LODINREFLECTIONALPHA'].map((name) => name.replace(/\w+/, 'defined( $& )')).join(' && ');

const NAMES = Array.from({ length: 9 }, (_, i) => `kilnLight${i}`);

// In Babylon.js the nine vectors stand in the material's uniform block, each by a name of its own.
const makeFunctions = (taps) => `
#if ${KIND}
${shader(taps, READ).replace(/uniform vec3 kilnLight.*/, '').replace(/kilnLight\[ (\d) \]/g, 'kilnLight$1')}
#endif
`;

// The statement of the shader that takes the radiance of the reflection, and what replaces the statement. Babylon.js 5
// searches what it has replaced again, so that no part of the latter may be such a statement.
const STATEMENT = 'vec3 finalRadiance ?= ?reflectionOut\\.environmentRadiance\\.rgb;';
const REPLACED = `
#if ${KIND}
mat3 kilnTurn = mat3( reflectionMatrix );
#ifdef REFLECTIONMAP_OPPOSITEZ
kilnTurn = mat3( 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0 ) * kilnTurn;
#endif
#ifdef INVERTCUBICMAP
kilnTurn = mat3( 1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0 ) * kilnTurn;
#endif
vec3 finalRadiance = kilnReflection( viewDirectionW, normalW, roughness, kilnTurn ) * vReflectionInfos.x * vReflectionColor.rgb;
#else
vec3 finalRadiance = vec3( reflectionOut.environmentRadiance.rgb );
#endif
`;

// The class of the plugin, for the classes of Babylon.js that a caller has.
const classes = new WeakMap();
function pluginClass({ MaterialPluginBase }) {
    if (!classes.has(MaterialPluginBase))
        classes.set(MaterialPluginBase, class KilnReflections extends MaterialPluginBase {
            constructor(material, taps) {
                super(material, 'KilnReflections', 300, { KILN_TAPS: 0 }, false);
                this.taps = taps;
                this._pluginManager._addPlugin(this);
                this._enable(true);
            }
            getClassName() {
                return 'KilnReflections';
            }
            prepareDefines(defines) {
                defines.KILN_TAPS = this.taps;
            }
            getUniforms() {
                return { ubo: NAMES.map((name) => ({ name, size: 3, type: 'vec3' })),
                         fragment: NAMES.map((name) => `uniform vec3 ${name};`).join('\n') };
            }
            getSamplers(samplers) {
                samplers.push('kilnLobes');
            }
            hasTexture(texture) {
                return texture === this.lobes;
            }
            getActiveTextures(textures) {
                textures.push(this.lobes);
            }
            bindForSubMesh(block) {
                NAMES.forEach((name, i) => block.updateFloat3(name, ...this.light[i]));
                block.setTexture('kilnLobes', this.lobes);
            }
            getCustomCode(kind) {
                return kind === 'fragment'
                    ? { CUSTOM_FRAGMENT_DEFINITIONS: makeFunctions(this.taps), [`!${STATEMENT}`]: REPLACED } : null;
            }
        });
    return classes.get(MaterialPluginBase);
}

const textures = new WeakMap(); // of tables: by scene, then by the number of taps
async function loadTable(taps, scene, { RawTexture }) {
    if (!textures.has(scene))
        textures.set(scene, new Map());
    const known = textures.get(scene);
    if (!known.has(taps)) {
        const halves = decodeTable((await TABLES[taps - 1]()).default);
        const texture = new RawTexture(halves, SIZE, SIZE * (taps + 1), RGBA, scene, false, false, BILINEAR, HALF_FLOAT);
        texture.name = `kiln lobes ${taps}`;
        texture.wrapU = texture.wrapV = 0; // clamped
        known.set(taps, texture);
    }
    return known.get(taps);
}

function checkMaterial(material, taps) {
    if (!material?.getClassName?.().startsWith('PBR'))
        throw new Error(`${WHO}: the first argument must be a PBRMaterial, a PBRMetallicRoughnessMaterial or a ` +
                        `PBRSpecularGlossinessMaterial, and is ${material?.getClassName?.() ?? typeof material}`);
    if (material.anisotropy?.isEnabled)
        throw new Error(`${WHO}: the material is anisotropic, and the tables are those of isotropic lobes; leave this ` +
                        'material as it is');
    if (![1, 2, 3].includes(taps))
        throw new Error(`${WHO}: taps is ${taps}, and must be 1, 2 or 3`);
    const known = material.pluginManager?.getPlugin('KilnReflections');
    if (known && known.taps !== taps)
        throw new Error(`${WHO}: the material has ${known.taps} taps already, which cannot be changed to ${taps}`);
    return known;
}

// The nine vectors of the shader.
function makeLight(environment, sh) {
    if (!environment?.isCube)
        throw new Error(`${WHO}: the second argument must be the cube texture that lights the material`);
    const found = sh ?? environment.metadata?.kiln?.sh;
    if (!found)
        throw new Error(`${WHO}: the environment has no spherical harmonics, as .env files that kiln-ibl/babylon loads ` +
                        'have them; pass the option sh with what "kiln bake --sh sh.json" writes');
    return lightOf(checkHarmonics(found, WHO), AXES);
}

export async function trueReflections(material, environment, { taps = 2, sh, babylon = globalThis.BABYLON } = {}) {
    const missing = ['MaterialPluginBase', 'RawTexture'].filter((name) => !babylon?.[name]);
    if (missing.length)
        throw new Error(`${WHO}: ${missing.join(', ')} of Babylon.js is not global, and is there from version 5 on; ` +
                        `import these classes from @babylonjs/core and pass the option babylon: { ${missing.join(', ')} }`);
    const known = checkMaterial(material, taps), light = makeLight(environment, sh);
    const lobes = await loadTable(taps, material.getScene(), babylon);
    Object.assign(known ?? new (pluginClass(babylon))(material, taps), { light, lobes });
    material.markAsDirty(63); // all of what its shader and its textures follow from
    return material;
}

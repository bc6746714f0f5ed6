// A program that uses every module of the package, which TypeScript's compiler must accept. It holds mistakes, too: a
// comment with @ts-expect-error stands above each, and the compiler fails if the line below has no error. The program
// is not run.
import { bake, engines, kiln, version } from 'kiln-ibl';
import type { Baked, Engine, Harmonics, KilnError, Light } from 'kiln-ibl';
import * as ibl from 'kiln-ibl/three';
import * as babylonIbl from 'kiln-ibl/babylon';
import { useBakedEnvironmentMap, useEnvironmentMap } from 'kiln-ibl/react';
import kilnPlugin from 'kiln-ibl/vite';
import { Color, MeshPhysicalMaterial, Scene, Texture, WebGLRenderer } from 'three';
import { defineConfig } from 'vite';
import address, { files, levels, sh, lights } from './city.hdr?kiln&for=three';
import small from './city.hdr?for=three&size=128&kiln';

export async function inMemory(bytes: Uint8Array, signal: AbortSignal): Promise<[Baked, Harmonics | null]> {
    const baked = await bake(bytes, {
        for: 'three', size: 128, sun: 'extract', tune: 'sharp', zstd: true, rotate: [10, 0, 5], irradianceSize: 32, signal,
        onProgress: (fraction, stage) => console.log(stage.padEnd(9), fraction.toFixed(2)),
    });
    const picture = { data: new Float32Array(3 * 32 * 64), width: 64, height: 32 };
    await bake(picture);
    await bake([{ name: 'px.png', bytes }, { name: 'nx.png', bytes }]);
    const strongest: Light | undefined = baked.lights[0];
    console.log(strongest?.direction[2], baked.files[0].bytes.length, baked.levels[0].roughness, version);
    // @ts-expect-error: an unknown way to tune
    await bake(bytes, { tune: 'loud' });
    // @ts-expect-error: the height of the picture is missing
    await bake({ data: new Float32Array(6), width: 2 });
    // @ts-expect-error: harmonics may be null
    return [baked, baked.sh.coefficients[0][0] ? baked.sh : null];
}

export async function command(bytes: Uint8Array): Promise<Engine | undefined> {
    try {
        const run = await kiln(['info', 'city.exr'], { files: [{ name: 'city.exr', bytes }] });
        console.log(run.code, new TextDecoder().decode(run.stdout), run.stderr);
    } catch (error) {
        console.log((error as KilnError).exitCode);
    }
    return engines.find((engine) => engine.formats.includes('rgb9e5') && engine.size > 128);
}

export async function inThree(scene: Scene, renderer: WebGLRenderer): Promise<void> {
    const environment: Texture = await ibl.loadEnvironment({ three: 'city.ktx2', 'three-cubeuv': 'city.exr' }, renderer);
    const baked = await ibl.bakeEnvironment(new URL('https://example.org/city.hdr'), renderer, { size: 256, sun: 'extract' });
    scene.environment = ibl.engine === 'three' ? environment : baked;
    for (const light of ibl.addLights(scene, baked.userData.kiln, { shadows: 5, renderer }))
        light.color = new Color(1, 1, 1);
    const gold = new MeshPhysicalMaterial({ metalness: 1, roughness: 0.3 });
    const shown: MeshPhysicalMaterial = await ibl.trueReflections(gold, environment, { taps: 2 });
    shown.roughness = 0.5;
    // @ts-expect-error: four taps
    await ibl.trueReflections(gold, environment, { taps: 4 });
    // @ts-expect-error: three.js' loader bakes for three.js alone
    await ibl.bakeEnvironment('city.hdr', renderer, { for: 'babylon' });
}

// Classes as they stand in @babylonjs/core.
declare class CubeTexture {
    level: number;
}
declare class DirectionalLight {
    intensity: number;
}
declare class Other {}

export async function inBabylon(scene: object, material: { roughness: number }): Promise<void> {
    const classes = { CubeTexture, DirectionalLight, Color3: Other, Vector3: Other, MaterialPluginBase: Other, RawTexture: Other };
    const environment = await babylonIbl.loadEnvironment('city.env', scene, { babylon: classes });
    environment.level = 2;
    await babylonIbl.bakeEnvironment('city.hdr', scene, { babylon: classes, for: 'babylon-dds' });
    for (const light of babylonIbl.addLights(scene, [], { babylon: classes, shadows: 2 }))
        light.intensity = 1;
    (await babylonIbl.trueReflections(material, environment, { taps: 3, babylon: classes })).roughness = 0.2;
    // @ts-expect-error: these classes make no lights
    babylonIbl.addLights(scene, [], { babylon: { CubeTexture } });
}

export function Sky(): Texture[] {
    const loaded = useEnvironmentMap('city.ktx2');
    const baked = useBakedEnvironmentMap('city.exr', { size: 128, exposure: -1 });
    console.log(baked.userData.kiln.lights.length);
    return [loaded, baked];
}

export default defineConfig({ plugins: [kilnPlugin({ cache: '.kiln' })] });
export const imported: [string, string, number, number, number] = [
    address + small, files['city.ktx2'], levels[0].size, sh.bands, lights[0].share,
];

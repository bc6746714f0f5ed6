// Loads what `kiln bake --for three` writes, for three.js from r187 on:
//     scene.environment = await loadEnvironment('city.ktx2');
// addLights() adds the lights that kiln took out of the environment.
import { Color, CompressedCubeTexture, DirectionalLight, HalfFloatType, LinearMipmapLinearFilter, RGBAFormat } from 'three';
import { read } from 'three/addons/libs/ktx-parse.module.js';

// Makes a texture from the bytes of the file. The texture is prefiltered, so three.js makes no PMREM of it.
export function parseEnvironment(bytes) {
    const { levels, pixelWidth } = read(bytes);
    const faces = Array.from({ length: 6 }, (_, face) => ({
        width: pixelWidth, height: pixelWidth, format: RGBAFormat,
        mipmaps: levels.map(({ levelData: data }, level) => {
            const width = pixelWidth >> level, size = data.length / 6;
            const texels = data.slice(face * size, (face + 1) * size); // aligned
            return { width, height: width, data: new Uint16Array(texels.buffer) };
        }),
    }));
    const texture = new CompressedCubeTexture(faces, RGBAFormat, HalfFloatType);
    texture.minFilter = LinearMipmapLinearFilter;
    texture.isPMREMTexture = true;
    texture.isRenderTargetTexture = true; // else x is mirrored
    texture.needsUpdate = true;
    return texture;
}

export async function loadEnvironment(url) {
    const response = await fetch(url);
    if (!response.ok)
        throw new Error(`${url}: the server answers ${response.status}`);
    return parseEnvironment(new Uint8Array(await response.arrayBuffer()));
}

// Adds directional lights to a scene of three.js: those that `kiln bake --sun extract --lights-file sun.json` took out
// of the environment and wrote to sun.json.
//     addLights(scene, await (await fetch('sun.json')).json());
// The intensity of a light is set to the irradiance of a surface that faces the light. A white diffuse surface then
// reflects the radiance irradiance / pi. A direction (x, y, z) of kiln is (-z, y, x) in three.js.
// `shadows` is the radius of the sphere around the origin in which objects cast and receive shadows. Returns the
// lights, whose shadows may be changed.
export function addLights(scene, { lights }, { shadows = 0 } = {}) {
    return lights.map(({ direction: [x, y, z], irradiance }) => {
        const brightest = Math.max(...irradiance);
        const light = new DirectionalLight(new Color(...irradiance.map((e) => e / brightest)), brightest);
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

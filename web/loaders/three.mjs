// Loads what `kiln bake --for three` writes, for three.js from r187 on:
//     scene.environment = await loadEnvironment('city.ktx2');
import { CompressedCubeTexture, HalfFloatType, LinearMipmapLinearFilter, RGBAFormat } from 'three';
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

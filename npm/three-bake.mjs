// What bakeEnvironment() of three.mjs needs besides: bake(), and readPanorama(), which reads the texels of an
// equirectangular texture of three.js, as loaders of three.js make them, into a picture that bake() accepts: linear
// radiance in RGB floats, the upper row first.
import { DataUtils, FloatType, HalfFloatType, RGBAFormat, UnsignedByteType } from 'three';

export { bake } from './index.mjs';

const SRGB = [3001, 'srgb']; // texture.encoding of r150 and r151, texture.colorSpace from r152 on
const isSrgb = ({ encoding, colorSpace }) => SRGB.includes(encoding) || SRGB.includes(colorSpace);

// sRGB's transfer function of one of 256 values, IEC 61966-2-1.
const fromSrgb = (x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);

// How a stored number becomes a float. All numbers of 16 bits and less are decoded once, into a table.
function decoder(texture, type) {
    if (type === FloatType)
        return (x) => x;
    const bytes = type === UnsignedByteType;
    const table = Float32Array.from({ length: bytes ? 256 : 65536 }, (_, i) => {
        if (!bytes)
            return DataUtils.fromHalfFloat(i);
        return isSrgb(texture) ? fromSrgb(i / 255) : i / 255;
    });
    return (x) => table[x];
}

// The pixels of an image, an ImageBitmap or a canvas, through a canvas of their size.
function drawImage(image) {
    const width = image.naturalWidth ?? image.width, height = image.naturalHeight ?? image.height;
    const canvas = document.createElement('canvas');
    Object.assign(canvas, { width, height });
    const pen = canvas.getContext('2d');
    pen.drawImage(image, 0, 0);
    return { width, height, data: pen.getImageData(0, 0, width, height).data, type: UnsignedByteType };
}

function stored(texture) {
    const { image } = texture;
    const refuse = (sentence) => { throw new Error(`bakeEnvironment: ${sentence}`); };
    if (texture.isRenderTargetTexture)
        refuse('the texture is a render target\'s, whose texels are on the GPU alone; pass the panorama\'s address');
    if (texture.isCubeTexture || texture.isCompressedTexture)
        refuse(`a ${texture.isCubeTexture ? 'cube' : 'compressed'} texture is not a panorama; pass the address of ` +
               'the panorama, or a texture of HDRLoader, EXRLoader or TextureLoader');
    if (!image || !(image.width > 0))
        refuse('the texture has no texels yet; wait for its loader by loadAsync()');
    if (!image.data)
        return drawImage(image);
    const { type, format } = texture;
    if (![FloatType, HalfFloatType, UnsignedByteType].includes(type) || format !== RGBAFormat)
        refuse(`texels of type ${type} and format ${format} cannot be read; RGBAFormat with FloatType, ` +
               'HalfFloatType or UnsignedByteType can');
    return { width: image.width, height: image.height, data: image.data, type };
}

export function readPanorama(texture) {
    const { width, height, data, type } = stored(texture);
    const decode = decoder(texture, type), rgb = new Float32Array(3 * width * height);
    for (let y = 0; y < height; y++) {
        let from = 4 * width * (texture.flipY ? y : height - 1 - y); // without flipY the lowest row comes first
        for (let to = 3 * width * y; to < 3 * width * (y + 1); to += 3, from += 4)
            for (let c = 0; c < 3; c++)
                rgb[to + c] = decode(data[from + c]);
    }
    return { data: rgb, width, height };
}

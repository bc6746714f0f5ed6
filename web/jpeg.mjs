// JPEG pictures in the page. The baker of the page has no JPEG decoder, so the browser decodes the
// picture, by its profile and its orientation, to sRGB and hands the pixels to the baker as PNG.

const isJpeg = (bytes) => bytes[0] === 0xff && bytes[1] === 0xd8 && bytes[2] === 0xff;

// Gain maps are announced by these words, which stand in the first segments of a file.
function hasGainMap(bytes) {
    const start = new TextDecoder('latin1').decode(bytes.subarray(0, 1 << 18));
    return start.includes('hdrgm:Version') || start.includes('urn:iso:std:iso:ts:21496:-1');
}

async function toPng(bytes, name) {
    const picture = await createImageBitmap(new Blob([bytes], { type: 'image/jpeg' })).catch(() => {
        throw new Error(`${name}: the browser cannot decode this JPEG`);
    });
    const canvas = new OffscreenCanvas(picture.width, picture.height);
    canvas.getContext('2d', { alpha: false }).drawImage(picture, 0, 0);
    picture.close();
    const blob = await canvas.convertToBlob({ type: 'image/png' });
    return new Uint8Array(await blob.arrayBuffer());
}

// Returns what Baker.open takes: the bytes, or those of a PNG in place of a JPEG; the name; and
// sentences about the change.
export async function readable(bytes, name) {
    if (!isJpeg(bytes))
        return [bytes, name];
    const told = ['the browser decoded the JPEG to sRGB with 8 bits'];
    if (hasGainMap(bytes))
        told.push('the gain map of the JPEG was not applied, which the command kiln does');
    return [await toPng(bytes, name), name, told];
}

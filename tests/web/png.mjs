// A browser shows the PNG files that kiln writes as the bytes that were meant:
//   node png.mjs WRITE SITE FOLDER, where WRITE is the program of tests/files/pictures.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { withPage } from './browser.mjs';

const [write, , folder] = process.argv.slice(2).map((name) => path.resolve(name));
const WIDTH = 230, HEIGHT = 171;
fs.rmSync(folder, { recursive: true, force: true });
fs.mkdirSync(folder, { recursive: true });
execFileSync(write, [folder]);
fs.writeFileSync(path.join(folder, 'index.html'), '<!doctype html><title>png</title><link rel="icon" href="data:,">');

// random_hash of tests/kit/random.h, of 64 bits.
function randomHash(value) {
    value = BigInt.asUintN(64, (value ^ value >> 30n) * 0xbf58476d1ce4e5b9n);
    value = BigInt.asUintN(64, (value ^ value >> 27n) * 0x94d049bb133111ebn);
    return value ^ value >> 31n;
}

// The values of tests/files/pictures/write.c, from 0 to 255.
function wanted(channels) {
    const single = Math.fround, bytes = [];
    for (let i = 0; i < WIDTH * HEIGHT; i++) {
        const x = i % WIDTH, y = Math.floor(i / WIDTH), rgba = [];
        for (let c = 0; c < channels; c++) {
            const noise = Number(randomHash(BigInt(i * 4 + c)) >> 48n);
            const slope = single((x + 2 * y + 40 * c) / (WIDTH + 2 * HEIGHT + 160));
            const value = channels % 2 === 0 && c === channels - 1 ? 1
                        : x < 60 ? 0.25 * c : y % 40 < 20 ? slope : single(noise / 65535);
            rgba.push(Math.floor(single(single(value * 255) + 0.5)));
        }
        const [r, g, b] = channels < 3 ? [rgba[0], rgba[0], rgba[0]] : rgba;
        bytes.push(r, g, b, 255);
    }
    return bytes;
}

function show(base64) {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    return createImageBitmap(new Blob([bytes], { type: 'image/png' }), { colorSpaceConversion: 'none' }).then((picture) => {
        const pen = new OffscreenCanvas(picture.width, picture.height).getContext('2d');
        pen.drawImage(picture, 0, 0);
        return [picture.width, picture.height, [...pen.getImageData(0, 0, picture.width, picture.height).data]];
    });
}

await withPage(folder, async (page, address) => {
    await page.goto(address);
    for (let channels = 1; channels <= 4; channels++)
        for (const name of ['plain', 'srgb', 'fine']) {
            const file = `${name}_${channels}.png`;
            const [width, height, got] = await page.evaluate(show, fs.readFileSync(path.join(folder, file), 'base64'));
            assert.deepEqual([width, height], [WIDTH, HEIGHT]);
            const most = name === 'fine' ? 1 : 0; // 16 bits become 8, rounded one way or the other
            wanted(channels).forEach((byte, i) =>
                assert.ok(Math.abs(got[i] - byte) <= most, `${file}: byte ${i} is ${got[i]}, not ${byte}`));
        }
    console.log('  12 files of 1 to 4 channels, 8 and 16 bits');
});

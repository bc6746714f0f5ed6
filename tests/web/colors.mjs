// A browser and kiln show pictures with colour chunks and profiles alike:
//   node colors.mjs COLORS SITE FOLDER, where COLORS is the program of colors.c.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import zlib from 'node:zlib';
import { withPage } from './browser.mjs';

const [colors, , folder] = process.argv.slice(2).map((name) => path.resolve(name));
const WIDTH = 64, HEIGHT = 32;
fs.rmSync(folder, { recursive: true, force: true });
fs.mkdirSync(folder, { recursive: true });
fs.writeFileSync(path.join(folder, 'index.html'), '<!doctype html><title>colors</title><link rel="icon" href="data:,">');

// ------------------------------------------------------------------------------------------- files

function u32s(...values) {
    const bytes = Buffer.alloc(4 * values.length);
    values.forEach((value, i) => bytes.writeUInt32BE(value >>> 0, 4 * i));
    return bytes;
}

function crc32(bytes) {
    let sum = ~0;
    for (const byte of bytes) {
        sum ^= byte;
        for (let k = 0; k < 8; k++)
            sum = sum & 1 ? (sum >>> 1) ^ 0xedb88320 : sum >>> 1;
    }
    return ~sum >>> 0;
}

function chunk(type, data) {
    const body = Buffer.concat([Buffer.from(type, 'latin1'), data]);
    return Buffer.concat([u32s(data.length), body, u32s(crc32(body))]);
}

// Greys in the first rows, then colours.
function png(...chunks) {
    const rows = [];
    for (let y = 0; y < HEIGHT; y++) {
        rows.push(0);
        for (let x = 0; x < WIDTH; x++)
            rows.push(...(y < 4 ? [4 * x, 4 * x, 4 * x] : [4 * x, 8 * y, (x * 37 + y * 11) & 255]));
    }
    return Buffer.concat([Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'),
                          chunk('IHDR', Buffer.concat([u32s(WIDTH, HEIGHT), Buffer.from([8, 2, 0, 0, 0])])), ...chunks,
                          chunk('IDAT', zlib.deflateSync(Buffer.from(rows))), chunk('IEND', Buffer.alloc(0))]);
}

const gamma = (value) => chunk('gAMA', u32s(Math.round(value * 1e5)));
const rec709 = chunk('cHRM', u32s(31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000));
const p3 = chunk('cHRM', u32s(31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000));
const srgb = chunk('sRGB', Buffer.from([0]));

// A display profile of version 2: the columns of a matrix relative to D50, and one curve.
function profile(columns, curve) {
    const fixed = (v) => Math.round(v * 65536);
    const xyz = (v) => Buffer.concat([Buffer.from('XYZ \0\0\0\0', 'latin1'), u32s(...v.map(fixed))]);
    const text = Buffer.concat([Buffer.from('desc\0\0\0\0\0\0\0\x05test\0', 'latin1'), Buffer.alloc(79)]);
    const tags = [['desc', text], ['cprt', Buffer.from('text\0\0\0\0none\0\0\0\0', 'latin1')], ['wtpt', xyz([0.9642, 1, 0.8249])],
                  ['rXYZ', xyz(columns[0])], ['gXYZ', xyz(columns[1])], ['bXYZ', xyz(columns[2])],
                  ['rTRC', curve], ['gTRC', curve], ['bTRC', curve]];
    const table = [u32s(tags.length)], data = [];
    let at = 128 + 4 + 12 * tags.length;
    for (const [name, bytes] of tags) {
        const padded = Buffer.concat([bytes, Buffer.alloc((4 - bytes.length % 4) % 4)]);
        table.push(Buffer.from(name), u32s(at, bytes.length));
        data.push(padded);
        at += padded.length;
    }
    const head = Buffer.alloc(128);
    head.writeUInt32BE(at, 0);
    head.writeUInt32BE(0x02400000, 8);
    head.write('mntrRGB XYZ ', 12, 'latin1');
    head.write('acsp', 36, 'latin1');
    u32s(...[0.9642, 1, 0.8249].map(fixed)).copy(head, 68);
    return Buffer.concat([head, ...table, ...data]);
}

const P3_COLUMNS = [[0.51512, 0.24120, -0.00105], [0.29198, 0.69225, 0.04189], [0.15710, 0.06657, 0.78407]];
const SRGB_COLUMNS = [[0.43607, 0.22249, 0.01392], [0.38515, 0.71687, 0.09708], [0.14307, 0.06061, 0.71410]];
const number = (power) => Buffer.concat([Buffer.from('curv\0\0\0\0\0\0\0\x01', 'latin1'), Buffer.from([power, 0x33])]);
const icc = (bytes) => chunk('iCCP', Buffer.concat([Buffer.from('test\0\0', 'latin1'), zlib.deflateSync(bytes)]));

const files = {
    'none.png': png(),
    'srgb.png': png(srgb),
    'linear.png': png(gamma(1), rec709),
    'gamma-22.png': png(gamma(0.45455), rec709),
    'gamma-p3.png': png(gamma(0.5), p3),
    'srgb-first.png': png(gamma(1), p3, srgb),
    'cicp-p3.png': png(gamma(1), srgb, chunk('cICP', Buffer.from([12, 13, 0, 1]))),
    'icc-p3.png': png(icc(profile(P3_COLUMNS, number(2)))),
    'icc-first.png': png(srgb, icc(profile(SRGB_COLUMNS, number(1)))),
};

// ----------------------------------------------------------------------------------------- browser

function show({ base64, type }) {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    return createImageBitmap(new Blob([bytes], { type })).then((picture) => {
        const pen = new OffscreenCanvas(picture.width, picture.height).getContext('2d');
        pen.drawImage(picture, 0, 0);
        return [...pen.getImageData(0, 0, picture.width, picture.height).data];
    });
}

// The browser's own JPEG of a PNG file.
function toJpeg(base64) {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    return createImageBitmap(new Blob([bytes], { type: 'image/png' })).then((picture) => {
        const canvas = new OffscreenCanvas(picture.width, picture.height);
        canvas.getContext('2d').drawImage(picture, 0, 0);
        return canvas.convertToBlob({ type: 'image/jpeg', quality: 0.9 });
    }).then((blob) => blob.arrayBuffer()).then((buffer) => btoa(String.fromCharCode(...new Uint8Array(buffer))));
}

await withPage(folder, async (page, address) => {
    await page.goto(address);
    if (process.env.KILN_JPEG === '1')
        files['browser.jpg'] = Buffer.from(await page.evaluate(toJpeg, files['srgb.png'].toString('base64')), 'base64');
    for (const [name, bytes] of Object.entries(files)) {
        const file = path.join(folder, name);
        fs.writeFileSync(file, bytes);
        const ours = execFileSync(colors, [file]);
        const type = name.endsWith('.jpg') ? 'image/jpeg' : 'image/png';
        const theirs = await page.evaluate(show, { base64: bytes.toString('base64'), type });
        let most = 0, sum = 0;
        for (let i = 0; i < WIDTH * HEIGHT; i++)
            for (let c = 0; c < 3; c++) {
                const off = Math.abs(ours[3 * i + c] - theirs[4 * i + c]);
                most = Math.max(most, off);
                sum += off;
            }
        console.log(`  ${name}: differs by ${most} of 255 at most, ${(sum / (WIDTH * HEIGHT * 3)).toFixed(3)} on average`);
        assert.ok(most <= 1, `${name}: a byte differs by ${most}`);
    }
});

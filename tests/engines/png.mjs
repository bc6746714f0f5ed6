// Reads PNG files without a browser.
import fs from 'node:fs';
import zlib from 'node:zlib';

// Returns a function of x and y: the red, green and blue of a pixel of a PNG file of 8 bits, with or without alpha.
export function readPng(file) {
    const png = fs.readFileSync(file), parts = [];
    for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at))
        if (png.toString('latin1', at + 4, at + 8) === 'IDAT')
            parts.push(png.subarray(at + 8, at + 8 + png.readUInt32BE(at)));
    const step = png[25] === 6 ? 4 : 3, line = step * png.readUInt32BE(16), raw = zlib.inflateSync(Buffer.concat(parts));
    const rows = [Buffer.alloc(line)];
    for (let at = 0; at < raw.length; at += line + 1) {
        const row = Buffer.from(raw.subarray(at + 1, at + 1 + line)), above = rows.at(-1);
        row.forEach((_, i) => {
            const a = i < step ? 0 : row[i - step], b = above[i], c = i < step ? 0 : above[i - step], p = a + b - c;
            const [pa, pb, pc] = [a, b, c].map((x) => Math.abs(p - x));
            row[i] += [0, a, b, (a + b) >> 1, pa <= pb && pa <= pc ? a : pb <= pc ? b : c][raw[at]];
        });
        rows.push(row);
    }
    return (x, y) => [...rows[1 + y].subarray(step * x, step * x + 3)];
}

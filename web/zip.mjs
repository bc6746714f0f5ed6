// Writes .zip archives (PKWARE's APPNOTE 6.3): in, files in memory; out, the bytes of an archive whose
// entries are deflated where that makes them smaller, else stored. All entries have one date, so that
// the same files give the same bytes.
const DATE = 0x21, DEFLATED = 8, UTF8 = 0x800, VERSION = 20; // 1 January 1980

const CRC = Uint32Array.from({ length: 256 }, (_, n) => {
    for (let k = 0; k < 8; k++)
        n = n & 1 ? 0xedb88320 ^ n >>> 1 : n >>> 1;
    return n;
});

export function crc32(bytes) {
    let crc = ~0;
    for (const byte of bytes)
        crc = CRC[(crc ^ byte) & 255] ^ crc >>> 8;
    return ~crc >>> 0;
}

async function deflated(bytes) {
    if (typeof CompressionStream === 'undefined')
        return bytes;
    try {
        const stream = new Blob([bytes]).stream().pipeThrough(new CompressionStream('deflate-raw'));
        return new Uint8Array(await new Response(stream).arrayBuffer());
    } catch {
        return bytes; // a browser that knows no deflate-raw
    }
}

// Bytes of numbers, lowest byte first: [width, value] pairs.
function numbers(...fields) {
    return Uint8Array.from(fields.flatMap(([width, value]) =>
        Array.from({ length: width }, (_, i) => value / 256 ** i & 255)));
}

// `files` is an array of { name, bytes }.
export async function zip(files) {
    const parts = [], index = [];
    let at = 0;
    const add = (list, ...pieces) => pieces.forEach((piece) => list.push(piece));
    for (const { name, bytes } of files) {
        const small = await deflated(bytes), packed = small.length < bytes.length;
        const data = packed ? small : bytes, title = new TextEncoder().encode(name);
        const common = [[2, VERSION], [2, UTF8], [2, packed ? DEFLATED : 0], [2, 0], [2, DATE], [4, crc32(bytes)],
                        [4, data.length], [4, bytes.length], [2, title.length], [2, 0]];
        const head = numbers([4, 0x04034b50], ...common);
        add(parts, head, title, data);
        add(index, numbers([4, 0x02014b50], [2, VERSION], ...common, [2, 0], [2, 0], [2, 0], [4, 0], [4, at]), title);
        at += head.length + title.length + data.length;
    }
    const size = index.reduce((sum, piece) => sum + piece.length, 0);
    const end = numbers([4, 0x06054b50], [2, 0], [2, 0], [2, files.length], [2, files.length], [4, size], [4, at],
                        [2, 0]);
    return new Uint8Array(await new Blob([...parts, ...index, end]).arrayBuffer());
}

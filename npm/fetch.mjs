// Fetches files and tells their kinds by their first bytes, for the loaders of engines.

const START = 16; // bytes that tell a file's kind
const KINDS = [
    ['KTX2', (b) => b[0] === 0xab && b[1] === 0x4b && b[5] === 0x32], // «KTX 20»
    ['EXR', (b) => b[0] === 0x76 && b[1] === 0x2f && b[2] === 0x31 && b[3] === 0x01],
    ['HDR', (b, text) => text.startsWith('#?')],
    ['PNG', (b, text) => text.startsWith('\x89PNG')],
    ['JPEG', (b) => b[0] === 0xff && b[1] === 0xd8],
    ['DDS', (b, text) => text.startsWith('DDS ')],
    ['.env', (b) => b[0] === 0x86 && b[1] === 0x16 && b[2] === 0x87 && b[3] === 0x96],
    ['web page', (b, text) => /^\s*<(!doctype|html)/i.test(text)],
];

// The kind of a file, as a word for an error message: one of KINDS, or "unknown".
export function kindOf(bytes) {
    const text = String.fromCharCode(...bytes.subarray(0, START));
    return KINDS.find(([, fits]) => fits(bytes, text))?.[0] ?? 'unknown';
}

// The last part of an address, which names the file in error messages: "city.hdr" of "/sky/city.hdr?v=2".
export function nameOf(url) {
    const address = String(url);
    const path = address.startsWith('data:') ? 'data' : address.replace(/[?#].*$/, '');
    return decodeURIComponent(path.split('/').filter(Boolean).pop() ?? address);
}

// Fetches a file: { name, bytes }. A server that answers with a web page, as development servers do for a file that
// is missing, is an error.
export async function fetchFile(url, signal) {
    const response = await fetch(url, { signal });
    if (!response.ok)
        throw new Error(`${url}: the server answers ${response.status}`);
    const bytes = new Uint8Array(await response.arrayBuffer()), name = nameOf(url);
    if (kindOf(bytes) === 'web page')
        throw new Error(`${url}: the server answers with a web page, as if the file were missing`);
    return { name, bytes };
}

// The file behind what the loaders accept: an address, a File or Blob, or bytes.
export async function openFile(source, { name, signal } = {}) {
    if (source instanceof Blob)
        return { name: name ?? source.name ?? 'picture', bytes: new Uint8Array(await source.arrayBuffer()) };
    if (ArrayBuffer.isView(source))
        return { name: name ?? 'picture',
                 bytes: new Uint8Array(source.buffer, source.byteOffset, source.byteLength) };
    if (source instanceof ArrayBuffer)
        return { name: name ?? 'picture', bytes: new Uint8Array(source) };
    if (typeof source !== 'string' && !(source instanceof URL))
        throw new TypeError(`kiln-ibl: a file must be an address, a File, a Blob or bytes, not ${JSON.stringify(source)}`);
    const file = await fetchFile(source, signal);
    return { ...file, name: name ?? file.name };
}

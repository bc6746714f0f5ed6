// Serves a folder on 127.0.0.1 and prints the address.
//   node serve.mjs FOLDER [PORT]
// Without PORT the port is 8420, or any free port if 8420 is taken. PORT 0 means any free port.
import fs from 'node:fs';
import http from 'node:http';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const TYPES = {
    '.html': 'text/html; charset=utf-8',
    '.css': 'text/css; charset=utf-8',
    '.js': 'text/javascript; charset=utf-8',
    '.mjs': 'text/javascript; charset=utf-8',
    '.md': 'text/markdown; charset=utf-8',
    '.txt': 'text/plain; charset=utf-8',
    '.svg': 'image/svg+xml',
    '.wasm': 'application/wasm',
};

function respond(root, request, response) {
    const refuse = (code, sentence) => {
        response.writeHead(code, { 'Content-Type': 'text/plain; charset=utf-8' });
        response.end(`${sentence}\n`);
    };
    let name;
    try {
        name = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
    } catch {
        return refuse(400, 'The address cannot be read.');
    }
    if (request.method !== 'GET' && request.method !== 'HEAD')
        return refuse(405, 'Only GET and HEAD are answered.');
    const file = path.join(root, path.normalize(name.endsWith('/') ? `${name}index.html` : name));
    if (!file.startsWith(root + path.sep) || name.includes('\0'))
        return refuse(403, 'That lies outside the page.');
    fs.stat(file, (error, status) => {
        if (error || !status.isFile())
            return refuse(404, `There is no ${name}.`);
        response.writeHead(200, {
            'Content-Type': TYPES[path.extname(file)] ?? 'application/octet-stream',
            'Content-Length': status.size,
            'Cache-Control': 'no-cache',
            'X-Content-Type-Options': 'nosniff',
        });
        if (request.method === 'HEAD')
            return response.end();
        return fs.createReadStream(file).on('error', () => response.destroy()).pipe(response);
    });
    return undefined;
}

// Starts the server; resolves to { server, address }.
export function serve(folder, port = 0) {
    const root = path.resolve(folder);
    const server = http.createServer((request, response) => respond(root, request, response));
    return new Promise((resolve, reject) => {
        server.once('error', reject);
        server.listen(port, '127.0.0.1', () => {
            resolve({ server, address: `http://127.0.0.1:${server.address().port}/` });
        });
    });
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
    const [folder, given] = process.argv.slice(2);
    const port = given === undefined ? 8420 : Number(given);
    if (!folder || !Number.isInteger(port) || port < 0 || port > 65535) {
        console.error('node serve.mjs FOLDER [PORT from 0 to 65535]');
        process.exit(2);
    }
    const { address } = await serve(folder, port).catch((error) => {
        if (given === undefined && error.code === 'EADDRINUSE')
            return serve(folder, 0);
        console.error(`serve: port ${port} cannot be had: ${error.code}`);
        return process.exit(1);
    });
    console.log(`kiln is at ${address}  (Ctrl-C stops it)`);
}

// What the tests of the page share. Each is run as: node NAME.mjs KILN SITE FOLDER
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

export const [kilnPath, site, folder] = process.argv.slice(2).map((name) => path.resolve(name));

if (!folder || !fs.existsSync(path.join(site, 'baker.wasm'))) {
    console.error(`${site}: holds no baker.wasm; cmake --preset wasm && cmake --build --preset wasm`);
    process.exit(1);
}
fs.rmSync(folder, { recursive: true, force: true });
fs.mkdirSync(folder, { recursive: true });

export const root = fileURLToPath(new URL('../..', import.meta.url));
export const inFolder = (name) => path.join(folder, name);
export const read = (name) => fs.readFileSync(inFolder(name));

// The command, in the folder. Returns what it prints.
export function kiln(...args) {
    return execFileSync(kilnPath, args, { cwd: folder, encoding: 'utf8' });
}

export const importSite = (name) => import(pathToFileURL(path.join(site, name)));

export async function makeBaker(options = {}) {
    const { Baker } = await importSite('baker.mjs');
    const { default: makeModule } = await importSite('baker.js');
    const wasmBinary = fs.readFileSync(path.join(site, 'baker.wasm'));
    return Baker.make(makeModule, { wasmBinary, ...options });
}

export function check(good, sentence) {
    if (!good)
        throw new Error(sentence);
}

export function checkSame(got, wanted, name) {
    const at = Buffer.compare(got, wanted) ? got.findIndex((byte, i) => byte !== wanted[i]) : -1;
    check(got.length === wanted.length && at < 0,
          `${name}: ${got.length} bytes for ${wanted.length}, the first that differs is ${at}`);
}

export function checkThrows(work, pattern) {
    let message = 'nothing';
    try {
        work();
    } catch (error) {
        message = error.message;
    }
    check(pattern.test(message), `says "${message}", not ${pattern}`);
}

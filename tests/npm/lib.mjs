// What the tests of the npm package share. Each is run as: node NAME.mjs KILN BUILT FOLDER
// KILN is the native command, BUILT the folder of the tarball, FOLDER a folder that is emptied. The tarball is
// installed there as users do it.
import { execFileSync, spawnSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

export const [native, built, folder] = process.argv.slice(2).map((name) => path.resolve(name));
export const root = fileURLToPath(new URL('../..', import.meta.url));
export const tarball = path.join(built, fs.readFileSync(path.join(built, 'name.txt'), 'utf8').trim());
export const inFolder = (...names) => path.join(folder, ...names);

fs.rmSync(folder, { recursive: true, force: true });
fs.mkdirSync(folder, { recursive: true });
fs.writeFileSync(inFolder('package.json'), '{ "private": true, "type": "module" }\n');
execFileSync('npm', ['install', '--offline', '--no-audit', '--no-fund', '--silent', tarball], { cwd: folder });
export const installed = inFolder('node_modules/kiln-ibl');
export const command = inFolder('node_modules/.bin/kiln');

// Runs a command in a folder. Returns the exit code and what it printed.
export function runIn(cwd, program, words, options = {}) {
    const { status, signal, stdout, stderr } = spawnSync(program, words, { cwd, maxBuffer: 1 << 28, ...options });
    return { code: status ?? signal, stdout: stdout.toString('latin1'), stderr: stderr.toString() };
}

// Runs the native command or throws.
export function kiln(...words) {
    const { code, stdout, stderr } = runIn(folder, native, words);
    if (code !== 0)
        throw new Error(`kiln ${words.join(' ')}: ${code}: ${stderr}`);
    return stdout;
}

// All files below a folder, by their names.
export function filesBelow(where, below = '') {
    const found = {};
    for (const entry of fs.readdirSync(path.join(where, below), { withFileTypes: true })) {
        const name = path.posix.join(below, entry.name);
        if (entry.isDirectory())
            Object.assign(found, filesBelow(where, name));
        else
            found[name] = fs.readFileSync(path.join(where, name));
    }
    return found;
}

// Writes inputs: a.exr, a sky with a sun; a.hdr, a.png, b.png (16 bits), faces/*.exr; a.jpg and p.jpg, progressive.
export function makeInputs() {
    kiln('sky', '-o', 'a.exr', '--size', '32', '--elevation', '30', '-q');
    for (const name of ['a.hdr', 'faces/{face}.exr']) {
        fs.mkdirSync(inFolder('faces'), { recursive: true });
        kiln('bake', 'a.exr', '-o', name, '--size', '32', '--levels', '1', '--shape',
             name === 'a.hdr' ? 'panorama' : 'cube', '-q');
    }
    const image = (...words) => execFileSync('oiiotool', words, { cwd: folder });
    image('a.exr', '--mulc', '0.02', '--clamp:min=0:max=1', '--powc', '0.45', '-d', 'uint8', '-o', 'a.png');
    image('a.exr', '--mulc', '0.02', '--clamp:min=0:max=1', '-d', 'uint16', '-o', 'b.png');
    image('a.png', '--resize', '90x45', '--compression', 'jpeg:80', '-o', 'a.jpg');
    image('a.png', '--attrib', 'jpeg:progressive', '1', '--compression', 'jpeg:95', '-o', 'p.jpg');
}

// Makes the npm package. In: a folder to work in, and the two modules. Out: FOLDER/package, and FOLDER/kiln-ibl-VERSION.tgz
// by npm pack, with the same bytes each time.
//   node npm/tools/pack.mjs FOLDER WITH_VECTORS.wasm WITHOUT.wasm
// The version and the list of engines are what the command in the module says, and the command makes the tables of
// trueReflections().
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { run } from '../host.mjs';
import { MemorySystem } from '../memory.mjs';
import { makeLobes } from './lobes.mjs';

const [folder, vectors, scalar] = process.argv.slice(2);
const source = path.resolve(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), '..');
const target = path.resolve(folder, 'package');
const LEFT_OUT = new Set(['codecs', 'examples', 'lobes', 'tools', 'node_modules']);

function runOn(module, words) {
    const system = new MemorySystem([], words, undefined, () => {});
    if (run(module, words, system) !== 0)
        throw new Error(`kiln ${words.join(' ')}: ${new TextDecoder().decode(system.errors.take())}`);
    return system;
}
const say = (module, words) => new TextDecoder().decode(runOn(module, words).output.take());

// Modules, types and pages of a folder and of the folders in it.
function copy(from, to) {
    fs.mkdirSync(to, { recursive: true });
    for (const entry of fs.readdirSync(from, { withFileTypes: true }))
        if (entry.isDirectory() && !LEFT_OUT.has(entry.name))
            copy(path.join(from, entry.name), path.join(to, entry.name));
        else if (/\.(mjs|d\.ts|md)$/.test(entry.name))
            fs.copyFileSync(path.join(from, entry.name), path.join(to, entry.name));
}

// Gives files and folders permissions that do not follow from who packs.
function allow(where) {
    fs.chmodSync(where, 0o755);
    for (const entry of fs.readdirSync(where, { withFileTypes: true }))
        if (entry.isDirectory())
            allow(path.join(where, entry.name));
        else
            fs.chmodSync(path.join(where, entry.name), 0o644);
}

// The licences of what is compiled into the module besides kiln.
function licences() {
    const codecs = path.join(source, 'codecs/node_modules');
    const jpeg = path.join(codecs, '@julusian/jpeg-turbo/deps/libjpeg-turbo');
    const compiler = fs.readFileSync(path.join(source, 'codecs/emscripten.txt'), 'utf8');
    const parts = [
        ['zstd', fs.readFileSync(path.join(codecs, 'zstd-napi/deps/zstd/LICENSE'), 'utf8')],
        ['libjpeg-turbo', fs.readFileSync(path.join(jpeg, 'LICENSE.md'), 'utf8')],
        ['libjpeg-turbo: README.ijg', fs.readFileSync(path.join(jpeg, 'README.ijg'), 'utf8')],
        ['The C library and the run-time library of emscripten', compiler],
    ];
    return `What is compiled into kiln.wasm and kiln-scalar.wasm besides kiln, whose licence is in LICENSE.\n${
        parts.map(([name, text]) => `\n==== ${name}\n\n${text.trim()}\n`).join('')}`;
}

const module = new WebAssembly.Module(fs.readFileSync(vectors));
const version = say(module, ['--version']).replace('kiln ', '').trim();
const engines = JSON.parse(say(module, ['engines', '--json']));

fs.rmSync(target, { recursive: true, force: true });
copy(source, target);
for (const [from, name] of [[vectors, 'kiln.wasm'], [scalar, 'kiln-scalar.wasm']])
    fs.writeFileSync(path.join(target, name), fs.readFileSync(from));
fs.copyFileSync(path.join(source, '../LICENSE'), path.join(target, 'LICENSE'));
fs.writeFileSync(path.join(target, 'LICENSES-OF-PARTS.txt'), licences());
fs.writeFileSync(path.join(target, 'engines.mjs'), '// What the command says of itself.\n' +
    `export const version = ${JSON.stringify(version)};\nexport const engines = ${JSON.stringify(engines, null, 4)};\n`);
makeLobes(path.join(target, 'lobes'), (words, output) =>
    runOn(module, words).written().find(({ name }) => name === output).bytes);
const about = JSON.parse(fs.readFileSync(path.join(source, 'package.json'), 'utf8'));
fs.writeFileSync(path.join(target, 'package.json'), `${JSON.stringify({ ...about, version }, null, 4)}\n`);
allow(target);
fs.chmodSync(path.join(target, 'bin.mjs'), 0o755);
const words = ['pack', '--ignore-scripts', '--silent', '--pack-destination', path.resolve(folder)];
const made = execFileSync('npm', words, { cwd: target, encoding: 'utf8' }).trim();
fs.writeFileSync(path.join(folder, 'name.txt'), `${made}\n`);
console.log(path.join(folder, made));

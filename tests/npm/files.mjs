// What `npx kiln-ibl` writes is what the native command writes, byte for byte: files, standard output and messages.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { command, filesBelow, folder, inFolder, makeInputs, native, root, runIn } from './lib.mjs';

// Each case is a command line, run in an empty folder below the folder of the inputs.
const CASES = [
    'bake ../../a.exr -o o.ktx2 --size 32',
    'bake ../../a.hdr -o o.dds --size 16 --format b10g11r11 --roughness 0,0.25,0.5,1',
    'bake ../../a.exr -o out/{face}_{level}.exr --size 16 --mirror --exposure 1.5 --rotate 30,20,10',
    'bake ../../a.exr -o p_%d.hdr --size 16 --shape panorama --lobe charlie --roughness 0.5,1 --up z',
    'bake ../../a.exr -o o.ktx2 --size 16 --sun extract --lights-file l.json --sh s.txt --irradiance d.exr',
    'bake ../../a.exr -o o.ktx2 --size 16 --format bc6h --sun clamp=5 --levels 3',
    'bake ../../a.exr -o o.ktx2 --size 16 --format uastc',
    'bake ../../a.exr -o o.ktx2 --size 32 --for three',
    'bake ../../a.exr -o o.exr --size 64 --for three-cubeuv',
    'bake ../../a.exr -o o.env --size 32 --for babylon',
    'bake ../../a.exr -o o --size 32 --for filament',
    'bake ../../a.exr -o o.glb --size 32 --for gltf --tune none',
    'bake ../../faces/{face}.exr -o o.png --size 16 --shape panorama --format rgbm --levels 1',
    'bake ../../a.png ../../b.png -o {name}.ktx2 --size 16',
    'bake ../../a.jpg ../../p.jpg -o {name}.exr --size 64 --shape panorama --levels 1 --format rgba32f',
    'bake ../../a.exr -o - --size 8',
    'sky -o s.exr --size 16',
    'lights ../../a.exr',
    'lights ../../a.exr --json',
    'info ../../a.exr ../../a.jpg',
    'tables --table dfg -o t.ktx2 --size 16',
    'tables --assignment -o dir',
    'eval --help',
    'fit --help',
    'engines three',
    'engines --json',
    'help --man',
    'help bake',
    'completions bash',
    '--version',
    '',
    'bake ../../a.exr',
    'bake ../../a.exr -o o.ktx2 --sise 3',
    'bake ../../a.exr -o no/such/o.ktx2',
    'bake ../../nothing.exr -o o.ktx2',
    'bake ../../nothing.hdr ../../a.hdr -o {name}.ktx2 --size 8',
    'info ../..',
    'bakes',
];

makeInputs();
fs.mkdirSync(inFolder('out'));

// Runs a case. Returns its result and its files, after which its folder is empty.
function result(program, line, number) {
    const where = inFolder('out', `${number}`);
    fs.rmSync(where, { recursive: true, force: true });
    fs.mkdirSync(path.join(where, 'out'), { recursive: true });
    return { ...runIn(where, program, line.split(' ').filter(Boolean)), files: filesBelow(where) };
}

const still = (text) => text.replace(/\d+\.\d\d s$/gm, 'TIME');

let files = 0, codes = new Set();
for (const [number, line] of CASES.entries()) {
    // The package's help knows no commands that draw.
    const trim = (text) => (line === '' || line === 'help --man' || line === 'completions bash' ? '' : text);
    const wanted = result(native, line, number), got = result(command, line, number);
    assert.equal(got.code, wanted.code, `${line}: ${got.stderr}`);
    assert.equal(still(trim(got.stdout)), still(trim(wanted.stdout)), line);
    assert.equal(still(trim(got.stderr)), still(trim(wanted.stderr)), line);
    assert.deepEqual(Object.keys(got.files).sort(), Object.keys(wanted.files).sort(), line);
    for (const name of Object.keys(wanted.files))
        assert.ok(wanted.files[name].equals(got.files[name]), `${line}: ${name} differs`);
    files += Object.keys(wanted.files).length;
    codes.add(wanted.code);
}
assert.deepEqual([...codes].sort(), [0, 1, 2]);
assert.ok(files > 50, `${files} files were compared`);

// zstd: another version of the library may write other frames, which hold the same levels.
const { ZSTDDecoder } = await import(path.join(root,
    'tests/engines/node_modules/three/examples/jsm/libs/zstddec.module.js'));
const decoder = new ZSTDDecoder();
await decoder.init();
function levels(bytes) {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
    assert.equal(view.getUint32(44, true), 2, 'zstd is scheme 2');
    return Array.from({ length: view.getUint32(40, true) }, (_, i) => {
        const [at, size, plain] = [0, 8, 16].map((offset) => Number(view.getBigUint64(80 + 24 * i + offset, true)));
        return Buffer.from(decoder.decode(bytes.subarray(at, at + size), plain));
    });
}
for (const level of ['', '=1', '=19']) {
    const line = `bake ../../a.exr -o o.ktx2 --size 64 -q --zstd${level}`;
    const [wanted, got] = [native, command].map((program) => levels(result(program, line, 'zstd').files['o.ktx2']));
    assert.equal(wanted.length, 7);
    wanted.forEach((data, i) => assert.ok(data.equals(got[i]), `${line}: level ${i} differs`));
}
// Each reads what the other wrote.
for (const [writer, reader] of [[native, command], [command, native]]) {
    const made = runIn(folder, writer, ['bake', 'a.exr', '-o', 'z.ktx2', '--size', '32', '--levels', '1', '--zstd', '-q']);
    assert.equal(made.code, 0, made.stderr);
    assert.equal(runIn(folder, reader, ['bake', 'z.ktx2', '-o', 'z.exr', '--size', '32', '-q']).code, 0);
}
console.log(`${CASES.length} command lines, ${files} files: the same; zstd decodes to the same`);

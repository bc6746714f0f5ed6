// bake(), kiln() and engines in Node: files, options, pictures in memory, errors, progress, abort.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { folder, inFolder, installed, kiln as run, makeInputs, native, root, runIn } from './lib.mjs';

makeInputs();
fs.writeFileSync(inFolder('import.mjs'), `export * from 'kiln-ibl';\n`);
const { bake, engines, kiln, version } = await import(pathToFileURL(inFolder('import.mjs')));
const read = (name) => fs.readFileSync(inFolder(name));
const sky = read('a.exr');

assert.equal(`kiln ${version}\n`, run('--version'));
assert.deepEqual(engines, JSON.parse(run('engines', '--json')));

// The native command's files, from bytes, from a buffer and from a blob; names by the engine's ending.
run('bake', 'a.exr', '-o', 'a.ktx2', '--for', 'three', '--size', '64', '--rotate', '30,5', '--mirror', '-q',
    '--irradiance', 'd.ktx2', '--irradiance-size', '16', '--sh', 'sh.json');
const options = { name: 'sub/a.exr', for: 'three', size: 64, rotate: [30, 5], mirror: true, sh: undefined,
                  irradiance: 'd.ktx2', irradianceSize: 16, zstd: false };
for (const input of [sky, new Uint8Array(sky).buffer, new Blob([sky])]) {
    const got = await bake(input, options);
    assert.deepEqual(got.files.map(({ name }) => name).sort(), ['a.ktx2', 'd.ktx2']);
    for (const { name, bytes } of got.files)
        assert.ok(read(name).equals(Buffer.from(bytes)), `${name} differs`);
    assert.deepEqual(got.sh, JSON.parse(read('sh.json')));
    assert.equal(got.levels.length, 4);
    assert.deepEqual(got.levels[0], { size: 64, roughness: 0 });
    assert.equal(got.report.output.path, 'a.ktx2');
    assert.deepEqual(got.lights, []);
}

// Every engine, by its own default names; the sun taken out.
const sizes = { playcanvas: 512, 'playcanvas-dds': 512 };
for (const engine of engines) {
    const { files } = await bake(sky, { name: 'a.exr', for: engine.name, size: sizes[engine.name] ?? 64, tune: 'none' });
    assert.ok(files.length > 0 && files.every(({ name, bytes }) => /^(a|sh)[._]/.test(name) && bytes.length > 100),
              `${engine.name}: ${files.map(({ name }) => name)}`);
}
// Pictures in memory: a panorama and a cube, of three and of four channels, and six files.
const picture = (width, height, channels, f) => ({ width, height, data: Float32Array.from(
    { length: width * height * channels }, (_, i) => f(i % channels, Math.floor(i / channels))) });
const sunny = await bake(picture(64, 32, 3, (_, i) => (i === 64 * 8 + 5 ? 5000 : 1)),
                         { name: 'a', size: 16, sun: 'extract', lightsFile: 'out/sun.json' });
assert.equal(sunny.lights.length, 1);
assert.deepEqual(sunny.files.map(({ name }) => name).sort(), ['a.ktx2', 'out/sun.json']);
assert.ok(sunny.lights[0].share > 0.5 && sunny.lights[0].direction[1] > 0.6, JSON.stringify(sunny.lights));
const constant = await bake(picture(32, 16, 3, () => 2.5), { size: 8 });
assert.equal(constant.files[0].name, 'input.ktx2');
assert.ok(Math.abs(constant.sh.coefficients[0][1] - 2.5 * Math.sqrt(4 * Math.PI)) < 1e-6);
assert.deepEqual(constant.report.input, { files: ['input'], shape: 'panorama', width: 32, height: 16 });
// One face, +Y, is light: the sky is above.
const cube = await bake(picture(16, 96, 4, (channel, i) => (channel < 3 && i >= 512 && i < 768 ? 1 : 0)), { size: 8 });
assert.equal(cube.report.input.shape, 'cube');
const [, y, z, x] = cube.sh.coefficients.map((rgb) => rgb[0]);
assert.ok(y > 0.5 && Math.abs(z) < 1e-6 && Math.abs(x) < 1e-6, `${[x, y, z]}`);
const faces = ['px', 'nx', 'py', 'ny', 'pz', 'nz'].map((face) => ({ name: `${face}.exr`, bytes: read(`faces/${face}.exr`) }));
run('bake', 'faces/{face}.exr', '-o', 'f.ktx2', '--size', '16', '-q');
assert.ok(read('f.ktx2').equals(Buffer.from((await bake(faces, { size: 16 })).files[0].bytes)));
// A name that looks like an option or like standard input is a name.
for (const name of ['-', '--json', '.exr'])
    assert.equal((await bake(sky, { name, size: 8 })).files[0].name, { '.exr': '.exr.ktx2' }[name] ?? `${name}.ktx2`);
await assert.rejects(bake({ data: new Float32Array(5), width: 2, height: 1 }), /needs a Float32Array of 6 or 8 numbers/);
await assert.rejects(bake('a.exr'), /neither bytes nor a picture/);

// Names lead nowhere above the files in memory.
const above = await bake(sky, { size: 8, output: '../../up/x.ktx2', sh: '../sh.json' });
assert.deepEqual(above.files.map(({ name }) => name).sort(), ['sh.json', 'up/x.ktx2']);
assert.equal(above.sh.bands, 3);

// Errors are the native command's sentences.
for (const [words, wrong] of [[['--sise', '3'], { sise: 3 }], [['--size', '0'], { size: 0 }],
                              [['--for', 'tree'], { for: 'tree' }], [['--lights', '2'], { lights: 2 }]]) {
    const { code, stderr } = runIn(folder, native, ['bake', 'a.exr', '-o', 'x.ktx2', ...words]);
    const said = stderr.split('\n')[0].replace('kiln: ', '').replace(/^(--sise)/, '$1=3');
    const error = await bake(sky, { name: 'a.exr', output: 'x.ktx2', ...wrong }).catch((caught) => caught);
    assert.deepEqual([error.name, error.exitCode, error.message.replace(/^(--sise)(?!=)/, '$1=3')], ['KilnError', code, said]);
}
await assert.rejects(bake(sky, { size: 40000 }), /must be from 1 to 32768; in WebAssembly's 4 GB of memory, cubes of up to 2048 fit$/);
fs.writeFileSync(inFolder('cut.exr'), sky.subarray(0, 2000));
const cut = runIn(folder, native, ['bake', 'cut.exr', '-o', 'x.ktx2']);
await assert.rejects(bake(sky.subarray(0, 2000), { name: 'cut.exr' }),
                     { exitCode: 1, message: cut.stderr.trim().replace('kiln: ', '') });

// Progress rises within each stage and passes through filtering.
const told = [];
await bake(sky, { name: 'a.exr', size: 128, onProgress: (fraction, stage) => told.push([stage, fraction]) });
assert.ok(told.some(([stage]) => stage === 'filtering'));
assert.ok(told.every(([, fraction]) => fraction >= 0 && fraction <= 1));
for (let i = 1; i < told.length; i++)
    assert.ok(told[i][0] !== told[i - 1][0] || told[i][1] > told[i - 1][1], `${told[i - 1]} then ${told[i]}`);

// Abort: before, and within a bake that would take long; the next bake works.
await assert.rejects(bake(sky, { signal: AbortSignal.abort(new Error('no')) }), /^Error: no$/);
const controller = new AbortController();
const began = performance.now();
setTimeout(() => controller.abort(), 200);
await assert.rejects(bake(sky, { name: 'a.exr', for: 'three', size: 1024, signal: controller.signal }), { name: 'AbortError' });
assert.ok(performance.now() - began < 1500, `the abort took ${performance.now() - began} ms`);
await bake(sky, { name: 'a.exr', size: 8 });

// Four at once.
const several = await Promise.all([8, 16, 32, 64].map((size) => bake(sky, { name: 'a.exr', size })));
assert.deepEqual(several.map(({ levels }) => levels[0].size), [8, 16, 32, 64]);

// The command in memory, with standard input and exit codes.
// Arguments that no command could understand are errors by a sentence, and a mistake in onProgress rejects the promise.
const mistake = new Error('mine');
await assert.rejects(bake(sky, { size: 16, onProgress() { throw mistake; } }), (error) => error === mistake);
for (const [call, sentence] of [
    [() => bake(sky, { onProgress: 'x' }), /onProgress must be a function/],
    [() => bake(sky, { signal: {} }), /signal must be an AbortSignal/],
    [() => bake(sky, { help: true }), /bake\(\) has no option help/],
    [() => bake(sky, { verbose: true }), /bake\(\) has no option verbose/],
    [() => bake(sky, { name: 5 }), /name must be a text that is not empty, not 5/],
    [() => bake(sky, { name: '' }), /name must be a text that is not empty, not ""/],
    [() => bake([]), /must hold the six faces/],
    [() => bake({ data: new Float32Array(24), width: -4, height: -2 }), /-4 x -2 texels has no texels/],
    [() => bake({ data: new Float32Array(0), width: 0, height: 0 }), /0 x 0 texels has no texels/],
    [() => kiln(), /takes an array of words/],
    [() => kiln('info x'), /takes an array of words/],
    [() => kiln(['info'], { files: {} }), /files must be an array/],
])
    await assert.rejects(call, sentence);
const small = await bake(sky, null);
assert.equal(small.report.output.file_count, 1);
assert.equal(small.report.output.sh, undefined);
assert.equal(small.files.length, 1);

const info = await kiln(['info', '-'], { input: sky });
assert.equal(info.code, 0);
assert.match(new TextDecoder().decode(info.stdout), /64 x 32/);
assert.equal((await kiln(['bakes'])).code, 2);
const made = await kiln(['sky', '-o', 'deep/er/s.hdr', '--size', '16']);
assert.deepEqual(made.files.map(({ name }) => name), ['deep/er/s.hdr']);

// JPEG pictures, good, with gain maps and damaged: the same texels or the same sentence as the native command, which
// decodes by libjpeg-turbo's vector code where the module has its C.
const withXmp = (jpeg, fields) => {
    const text = Buffer.from(`http://ns.adobe.com/xap/1.0/\0<x ${fields}/>`, 'latin1');
    return Buffer.concat([jpeg.subarray(0, 2), Buffer.of(0xff, 0xe1, 0, text.length + 2), text, jpeg.subarray(2)]);
};
const gainMap = Buffer.concat([withXmp(read('a.jpg'), 'hdrgm:Version="1.0"'),
    withXmp(read('p.jpg'), 'hdrgm:Version="1.0" hdrgm:GainMapMax="3" hdrgm:HDRCapacityMax="3"')]);
const pictures = [['a gain map', gainMap], ...fs.readdirSync(path.join(root, 'tests/corpus/jpeg')).sort()
    .map((name) => [name, fs.readFileSync(path.join(root, 'tests/corpus/jpeg', name))])];
let good = 0, gains = 0, bad = 0;
for (const [name, bytes] of pictures) {
    fs.writeFileSync(inFolder('c.jpg'), bytes);
    const words = ['bake', 'c.jpg', '-o', 'c.exr', '--shape', 'panorama', '--size', '8', '--levels', '1',
                   '--layout', 'panorama'];
    const wanted = runIn(folder, native, words);
    const got = await kiln(words, { files: [{ name: 'c.jpg', bytes }] });
    assert.equal(got.code, wanted.code, `${name}: ${got.stderr}`);
    if (!got.stderr.startsWith('kiln: out of memory: c.jpg: ')) // a module has 4 GB, which bogus sizes exceed
        assert.equal(got.stderr, wanted.stderr, name);
    if (got.code === 0)
        assert.ok(read('c.exr').equals(Buffer.from(got.files[0].bytes)), name);
    gains += got.code === 0 && got.stderr.includes(': a gain map of ');
    good += got.code === 0;
    bad += got.code !== 0;
}
assert.ok(good >= 5 && gains >= 1 && bad > 50, `${good} good, ${gains} gain maps and ${bad} damaged pictures`);
console.log(`JPEG: ${good} pictures, of which ${gains} with a gain map, and ${bad} damaged files as in the native command`);

// The functions need no more than Node's own modules, and the package says which files it has.
assert.ok(!fs.existsSync(path.join(installed, 'node_modules')));

// The command of the package as a process: standard input, pipes, links, permissions, several at once, signals.
import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { command, filesBelow, folder, inFolder, kiln, makeInputs, native, runIn } from './lib.mjs';

makeInputs();
kiln('bake', 'a.exr', '-o', 'wanted.ktx2', '--size', '32', '-q');
const wanted = fs.readFileSync(inFolder('wanted.ktx2'));
const same = (name) => assert.ok(fs.readFileSync(inFolder(name)).equals(wanted), `${name} differs`);
const bake = (...words) => runIn(folder, command, ['bake', 'a.exr', '--size', '32', '-q', ...words]);

// Standard input and output, through pipes.
const piped = spawnSync('sh', ['-c', `cat a.exr | "${command}" bake - -o - --size 32 -q | cat >piped.ktx2`], { cwd: folder });
assert.equal(piped.status, 0, piped.stderr.toString());
same('piped.ktx2');

// A reader that has gone ends the command by 128 + SIGPIPE, without a word.
const gone = spawnSync('bash', ['-c', `"${command}" engines | true; echo \${PIPESTATUS[0]}`], { cwd: folder });
assert.equal(gone.stdout.toString(), '141\n');
assert.equal(gone.stderr.toString(), '');

// A symbolic link stays, its target gets the file; permissions stay.
fs.mkdirSync(inFolder('far'));
fs.writeFileSync(inFolder('far/file.ktx2'), 'old', { mode: 0o640 });
fs.symlinkSync('far/file.ktx2', inFolder('link.ktx2'));
assert.equal(bake('-o', 'link.ktx2').code, 0);
assert.ok(fs.lstatSync(inFolder('link.ktx2')).isSymbolicLink());
same('far/file.ktx2');
assert.equal(fs.statSync(inFolder('far/file.ktx2')).mode & 0o777, 0o640);
fs.symlinkSync('round.ktx2', inFolder('round.ktx2')); // a link to itself
const round = bake('-o', 'round.ktx2');
assert.deepEqual([round.code, round.stderr], [1, 'kiln: round.ktx2: cannot be created: Symbolic link loop\n']);
fs.unlinkSync(inFolder('round.ktx2'));

// kiln check says what the native command says, of a right file and of one that is too bright.
for (const [name, code, ...words] of [['right.ktx2', 0], ['bright.ktx2', 1, '--exposure', '1']]) {
    kiln('bake', 'a.hdr', '-o', name, '--size', '32', '-q', ...words);
    const check = ['check', 'a.hdr', name, '--json'], said = runIn(folder, command, check);
    assert.deepEqual(said, runIn(folder, native, check));
    assert.equal(said.code, code, said.stdout);
}

// Names with spaces and letters of any language; both names of the command.
assert.equal(bake('-o', 'Umgebung für 東京.ktx2').code, 0);
same('Umgebung für 東京.ktx2');
assert.equal(runIn(folder, inFolder('node_modules/.bin/kiln-ibl'), ['--version']).stdout,
             runIn(folder, native, ['--version']).stdout);
const npx = spawnSync('npx', ['--no-install', 'kiln-ibl', '--version'], { cwd: folder });
assert.equal(npx.stdout.toString(), kiln('--version'), npx.stderr.toString());

// Where a file cannot be written, the old file stays and no other is left.
fs.writeFileSync(inFolder('far/kept.ktx2'), 'old');
const before = Object.keys(filesBelow(folder)).filter((name) => !name.startsWith('node_modules')).length;
const failed = spawnSync('bash', ['-c', `ulimit -f 4; exec "${command}" bake a.exr --size 32 -q -o far/kept.ktx2`],
                         { cwd: folder });
assert.equal(failed.status, 1);
assert.match(failed.stderr.toString(), /^kiln: far\/kept\.ktx2: cannot write \d+ bytes: /);
assert.equal(fs.readFileSync(inFolder('far/kept.ktx2'), 'utf8'), 'old');
assert.equal(Object.keys(filesBelow(folder)).filter((name) => !name.startsWith('node_modules')).length, before);

// Several at once in one folder, native ones among them, take no other's temporary file for their own.
fs.mkdirSync(inFolder('many'));
const ends = Array.from({ length: 6 }, (_, i) => new Promise((resolve) => {
    const child = spawn(i % 3 ? command : native, ['bake', 'a.exr', '-o', `many/${i % 2}.ktx2`, '--size', '32', '-q'],
                        { cwd: folder });
    child.on('exit', resolve);
}));
assert.deepEqual(await Promise.all(ends), [0, 0, 0, 0, 0, 0]);
assert.deepEqual(fs.readdirSync(inFolder('many')).sort(), ['0.ktx2', '1.ktx2']);
same('many/0.ktx2');
same('many/1.ktx2');

// A signal stops a long bake soon, with its exit code, and leaves nothing.
for (const [signal, code] of [['SIGINT', 130], ['SIGTERM', 143]]) {
    fs.mkdirSync(inFolder(signal));
    const child = spawn(process.execPath, [path.join(folder, 'node_modules/kiln-ibl/bin.mjs'), 'bake', 'a.exr', '-o',
                                           `${signal}/o.ktx2`, '--for', 'three', '--size', '1024'], { cwd: folder });
    await new Promise((resolve) => setTimeout(resolve, 1500));
    assert.equal(child.exitCode, null, 'the bake was over before its signal');
    const sent = Date.now();
    child.kill(signal);
    assert.equal(await new Promise((resolve) => child.on('exit', resolve)), code);
    console.log(`  ${signal}: ended after ${Date.now() - sent} ms`);
    assert.deepEqual(fs.readdirSync(inFolder(signal)), []);
}

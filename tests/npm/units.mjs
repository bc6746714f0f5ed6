// Parts of the npm package that need no WebAssembly: textures that components share, names in memory, and what is said
// of a file for another engine and of a server that answers with a web page. Run as: node units.mjs NPM_FOLDER
import assert from 'node:assert/strict';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const load = (name) => import(pathToFileURL(path.resolve(process.argv[2], name)));
const { Kept } = await load('kept.mjs'), { MemorySystem, plain } = await load('memory.mjs');
const later = () => new Promise((resolve) => { setTimeout(resolve, 5); });

// A texture is made once for all components, and disposed when the last of them has gone.
let disposed = 0, made = 0;
const start = async () => { made++; return { dispose: () => disposed++ }; };
const kept = new Kept(), read = () => kept.read('city', start);
let promise;
try { read(); } catch (thrown) { promise = thrown; }
assert.ok(promise instanceof Promise);
await promise;
const [first, second] = [read(), read()];
assert.equal(first, second);
const [endFirst, endSecond] = [kept.use('city', first), kept.use('city', second)];
endFirst();
await later();
assert.deepEqual([made, disposed], [1, 0]);
// React's strict mode ends the use of a component and begins it again at once.
endSecond();
const endAgain = kept.use('city', second);
await later();
assert.equal(disposed, 0);
endAgain();
await later();
assert.deepEqual([made, disposed], [1, 1]);
assert.throws(read, (thrown) => thrown instanceof Promise);
assert.equal(made, 2);
// An error is thrown once, and the next attempt starts anew.
let attempts = 0;
const fail = async () => { attempts++; throw new Error('no'); };
try { kept.read('none', fail); } catch (thrown) { await thrown; }
assert.throws(() => kept.read('none', fail), /^Error: no$/);
assert.throws(() => kept.read('none', fail), (thrown) => thrown instanceof Promise);
assert.equal(attempts, 2);

// Babylon.js has no reader for the KTX2 file of --for three.
const { loadEnvironment } = await load('babylon.mjs');
const beginning = Uint8Array.of(0xab, 0x4b, 0x54, 0x58, 0x20, 0x32, 0x30, 0xbb, 0x0d, 0x0a, 0x1a, 0x0a, 123);
const ktx2 = Object.assign(new Blob([beginning]), { name: 'city.ktx2' }); // as a File, which Node 18 has not
await assert.rejects(loadEnvironment(ktx2, {}, { babylon: { CubeTexture: class {} } }),
                     /^Error: city\.ktx2: the file is of the kind "KTX2", and not an environment that kiln baked with --for babylon/);

// Names lead nowhere above the files in memory.
for (const [name, wanted] of [['../x', 'x'], ['a/../../b', 'b'], ['./a//b', 'a/b'], ['/a/b/', 'a/b'], ['..', ''], ['a..b', 'a..b']])
    assert.equal(plain(name), wanted, name);
const system = new MemorySystem([], ['bake', '-o', '../out/x.ktx2'], undefined, () => {});
system.write(system.create('../out/x.ktx2'), Uint8Array.of(1, 2));
assert.deepEqual(system.written().map(({ name, bytes }) => [name, bytes.length]), [['out/x.ktx2', 2]]);
assert.equal(system.kind('out/x.ktx2'), 1);

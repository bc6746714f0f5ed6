// The tarball: packed twice it is the same bytes; it holds what its package.json names and nothing that runs at
// installation; README.md states its sizes.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import zlib from 'node:zlib';
import { filesBelow, inFolder, installed, kiln, root, tarball } from './lib.mjs';

// Packed again: another folder, umask and time zone.
const modules = ['wasm', 'wasm-scalar'].map((preset) => path.join(root, 'build', preset, 'npm/kiln.wasm'));
execFileSync('sh', ['-c', 'umask 077 && mkdir again && exec "$0" "$@"', process.execPath,
                    path.join(root, 'npm/tools/pack.mjs'), 'again', ...modules],
             { cwd: inFolder('.'), env: { ...process.env, TZ: 'Asia/Tokyo' } });
assert.ok(fs.readFileSync(inFolder('again', path.basename(tarball))).equals(fs.readFileSync(tarball)),
          'the tarball packed again differs');

const about = JSON.parse(fs.readFileSync(path.join(installed, 'package.json'), 'utf8'));
const files = filesBelow(installed);
assert.equal(`kiln ${about.version}\n`, kiln('--version'));
assert.equal(path.basename(tarball), `kiln-ibl-${about.version}.tgz`);
for (const field of ['scripts', 'dependencies', 'devDependencies', 'optionalDependencies'])
    assert.equal(about[field], undefined, field);
const named = [...Object.values(about.bin), ...Object.values(about.exports).flatMap((entry) =>
    (typeof entry === 'string' ? [entry] : Object.values(entry)))];
for (const name of named)
    assert.ok(files[path.posix.normalize(name)], `${name} is not in the package`);
for (const name of Object.keys(files))
    assert.match(name, /(\.mjs|\.d\.ts|\.wasm|README\.md|package\.json|LICENSE|LICENSES-OF-PARTS\.txt)$/);
for (const text of ['Meta Platforms', 'Independent JPEG Group', 'Rich Felker'])
    assert.ok(files['LICENSES-OF-PARTS.txt'].includes(text), text);

// Modules that an import leads to lie in the package, and those for browsers import nothing of Node.
const imported = (name) => [...files[name].toString().matchAll(/(?:^import|^export|} from|import\()\s?(?:[^'`]*from )?'([^']+)'/gm)]
    .map((match) => match[1]);
function reach(name, seen = new Set()) {
    if (seen.has(name))
        return seen;
    seen.add(name);
    for (const other of imported(name).filter((each) => each.startsWith('.')))
        reach(path.posix.join(path.posix.dirname(name), other), seen);
    return seen;
}
for (const name of ['index.mjs', 'worker.mjs', 'three.mjs', 'babylon.mjs', 'react.mjs'])
    for (const each of reach(name))
        assert.ok(!imported(each).some((other) => other.startsWith('node:')), `${name} leads to node: in ${each}`);

// Sizes in README.md, to five per cent: each change of the library moves them a little.
const readme = files['README.md'].toString();
const sizes = {
    'unpacked': Object.values(files).reduce((sum, bytes) => sum + bytes.length, 0) / 1e6,
    'kiln.wasm, gzipped': zlib.gzipSync(files['kiln.wasm'], { level: 9 }).length / 1e3,
    'kiln-scalar.wasm, gzipped': zlib.gzipSync(files['kiln-scalar.wasm'], { level: 9 }).length / 1e3,
};
for (const [what, size] of Object.entries(sizes)) {
    const stated = Number(readme.match(new RegExp(`\\| ${what} \\| ([0-9.]+) [kM]B`))?.[1]);
    assert.ok(Math.abs(stated / size - 1) < 0.05, `${what}: ${size.toFixed(2)}, README.md says ${stated}`);
    console.log(`  ${what}: ${size.toFixed(2)}`);
}

// The types of the package: TypeScript accepts types/use.ts, finds the mistakes in it, and finds no fault with the
// .d.ts files themselves. Types of vite name those of Node, which are not installed, so that what the compiler says of
// other packages does not count.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { inFolder, root, runIn } from './lib.mjs';

const types = path.join(root, 'tests/npm/types'), packages = path.join(types, 'node_modules');
assert.ok(fs.existsSync(packages), `packages are missing: run  npm ci --prefix ${path.relative('.', types)}`);
for (const name of ['use.ts', 'tsconfig.json'])
    fs.copyFileSync(path.join(types, name), inFolder(name));
for (const name of fs.readdirSync(packages).filter((each) => !each.startsWith('.')))
    fs.symlinkSync(path.join(packages, name), inFolder('node_modules', name));
const compiler = path.join(packages, 'typescript/bin/tsc');

// What the compiler says of the package and of the program.
function compile() {
    const { code, stdout } = runIn(inFolder('.'), process.execPath, [compiler, '-p', '.', '--pretty', 'false']);
    assert.ok(code === 0 || code === 2, `tsc: exit code ${code}\n${stdout}`);
    return stdout.split('\n').filter((line) => /^(use\.ts|node_modules\/kiln-ibl\/)/.test(line));
}
assert.deepEqual(compile(), []);

// The compiler reads the package's types: without a function that the program calls, it fails.
const three = inFolder('node_modules/kiln-ibl/three.d.ts');
fs.writeFileSync(three, fs.readFileSync(three, 'utf8').replace('function addLights', 'function addSuns'));
assert.match(compile().join('\n'), /^use\.ts.*addLights/);

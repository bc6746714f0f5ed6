// Each *.js of the page is an ES module to every Node, also to one that does not guess from the text
// what a file is: Node 18, or a later Node without --experimental-detect-module. Such a Node takes a
// file for CommonJS unless the nearest package.json says "type": "module".
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { check, folder, site } from './lib.mjs';

const guesses = process.allowedNodeEnvironmentFlags.has('--experimental-detect-module');
const flags = guesses ? ['--no-experimental-detect-module'] : [];

// The type of a file's default export in a fresh Node, or the first line of what goes wrong.
function load(file) {
    const program = `import(${JSON.stringify(pathToFileURL(file))})
        .then((loaded) => console.log(typeof loaded.default), (error) => console.log(error.message));`;
    return execFileSync(process.execPath, [...flags, '--input-type=module', '-e', program],
                        { encoding: 'utf8' }).split('\n')[0];
}

const names = fs.readdirSync(site).filter((name) => name.endsWith('.js'));
check(names.includes('baker.js') && names.includes('stage.js'), `${site} holds only ${names}`);
for (const name of names) {
    const got = load(path.join(site, name));
    check(got === 'function', `${name} is loaded as: ${got}`);
}

// Alone, without the package.json, the same file is refused: the flags do what they are for.
const alone = path.join(folder, 'alone.js');
fs.copyFileSync(path.join(site, 'baker.js'), alone);
fs.writeFileSync(path.join(folder, 'package.json'), '{}\n');
check(load(alone) !== 'function', 'alone.js is loaded, so this test cannot fail');
console.log(`${names.length} modules are loaded by Node ${process.version} ${flags}`);

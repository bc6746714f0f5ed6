// Makes the tables of trueReflections(): FOLDER/ENGINE-TAPS.mjs for each engine and each number of taps. Each module's
// default export is the table's halves in base64.
//     node npm/tools/lobes.mjs FOLDER KILN, with the native command KILN
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';

// Roughness of the levels of each engine's files, to which the coarsest levels do not belong: a level of roughness 1 has
// nothing but bands 0 to 2, which the harmonics show without interpolation, and a level of 4 x 4 texels is not smooth.
const CHAINS = {
    'three': [0, 1, 2, 3, 4].map((k) => 1 - Math.sqrt(1 - k / 5)),
    'three-cubeuv': [0, ...[7, 6, 5].map((mip) => 2 ** (-mip / 2) / 1.16), 0.21, 0.305, 0.4, 1.6 / 3, 2 / 3, 0.8],
    'babylon': [0, ...[1, 2, 3, 4, 5].map((k) => Math.sqrt(2 ** (k / 0.8) / 256 - 0.0005))],
};

export const LOBES = Object.keys(CHAINS).flatMap((engine) =>
    [1, 2, 3].map((taps) => ({ engine, taps, file: `${engine}-${taps}.mjs` })));

// The words of the command that writes a table of halves without a header into `output`.
const wordsOf = ({ engine, taps }, output) =>
    ['tables', '--table', 'lobes', '--taps', `${taps}`, '--levels', CHAINS[engine].map((r) => +r.toFixed(9)).join(),
     '--size', '32', '--format', 'f16', '-q', '-o', output];

// make(words, output) runs the command with these words and returns the bytes of the file `output`. Only tables for the
// engines named by `engines` and of at most `most` taps are made.
export function makeLobes(folder, make, engines = Object.keys(CHAINS), most = 3) {
    fs.mkdirSync(folder, { recursive: true });
    for (const table of LOBES.filter(({ engine, taps }) => engines.includes(engine) && taps <= most)) {
        const words = wordsOf(table, 'lobes.raw'), bytes = Buffer.from(make(words, 'lobes.raw'));
        if (bytes.length !== 8 * 32 * 32 * (table.taps + 1))
            throw new Error(`kiln ${words.join(' ')}: ${bytes.length} bytes`);
        fs.writeFileSync(path.join(folder, table.file), `// kiln ${words.slice(0, -3).join(' ')}\n` +
            `export default '${bytes.toString('base64')}';\n`);
    }
}

// The same by the native command.
export function makeLobesBy(kiln, folder, engines, most) {
    const cwd = fs.mkdtempSync(path.join(os.tmpdir(), 'kiln-'));
    try {
        makeLobes(folder, (words, output) => {
            execFileSync(kiln, words, { cwd });
            return fs.readFileSync(path.join(cwd, output));
        }, engines, most);
    } finally {
        fs.rmSync(cwd, { recursive: true });
    }
}

if (process.argv[1] === new URL(import.meta.url).pathname)
    makeLobesBy(path.resolve(process.argv[3]), path.resolve(process.argv[2]));

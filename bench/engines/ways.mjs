// The ways to light a scene in an engine: the engine's own filter where it has one (or cmgen for Filament, which has
// no filter in the browser), and kiln's file.
//   const ways = makeWays(BIN, FOLDER, ['--tune=none']);
// ways(engine) returns [{ maker, make }] for an engine of models.mjs. make(panorama) writes the file that the
// engine's page loads into FOLDER, and promises its name.
import { execFile, execFileSync } from 'node:child_process';
import path from 'node:path';
import { promisify } from 'node:util';

export function makeWays(bin, folder, more = []) {
    const run = (program, ...args) => promisify(execFile)(program, args, { cwd: folder, maxBuffer: 1 << 26 });
    const own = { maker: 'its own', make: async (panorama) => panorama };
    const cmgen = {
        maker: 'cmgen',
        make: async (panorama) => {
            const { name } = path.parse(panorama);
            await run('cmgen', '-q', '--format=ktx', '--size=256', `--deploy=cmgen-${name}`, panorama);
            return `cmgen-${name}/cmgen-${name}_ibl.ktx`;
        },
    };
    const byKiln = (engine, maker, ...options) => ({
        maker,
        make: async (panorama) => {
            const name = `${path.parse(panorama).name}-${engine.name}${options.join('').replace(/\W/g, '')}`;
            await run(path.join(bin, 'kiln'), 'bake', panorama, '--for', engine.name, '-q',
                '-o', `${name}${engine.ending}`, ...options, ...engine.words ?? []);
            return `${name}${engine.loads}`;
        },
    });
    return (engine) => [...engine.name === 'filament' ? [cmgen] : engine.filtersNothing ? [] : [own],
                        byKiln(engine, 'kiln'), ...more.map((fit) => byKiln(engine, `kiln ${fit}`, fit))];
}

// Returns kiln's description of an engine.
export const engineOf = (bin, name) =>
    JSON.parse(execFileSync(path.join(bin, 'kiln'), ['engines', '--json'], { encoding: 'utf8' }))
        .find((row) => row.name === name);

// Converts a panorama to .hdr, which every engine reads, with more options of `kiln bake` where these are given.
export const makePanorama = (bin, folder, from, name, more = []) =>
    execFileSync(path.join(bin, 'kiln'), ['bake', from, '--shape', 'panorama', '--roughness', '0', '--size', '512',
                                          '-q', '-o', name, ...more], { cwd: folder });

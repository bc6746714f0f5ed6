// The whole projects of docs/engines whose engines no test runs: node projects.mjs KILN WRITE FOLDER
// Each page's files are saved, and its lines "kiln bake" run in the project's folder and write the files that the
// project names. Then Unity's C# compiles against declarations of what it uses and loads each face and level from the
// right bytes; Bevy's Rust compiles against declarations; Unreal's Python runs on objects that accept every call.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';

const [kiln, write, folder] = process.argv.slice(2).map((name) => path.resolve(name));
const here = import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname);
const HALF = 1 / 2048; // of a value, which a half float is off by at most

function check(good, sentence) {
    if (!good)
        throw new Error(sentence);
}

const run = (program, args, cwd) => execFileSync(program, args, { cwd, encoding: 'utf8', stdio: ['ignore', 'pipe', 'inherit'] });

// Makes the project of a page, which has the files `names` and bakes `baked`, and returns its folder.
function makeProject(page, names, baked) {
    const text = fs.readFileSync(path.join(here, `../../docs/engines/${page}.md`), 'utf8');
    const section = text.split(/^(?=## )/m).find((each) => each.startsWith('## A whole project\n'));
    const files = [...section.matchAll(/[Tt]he\s+file\s+`([^`]*)`[^`]*?:\n\n```[a-z]*\n([^]*?)```$/gm)];
    const found = files.map(([, name]) => name);
    check(found.join() === names.join(), `${page}.md prints the files ${found}, not ${names}`);
    const site = path.join(folder, page);
    for (const [, name, content] of files) {
        fs.mkdirSync(path.dirname(path.join(site, name)), { recursive: true });
        fs.writeFileSync(path.join(site, name), content);
    }
    const texels = Array.from({ length: 32 }, () => Array(64).fill([24, 48, 192, 128]));
    fs.writeFileSync(path.join(site, 'city.exr'), Buffer.concat([
        Buffer.from('#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32 +X 64\n'), Buffer.from(texels.flat(2))]));
    const lines = [...section.matchAll(/^    kiln (bake .*)$/gm)].map(([, words]) => words.split(' '));
    check(lines.length === 1, `${page}.md bakes ${lines.length} times`);
    for (const [, place] of section.matchAll(/^    mkdir (.*)$/gm))
        fs.mkdirSync(path.join(site, place));
    run(kiln, [...lines[0], '-q'], site);
    for (const name of baked)
        check(fs.existsSync(path.join(site, name)), `${page}.md: ${lines[0].join(' ')} writes no ${name}`);
    return site;
}

// A finite half float that is not negative.
const valueOf = (h) => (h >> 10 ? (1024 + (h & 1023)) * 2 ** ((h >> 10) - 25) : h * 2 ** -24);

// The direction of the first texel of a face in Direct3D's order: of +X this is the corner at +Y and +Z, and so on.
function corner(face, size) {
    const t = 1 - 1 / size;
    const way = [[1, t, t], [-1, t, -t], [-t, 1, -t], [-t, -1, t], [-t, t, 1], [t, t, -1]][face];
    const length = Math.hypot(...way);
    return way.map((x) => x / length);
}

function checkUnity() {
    const SIZE = 512, LEVELS = 10;
    const site = makeProject('unity', ['Assets/City.cs', 'Assets/Editor/Linear.cs'], ['Assets/StreamingAssets/city.dds']);
    run('mcs', ['-warnaserror', '-nowarn:0169,0649', '-out:city.exe', path.join(here, 'projects/unity.cs'),
                'Assets/City.cs', 'Assets/Editor/Linear.cs'], site);
    run(write, ['unity', 'coded', `${SIZE}`, path.join(site, 'coded.dds')]);
    let most = 0, count = 0;
    for (const name of ['coded.dds', 'Assets/StreamingAssets/city.dds']) {
        const lines = run('mono', ['city.exe', name], site).trim().split('\n').map((line) => line.split(' '));
        const given = Number(lines.pop()[1]), { size } = fs.statSync(path.join(site, name));
        check(given === size, `City.Load reads ${given} of the ${size} bytes of ${name}`);
        for (const [face, level, ...bits] of name === 'coded.dds' ? lines.map((line) => line.map(Number)) : []) {
            const [x, y, z] = corner(face, SIZE >> level); // in Unity's axes, of which (-z, y, -x) are kiln's
            [-z, y, -x].forEach((d, c) => {
                const wanted = (1 + level) * (2 + d);
                most = Math.max(most, Math.abs(valueOf(bits[c]) - wanted) / wanted);
            });
            count++;
        }
    }
    console.log(`  unity: ${count} levels of faces, off by ${(100 * most).toFixed(3)} %`);
    check(count === 6 * LEVELS && most <= HALF, `${count} levels of faces are off by ${most}, bound ${HALF}`);
}

function checkBevy() {
    const site = makeProject('bevy', ['Cargo.toml', 'src/main.rs'], ['assets/city_specular.ktx2', 'assets/city_diffuse.ktx2']);
    run('rustc', ['--edition', '2021', '--crate-type', 'rlib', '--crate-name', 'bevy', path.join(here, 'projects/bevy.rs')], site);
    run('rustc', ['--edition', '2021', '-D', 'warnings', '--emit', 'metadata', '--extern', 'bevy=libbevy.rlib', 'src/main.rs'], site);
    const named = fs.readFileSync(path.join(site, 'src/main.rs'), 'utf8').match(/city_\w+\.ktx2/g).sort();
    check(named.join() === 'city_diffuse.ktx2,city_specular.ktx2', `main.rs loads ${named}`);
    console.log('  bevy: compiles');
}

function checkUnreal() {
    const site = makeProject('unreal', ['City.uproject', 'city.py'], ['city_unreal.hdr']);
    const { FileVersion } = JSON.parse(fs.readFileSync(path.join(site, 'City.uproject'), 'utf8'));
    check(FileVersion === 3, `City.uproject has the version ${FileVersion}`);
    const said = run('python3', [path.join(here, 'projects/unreal.py'), 'city.py'], site);
    const { size } = fs.statSync(path.join(site, 'city_unreal.hdr'));
    for (const line of [`import /Game ${size}`, 'set source_type SLS_SPECIFIED_CUBEMAP', 'set cubemap /Game/city_unreal'])
        check(said.split('\n').includes(line), `city.py does not "${line}":\n${said}`);
    console.log('  unreal: the panorama is imported and given to the sky light');
}

fs.rmSync(folder, { recursive: true, force: true });
checkUnity();
checkBevy();
checkUnreal();

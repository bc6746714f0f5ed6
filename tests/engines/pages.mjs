// The whole pages of docs/engines, as printed there, show the right picture:
//     node pages.mjs KILN FOLDER [PAGE...], where PAGE is the name of a file of docs/engines without .md
// Each section that has a page names its packages in a line "npm install" and bakes files in lines "kiln bake". The
// page stands in a folder with these packages and files alone, and asks no other server for anything. A section with
// main.jsx also has a line "npx esbuild", which bundles that file. The panorama has
// a blue upper half and a red lower half. A ball of smooth metal in the middle must show blue above and red below.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { withPage } from '../web/browser.mjs';
import { makeBall } from './glb.mjs';

const [kiln, folder] = process.argv.slice(2, 4).map((name) => path.resolve(name)), only = process.argv.slice(4);
const here = import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname);
const docs = path.join(here, '../../docs/engines');
// Patience is in milliseconds: on a busy machine three.js r183 filters the panorama of model-viewer for two minutes.
const WIDTH = 300, HEIGHT = 200, PATIENCE = 300000;

// Where the packages are installed, by what `npm install` is told. The built kiln-ibl also has the tables of
// trueReflections().
const PACKAGES = {
    'kiln-ibl': process.env.KILN_PACKAGE ?? '../../npm', 'three@0.183': 'node_modules/three-r183',
    'cesium': 'cesium/node_modules/cesium', '@galacean/engine': 'galacean/node_modules/@galacean/engine',
    '@google/model-viewer': 'model-viewer/node_modules/@google/model-viewer',
    ...Object.fromEntries(['@react-three/drei', '@react-three/fiber', 'react', 'react-dom', 'esbuild'].map((name) =>
        [name, `drei/node_modules/${name}`])),
    'three@0.187': 'drei/node_modules/three', // that drei imports, too: a bundle holds three.js once
};

// Further versions with which pages of a single package run.
const ALSO = {
    'three@0.183': ['versions/node_modules/three-r150', 'versions/node_modules/three-r186'],
    'babylonjs': ['versions/node_modules/babylonjs-5'],
};

function check(good, sentence) {
    if (!good)
        throw new Error(sentence);
}

// Radiance HDR, uncompressed: red, green, blue and a common exponent of each texel.
function makePanorama(file) {
    const texels = Array.from({ length: 32 }, (_, y) => Array(64).fill(y < 16 ? [24, 48, 192, 128] : [192, 48, 24, 128]));
    fs.writeFileSync(file, Buffer.concat([Buffer.from('#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32 +X 64\n'),
                                          Buffer.from(texels.flat(2))]));
}

// The sections of a file that have a whole page.
function pagesOf(name) {
    const text = fs.readFileSync(path.join(docs, `${name}.md`), 'utf8');
    return text.split(/^(?=## )/m).flatMap((section) => {
        const html = section.match(/^```html\n(<!doctype html>[^]*?)\n```$/m)?.[1];
        const lines = (start) => [...section.matchAll(new RegExp(`^    ${start} (.*)$`, 'gm'))].map(([, words]) => words.split(' '));
        if (!html)
            return [];
        const packages = lines('npm install')[0], heading = section.match(/^## (.*)/)?.[1] ?? '';
        const jsx = section.match(/^```jsx\n(import [^]*?)\n```$/m)?.[1];
        const one = { name, heading, html, jsx, packages, bakes: lines('kiln bake'), bundles: lines('npx esbuild') };
        const also = packages.length === 1 ? ALSO[packages[0]] ?? [] : [];
        return [one, ...also.map((place) => ({ ...one, places: { [packages[0]]: place } }))];
    });
}

function makeFolder({ html, jsx, packages, bakes, bundles, places = PACKAGES }, site) {
    fs.rmSync(site, { recursive: true, force: true });
    fs.mkdirSync(path.join(site, 'node_modules'), { recursive: true });
    for (const each of packages) {
        const link = path.join(site, 'node_modules', each.replace(/(.)@.*/, '$1'));
        fs.mkdirSync(path.dirname(link), { recursive: true });
        fs.symlinkSync(path.resolve(here, places[each] ?? `node_modules/${each}`), link);
    }
    makePanorama(path.join(site, 'city.exr'));
    for (const words of bakes)
        execFileSync(kiln, ['bake', '-q', ...words], { cwd: site });
    if (jsx)
        fs.writeFileSync(path.join(site, 'main.jsx'), jsx);
    for (const words of bundles)
        execFileSync('node_modules/esbuild/bin/esbuild', ['--log-level=warning', ...words], { cwd: site });
    fs.writeFileSync(path.join(site, 'model.glb'),
                     makeBall({ pbrMetallicRoughness: { metallicFactor: 1, roughnessFactor: 0.1 } }));
    fs.writeFileSync(path.join(site, 'index.html'), html.replace('<!doctype html>', '<!doctype html><link rel="icon" href="data:,">'));
}

// The colour of a pixel of a screenshot, which is left in `file`.
async function look(page, file) {
    const png = await page.screenshot({ path: file });
    return page.evaluate(async ([base64, places]) => {
        const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
        const bitmap = await createImageBitmap(new Blob([bytes]));
        const pen = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
        pen.drawImage(bitmap, 0, 0);
        return places.map(([x, y]) => [...pen.getImageData(x, y, 1, 1).data]);
    }, [png.toString('base64'), [[WIDTH / 2, 0.4 * HEIGHT], [WIDTH / 2, 0.6 * HEIGHT]]]);
}

async function prove(one, site, file) {
    await withPage(site, async (page, address) => {
        page.setDefaultTimeout(PATIENCE);
        await page.setViewportSize({ width: WIDTH, height: HEIGHT });
        await page.goto(address);
        for (const end = Date.now() + PATIENCE; ; await page.waitForTimeout(500)) {
            const [above, below] = await look(page, file);
            if (above[2] > above[0] + 40 && below[0] > below[2] + 40) {
                console.log(`  ${one.title}: ${above.slice(0, 3)} above, ${below.slice(0, 3)} below`);
                return;
            }
            check(Date.now() < end, `${one.title}: the ball shows ${above} above and ${below} below: see ${file}`);
        }
    });
}

const names = fs.readdirSync(docs).map((name) => path.parse(name).name).filter((name) => name !== 'README');
const all = names.flatMap(pagesOf);
check(all.length >= 10, `docs/engines has ${all.length} whole pages`);
const faults = [];
fs.mkdirSync(folder, { recursive: true });
for (const one of all.filter(({ name }) => !only.length || only.includes(name))) {
    one.title = `${one.name}, ${one.heading}, ${Object.values(one.places ?? one.packages)}`;
    const stem = path.join(folder, one.title.replace(/\W+/g, '-'));
    try {
        makeFolder(one, stem);
        await prove(one, stem, `${stem}.png`);
    } catch (error) {
        faults.push(`${one.title}: ${error.message}`);
    
    }
}
if (faults.length)
    throw new Error(faults.join('\n'));

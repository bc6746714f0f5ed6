// The examples of the npm package run as npm/README.md says, from the packed package alone, and show right pictures.
//     node examples.mjs PACKED FOLDER [EXAMPLE...], where PACKED holds the tarball and its name in name.txt
// Each example is copied to an empty folder, its dependency kiln-ibl becomes the tarball, and `npm install`,
// `npm start` and `npm run build` are typed. Pictures are left in FOLDER. A picture is right where the mirror ball
// shows a blue sky and every ball is lit, the built page shows what the development server shows, and in a dropped
// panorama of one colour everything has this colour.
import { execFileSync, spawn } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { serve } from '../../web/serve.mjs';
import { browse } from '../web/browser.mjs';
import { check } from './rig.mjs';

const [packed, folder] = process.argv.slice(2, 4).map((name) => path.resolve(name));
const tarball = path.join(packed, fs.readFileSync(path.join(packed, 'name.txt'), 'utf8').trim());
const examples = path.resolve(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname),
                              '../../npm/examples');
const WIDTH = 450, HEIGHT = 320; // of pages, of which TEXT rows at the bottom are for a line of text
const TEXT = 40;

// ---------------------------------------------------------------------------------------- what is seen

// A screenshot: at(x, y) is the red, green and blue of a pixel.
async function look(page, file) {
    const png = await page.screenshot({ path: file });
    const text = await page.evaluate(async (base64) => {
        const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
        const bitmap = await createImageBitmap(new Blob([bytes]));
        const pen = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
        pen.drawImage(bitmap, 0, 0);
        const { data } = pen.getImageData(0, 0, bitmap.width, bitmap.height);
        return new TextDecoder().decode(data.map((x) => x >> 1)); // of seven bits, one text, which is passed on quickly
    }, png.toString('base64'));
    const data = Buffer.from(text, 'latin1').map((x) => 2 * x);
    return { data, at: (x, y) => [...data.subarray(4 * (y * WIDTH + x), 4 * (y * WIDTH + x) + 3)] };
}

// Asks again until `good` is true of a picture, since pages tell nobody when they have drawn.
async function lookUntil(page, file, good, what) {
    for (const end = Date.now() + 120000; ; await page.waitForTimeout(500)) {
        const picture = await look(page, file);
        if (good(picture))
            return picture;
        check(Date.now() < end, `after 120 s the page does not show ${what}: see ${file}`);
    }
}

// Root of the mean square of the difference of two pictures, of 255, above the line of text.
function differ(a, b) {
    const end = 4 * WIDTH * (HEIGHT - TEXT);
    let sum = 0;
    for (let i = 0; i < end; i++)
        sum += (a.data[i] - b.data[i]) ** 2;
    return Math.sqrt(sum / (0.75 * end));
}

const blue = ([r, g, b]) => b > r + 10 && b > 60;
const lit = (rgb) => Math.max(...rgb) > 40;

// A panorama of one colour, as an uncompressed HDR file: 8 x 4 texels of red, green, blue and a common exponent.
const RED = Uint8Array.from([...new TextEncoder().encode('#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n'),
                             ...Array(32).fill([160, 40, 20, 128]).flat()]);
const red = ([r, g, b]) => r > 1.5 * g && g > b;

async function drop(page, name, bytes) {
    await page.evaluate(([file, content]) => {
        const data = new DataTransfer();
        data.items.add(new File([Uint8Array.from(content)], file));
        document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
    }, [name, [...bytes]]);
    await page.waitForFunction((file) => document.querySelector('p').textContent.startsWith(file), name.split('.')[0],
                               { timeout: 120000 });
}

// ---------------------------------------------------------------------------------------- each example

const rows = (xs, ys) => ys.flatMap((y) => xs.map((x) => [x, y]));
const EXAMPLES = {
    three: { balls: rows([80, 152, 225, 298, 370], [122, 195]), mirror: [80, 97], drops: true },
    babylon: { balls: rows([80, 152, 225, 298, 370], [122, 195]), mirror: [80, 97], drops: true, servedAlone: true },
    react: { balls: rows([135, 225, 315], [160]), mirror: [135, 130], presses: true },
    vite: { balls: rows([135, 225, 315], [160]), mirror: [135, 130], older: '0.170.0' },
};
const BEHIND = [225, 15];

async function proveExample(name, address, stage, say) {
    const { balls, mirror, drops, presses } = EXAMPLES[name];
    const sky = ({ at }) => blue(at(...mirror)) && balls.every((ball) => lit(at(...ball)));
    const file = (what) => path.join(folder, `${name}-${stage}-${what}.png`);
    let shown;
    await browse(address, (visit) => visit(async (page) => {
        await page.setViewportSize({ width: WIDTH, height: HEIGHT });
        await page.goto(address);
        shown = await lookUntil(page, file('start'), sky, 'a blue sky and lit balls');
        if (drops) {
            await drop(page, 'red.hdr', RED);
            await lookUntil(page, file('dropped'), ({ at }) => [...balls, BEHIND].every((place) => red(at(...place))),
                            'what was dropped');
            await drop(page, 'broken.hdr', RED.slice(0, 60));
            say(`a broken file: ${await page.locator('p').textContent()}`);
        }
        if (presses) {
            await page.getByRole('button').click();
            const more = await lookUntil(page, file('baked'), (picture) => differ(picture, shown) > 1 && sky(picture),
                                         'what was baked');
            say(`baked in the page: ${differ(more, shown).toFixed(2)} of 255 rms from the file without the sun`);
        }
    }));
    say(`${stage}: right`);
    return shown;
}

// ------------------------------------------------------------------------------------------- processes

const npm = (words, cwd) => execFileSync('npm', words, { cwd, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });

// Runs `npm start` until work(address) ends. The server and its npm are in a process group of their own.
async function whileServed(cwd, port, work) {
    const server = spawn('npm', ['start', '--', '--port', port, '--host', '127.0.0.1'], { cwd, detached: true });
    try {
        const address = await new Promise((resolve, reject) => {
            let said = '';
            const hear = (text) => {
                said += text;
                const found = said.replace(/\x1b\[[0-9;]*m/g, '').match(/http:\/\/127\.0\.0\.1:\d+\//);
                if (found)
                    resolve(found[0]);
            };
            server.stdout.on('data', hear);
            server.stderr.on('data', hear);
            server.on('exit', () => reject(new Error(`npm start ended: ${said}`)));
        });
        return await work(address);
    } finally {
        process.kill(-server.pid);
    }
}

async function proveBuilt(name, cwd, stage, say) {
    npm(['run', 'build', '--', '--base', './'], cwd);
    const { server, address } = await serve(path.join(cwd, 'dist'));
    try {
        return await proveExample(name, address, stage, say);
    } finally {
        server.close();
    }
}

// The plugin bakes once for the server and for the build, and another file for a version of three.js before r187.
async function proveOlder(name, cwd, version, say) {
    const kept = () => fs.readdirSync(path.join(cwd, 'node_modules/.vite/kiln-ibl')).length;
    const files = () => fs.readdirSync(path.join(cwd, 'dist/assets')).filter((each) => each.startsWith('sky-')).join();
    check(kept() === 1 && /^sky-[^,]*\.ktx2$/.test(files()), `${kept()} bakes are kept, and ${files()} is built`);
    npm(['install', '--no-audit', '--no-fund', `three@${version}`], cwd);
    await proveBuilt(name, cwd, 'older', say);
    check(kept() === 2 && /^sky-[^,]*\.exr$/.test(files()), `${kept()} bakes are kept, and ${files()} is built`);
    say(`with three.js ${version}: ${files()}`);
}

async function proveAll(name, port) {
    const say = (line) => console.log(`  ${name}: ${line}`);
    const cwd = path.join(folder, name);
    fs.cpSync(path.join(examples, name), cwd, {
        recursive: true, filter: (from) => !/node_modules|dist$|\/public\/[^.]/.test(path.relative(examples, from)),
    });
    const file = path.join(cwd, 'package.json'), about = JSON.parse(fs.readFileSync(file, 'utf8'));
    check(path.basename(about.dependencies['kiln-ibl']) === path.basename(tarball),
          `${name} asks for ${about.dependencies['kiln-ibl']}, the package is ${path.basename(tarball)}`);
    about.dependencies['kiln-ibl'] = `file:${tarball}`;
    fs.writeFileSync(file, JSON.stringify(about, null, 4));
    npm(['install', '--no-audit', '--no-fund'], cwd);
    const served = await whileServed(cwd, port, (address) => proveExample(name, address, 'served', say));
    if (EXAMPLES[name].servedAlone) // to bundle Babylon.js takes a minute of a processor
        return;
    const built = await proveBuilt(name, cwd, 'built', say);
    if (EXAMPLES[name].older)
        await proveOlder(name, cwd, EXAMPLES[name].older, say);
    const off = differ(served, built);
    say(`built and served differ by ${off.toFixed(3)} of 255 rms`);
    check(off < 0.5, `${name}: the built page shows another picture than the served one, by ${off}`);
    const dist = path.join(cwd, 'dist');
    const bytes = fs.readdirSync(path.join(dist, 'assets')).map((each) =>
        [each, fs.statSync(path.join(dist, 'assets', each)).size]);
    say(`assets: ${bytes.map(([each, size]) => `${each} ${size}`).join(', ')}`);
}

fs.rmSync(folder, { recursive: true, force: true });
fs.mkdirSync(folder, { recursive: true });
const asked = process.argv.slice(4);
for (const [i, name] of Object.keys(EXAMPLES).entries())
    if (!asked.length || asked.includes(name))
        await proveAll(name, 4810 + i);

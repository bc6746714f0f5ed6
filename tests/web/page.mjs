// The page as a visitor meets it: drop a file, bake, see, download; by keyboard; by address; and what
// a broken file does.
import { downloaded, drawn, drop, dropOn, idle, waitFor, withPage } from './browser.mjs';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { check, checkSame, folder, inFolder, kiln, kilnPath, read, root, site } from './lib.mjs';

const text = (page, id) => page.textContent(`#${id}`);
const levels = (page) => page.locator('#levels button').count();
const button = (page, name) => page.getByRole('button', { name, exact: true });
const openMore = (page) => page.evaluate(() => { document.getElementById('more').open = true; });
const cube = async (page) => {
    await openMore(page);
    return downloaded(page, () => button(page, 'Cube, KTX2').click());
};

function bakeByCommand(source, ...args) {
    kiln('bake', source, '-q', '-o', 'out.ktx2', '--sh', 'out.json', ...args);
    return read('out.ktx2');
}

// What the view shows, as the mean of its picture's bytes.
const brightness = (page) => page.evaluate(() => {
    const view = document.querySelector('#stage canvas:not([hidden])'), small = document.createElement('canvas');
    small.width = small.height = 16;
    const pen = small.getContext('2d');
    pen.drawImage(view, 0, 0, 16, 16);
    return pen.getImageData(0, 0, 16, 16).data.reduce((sum, v) => sum + v, 0) / 1024;
});

// Opens an address anew, also where only the part behind # differs from the page's.
let visits = 0;
function visit(page, address) {
    const url = new URL(address);
    url.search = `?${++visits}`;
    return page.goto(url.href);
}

const look = (page) => page.evaluate(() => document.getElementById('view').toDataURL());

async function theSkyIsBakedAtOnce(page, address) {
    await page.goto(`${address}#samples=1`);
    await idle(page);
    check(/^The sky: .* 9 levels baked in .* Nothing left this machine\.$/.test(await text(page, 'status')),
          `status says "${await text(page, 'status')}"`);
    kiln('sky', '-o', 'sky.exr', '--azimuth', '150');
    const { name, bytes } = await cube(page);
    check(name === 'sky.ktx2', `the download is called ${name}`);
    checkSame(bytes, bakeByCommand('sky.exr'), name);
    await drawn(page);
    check(await brightness(page) > 70, `the view is dark: ${await brightness(page)}`);
}

async function aFileIsDroppedAndBaked(page) {
    kiln('sky', '-o', 'low.hdr', '--size', '128', '--elevation', '5', '--azimuth', '-60');
    await drop(page, 'low.hdr', read('low.hdr'));
    check(/^low\.hdr: from a panorama of 256 x 128/.test(await text(page, 'status')),
          `status says "${await text(page, 'status')}"`);
    const { name, bytes } = await cube(page);
    check(name === 'low.ktx2', `the download is called ${name}`);
    checkSame(bytes, bakeByCommand('low.hdr'), name);
    const sh = await downloaded(page, () => button(page, 'Harmonics, JSON').click());
    checkSame(sh.bytes, read('out.json'), sh.name);
    // An EXR by Blender, DWAB.
    fs.copyFileSync(path.join(root, 'build/data/blender/city.exr'), inFolder('city.exr'));
    await drop(page, 'city.exr', read('city.exr'));
    checkSame((await cube(page)).bytes, bakeByCommand('city.exr'), 'city.ktx2');
    // A cube in rgb9e5, the default format of --for three.
    kiln('bake', 'low.hdr', '-q', '--for', 'three', '--size', '32', '-o', 'shared.ktx2');
    await drop(page, 'shared.ktx2', read('shared.ktx2'));
    check(/^shared\.ktx2: from a cube of 32/.test(await text(page, 'status')), `status says "${await text(page, 'status')}"`);
    checkSame((await cube(page)).bytes, bakeByCommand('shared.ktx2'), 'the cube of shared.ktx2');
    await drop(page, 'low.hdr', read('low.hdr'));
}

async function aBrokenFileGivesASentence(page) {
    const broken = { 'empty.hdr': Buffer.alloc(0), 'noise.exr': Buffer.alloc(300, 77),
                     'cut.hdr': read('low.hdr').subarray(0, 3000) };
    for (const [name, bytes] of Object.entries(broken)) {
        await drop(page, name, bytes);
        const sentence = await text(page, 'error');
        check(await page.isVisible('#error') && sentence.startsWith(`${name}: `) &&
              sentence.endsWith('.'), `of ${name} it says "${sentence}"`);
        check(await levels(page) === 9, `${await levels(page)} levels are left`);
    }
    const { name, bytes } = await cube(page);
    checkSame(bytes, bakeByCommand('low.hdr'), name);
    await drop(page, 'low.hdr', read('low.hdr'));
    check(!await page.isVisible('#error'), 'the sentence stays after a good file');
}

// A cube of floats with an infinite and a negative texel behind its header of 148 bytes.
async function whatWasFoundIsTold(page) {
    kiln('bake', 'low.hdr', '-q', '-o', 'odd.dds', '--format', 'rgba32f', '--size', '2', '--levels', '1');
    const bytes = read('odd.dds');
    bytes.writeFloatLE(Infinity, 148);
    bytes.writeFloatLE(-1000, 148 + 5 * 16);
    await drop(page, 'odd.dds', bytes);
    const report = await text(page, 'report');
    for (const sentence of ['odd.dds: 1 of 24 texels is infinite and became 65504.',
                            'odd.dds: 1 of 24 texels is negative and kept, with ',
                            ' values were negative, with '])
        check(report.includes(sentence), `the report says "${report}"`);
    await drop(page, 'low.hdr', read('low.hdr'));
    check(await text(page, 'report') === '', 'the report stays after a file without such texels');
}

async function theKeyboardSuffices(page, address) {
    await visit(page, `${address}#samples=1`);
    await idle(page);
    const focus = () => page.evaluate(() => document.activeElement.textContent ||
                                            document.activeElement.id);
    const tabTo = async (name) => {
        for (let i = 0; i < 60 && await focus() !== name; i++)
            await page.keyboard.press('Tab');
        check(await focus() === name, `${name} cannot be reached by Tab`);
    };
    await tabTo('Open a panorama');
    const chooser = page.waitForEvent('filechooser');
    await page.evaluate(() => {}); // the browser knows by now that somebody waits
    await page.keyboard.press('Enter');
    await (await chooser).setFiles({ name: 'low.hdr', mimeType: '', buffer: read('low.hdr') });
    await waitFor(page, () => /^low/.test(document.getElementById('status').textContent));
    await idle(page);
    await page.locator('#view').focus();
    const seen = [await look(page)];
    for (const key of ['ArrowRight', '+', 'm', '4']) {
        await page.keyboard.press(key);
        await drawn(page);
        seen.push(await look(page));
    }
    check(new Set(seen).size === seen.length, 'a key changes nothing that is seen');
    check(/scene=grid/.test(page.url()), `after 4 the address is ${page.url()}`);
    await page.keyboard.press('h');
    check(await page.isVisible('#keys'), 'h shows no keys');
    await page.keyboard.press('?');
    check(!await page.isVisible('#keys'), '? does not hide the keys');
    await openMore(page);
    await tabTo('Cube, KTX2');
    const { name, bytes } = await downloaded(page, () => page.keyboard.press('Enter'));
    checkSame(bytes, bakeByCommand('low.hdr'), name);
}

async function theAddressHoldsTheState(page, address) {
    await visit(page, `${address}#sun=8&bearing=40&size=64&turn=33.5&mirror=1&stops=-2.5&shown=2&samples=1&size2=x`);
    await idle(page);
    kiln('sky', '-o', 'low.exr', '--elevation', '8', '--azimuth', '40');
    const wanted = bakeByCommand('low.exr', '--size', '64', '--rotate', '33.5', '--mirror', '--exposure', '-2.5');
    checkSame((await cube(page)).bytes, wanted, 'the address\'s cube');
    check(await page.getAttribute('#levels li:nth-child(3) button', 'aria-pressed') === 'true',
          'level 2 is not the chosen one');
    await page.locator('#levels li:nth-child(5) button').click();
    const url = new URL(page.url());
    check(/shown=4/.test(url.hash) && /sun=8/.test(url.hash) && !/size2/.test(url.hash),
          `the address is ${url.hash}`);
    await visit(page, url.href);
    await idle(page);
    check(await page.getAttribute('#levels li:nth-child(5) button', 'aria-pressed') === 'true',
          'level 4 is not restored');
    checkSame((await cube(page)).bytes, wanted, 'the restored cube');
    // Nonsense in an address is no reason to fail.
    await visit(page, `${address}#sun=high&size=512.3&turn=&shown=-30&scene=moon&source=mine.exr`);
    await idle(page);
    check(await levels(page) === 10, `${await levels(page)} levels of 512`);
    check(/mine\.exr/.test(await text(page, 'error')), 'the missing file is not named');
}

// Every button's file is the command's.
async function theFilesAreTheCommands(page, address) {
    await visit(page, `${address}#size=64&samples=1`);
    await idle(page);
    await openMore(page);
    kiln('sky', '-o', 'sky.exr', '--azimuth', '150');
    const bake = (name, ...args) => kiln('bake', 'sky.exr', '-q', '--size', '64', '-o', name, ...args);
    const files = {
        'Cube, KTX2 of 32 bits': ['sky-32.ktx2', (name) => bake(name, '--format', 'rgba32f')],
        'Cube, DDS': ['sky.dds', (name) => bake(name)],
        'Irradiance, KTX2': ['sky-diffuse.ktx2', (name) => bake('other.ktx2', '--irradiance', name)],
        'Harmonics, C': ['sky.h', (name) => bake('other.ktx2', '--sh', name)],
        'Table of E': ['e.ktx2', (name) => kiln('tables', '-q', '-o', name)],
        'Table of E_avg': ['eavg.ktx2', (name) => kiln('tables', '-q', '--table', 'eavg', '-o', name)],
        'Table of A, B': ['dfg.ktx2', (name) => kiln('tables', '-q', '--table', 'dfg', '-o', name)],
    };
    for (const [label, [wanted, make]] of Object.entries(files)) {
        const { name, bytes } = await downloaded(page, () => button(page, label).click());
        check(name === wanted, `the download of "${label}" is called ${name}`);
        make(name);
        checkSame(bytes, read(name), name);
    }
    check(await button(page, 'Lights, JSON').isDisabled(), 'lights can be downloaded that are in the bake');
    const labels = await page.locator('#downloads button').allTextContents();
    const untried = labels.filter((label) => !files[label] &&
                                  !['Cube, KTX2', 'Harmonics, JSON', 'Lights, JSON'].includes(label));
    check(!untried.length, `nobody tries ${untried}`);
}

// The strongest light is taken out of the levels, told, and downloaded.
async function theSunIsTakenOut(page, address) {
    await visit(page, `${address}#size=64&samples=1&turn=20&stops=1&ground=1`);
    await idle(page);
    await drawn(page);
    const before = await look(page), whole = (await cube(page)).bytes;
    await page.locator('#controls .lil-title').getByText('Light', { exact: true }).click();
    await page.getByLabel('Sun and lamps').selectOption('Take out as lights');
    await idle(page);
    check(/lamps=extract/.test(page.url()), `the address is ${page.url()}`);
    check(/^sky: a light of radius 0\.\d+ degrees with [\d.]+ % of the light shines/.test(await text(page, 'report')),
          `the report says "${await text(page, 'report')}"`);
    const rest = (await cube(page)).bytes;
    const lights = await downloaded(page, () => button(page, 'Lights, JSON').click());
    check(lights.name === 'sky-lights.json', `the download is called ${lights.name}`);
    checkSame(rest, bakeByCommand('sky.exr', '--size', '64', '--rotate', '20', '--exposure', '1', '--sun', 'extract',
                                  '--lights-file', 'lights.json'), 'the rest');
    checkSame(lights.bytes, read('lights.json'), 'the lights');
    check(!rest.equals(whole), 'the sun is in the cube still');
    await drawn(page);
    check(await look(page) !== before, 'the disc is not seen');
    await theLinesAreTheDocumentations(page);
}

// What the documentation of engine `name` says: the output of the first command for the engine, the block
// of code that names that output, and the block of lights.
function documented(name) {
    const written = fs.readFileSync(path.join(root, 'docs/engines', `${name.split('-')[0]}.md`), 'utf8');
    const lines = written.split('\n'), command = new RegExp(`^    kiln bake city.exr --for ${name} -o (.*/)?([^/]+)$`);
    const at = lines.findIndex((line) => command.test(line)), output = lines[at].match(command)[2];
    const blocks = (text) => text.split('\n```').filter((_, i) => i % 2).map((block) => block.slice(block.indexOf('\n') + 1));
    const [, lights = ''] = written.split('\n## Lights that were taken out\n');
    return { output, lights: blocks(lights)[0] ?? '',
             load: blocks(lines.slice(at).join('\n')).find((block) => block.includes(output)) ??
                   lines.filter((line) => /^\d\. /.test(line)).join('\n').replace(/[*`]/g, '') };
}

// For each engine the page shows the lines of the engine's documentation, with the names of the files.
async function theLinesAreTheDocumentations(page) {
    const known = JSON.parse(kiln('engines', '--json'));
    check(known.length >= 12, `the command knows ${known.length} engines only`);
    const titles = await page.locator('#engine option').allTextContents();
    check(titles.join() === known.map(({ title }) => title).join(), `the page offers ${titles}`);
    for (const { name, title } of known) {
        const { load, lights, output } = documented(name);
        check(load.length > 60, `docs/engines has no lines for ${name}`);
        const wanted = `${load}${lights && `\n\n${lights}`}`.replaceAll('city/city', 'sky')
            .replace(/'sun\.json'/g, "'sky-lights.json'").replace(/'kiln-ibl.(three|babylon)'/g, "'./$1.mjs'").replace(/city([._'"])/g, 'sky$1');
        check(wanted.includes(output.replace('city', 'sky')), `the lines of ${name} do not name ${output}`);
        await page.locator('#engine').selectOption(title);
        await waitFor(page, (code) => document.getElementById('lines').textContent === code, wanted);
    }
}

// The engine's files are the command's, alone and in the bundle, which Python's zipfile reads.
async function theEnginesFilesAreTheCommands(page, address) {
    await visit(page, `${address}#samples=1&engine=babylon&engineSize=64&tune=none&lamps=extract&turn=30&size=16`);
    await idle(page);
    const bundle = await downloaded(page, () => button(page, 'Download all (.zip)').click());
    check(bundle.name === 'sky-babylon.zip', `the bundle is called ${bundle.name}`);
    fs.writeFileSync(inFolder('bundle.zip'), bundle.bytes);
    fs.mkdirSync(inFolder('bundle'));
    execFileSync('python3', ['-m', 'zipfile', '-e', 'bundle.zip', 'bundle'], { cwd: folder });
    kiln('bake', 'sky.exr', '-q', '--for', 'babylon', '-o', 'sky.env', '--size', '64', '--tune', 'none', '--rotate', '30',
         '--sun', 'extract', '--lights-file', 'sky-lights.json');
    const names = fs.readdirSync(inFolder('bundle')).sort();
    check(names.join() === 'README.txt,babylon.mjs,fetch.mjs,lobes.mjs,sky-lights.json,sky.env', `the bundle holds ${names}`);
    checkSame(read('bundle/sky.env'), read('sky.env'), 'sky.env');
    checkSame(read('bundle/sky-lights.json'), read('sky-lights.json'), 'sky-lights.json');
    // The loaders of the page are those of the package without trueReflections(), whose tables the page has not.
    for (const name of ['babylon.mjs', 'fetch.mjs', 'lobes.mjs']) {
        const lines = fs.readFileSync(path.join(root, 'npm', name), 'utf8').split('\n');
        const kept = name === 'lobes.mjs' ? lines : lines.filter((line) => !line.includes('trueReflections'));
        check(read(`bundle/${name}`).toString() === kept.join('\n'), `${name} is that of the package`);
    }
    const readme = read('bundle/README.txt').toString();
    check(readme.includes(await text(page, 'lines')), `the README says "${readme}"`);
    const again = await downloaded(page, () => page.getByRole('button', { name: /^sky\.env/ }).click());
    checkSame(again.bytes, read('sky.env'), again.name);
}

// On a narrow screen everything is there, each ball is named, and colours follow the system or the switch.
async function theLooksFollowTheVisitor(page, address) {
    await page.setViewportSize({ width: 390, height: 700 });
    await page.emulateMedia({ colorScheme: 'light' });
    await visit(page, `${address}#samples=1&size=16`);
    await idle(page);
    const seen = () => page.evaluate(() => {
        const box = (node) => node.getBoundingClientRect(), stage = box(document.getElementById('stage'));
        const marks = [...document.querySelectorAll('#labels span')].map((node) => [node.textContent, box(node)]);
        const controls = [...document.querySelectorAll('button, select, summary, canvas')].filter((node) => node.checkVisibility());
        return {
            width: document.documentElement.scrollWidth,
            labels: marks.map(([words]) => words),
            inside: marks.every(([, { left, right, top, bottom }]) => left >= stage.left && right <= stage.right &&
                                                                      top >= stage.top && bottom <= stage.bottom),
            beyond: controls.filter((node) => !node.closest('#levels') && (box(node).left < 0 || box(node).right > 390))
                .map((node) => node.textContent || node.id),
            back: getComputedStyle(document.body).backgroundColor,
            bare: [...document.querySelectorAll('#controls .lil-controller')].filter((node) => !/\.$/.test(node.title))
                .map((node) => node.textContent),
            brightest: document.getElementById('brightest').textContent,
        };
    });
    const light = await seen();
    check(light.width === 390, `the page is ${light.width} wide`);
    check(light.inside && light.labels.join('; ') === 'glossy 0.15; 0.35; 0.55; 0.75; rough 0.95; Light that ' +
          'bounces more than once is added back; Without that light, rough balls are too dark', `labels are ${light.labels}`);
    check(!light.beyond.length, `beyond the edges are ${light.beyond}`);
    check(!light.bare.length, `no sentence says what these controls do: ${light.bare}`);
    check(/^Brightest value 1\.2e6: half floats end at 65504/.test(light.brightest), `it says "${light.brightest}"`);
    await page.locator('#theme').click();
    const dark = await seen();
    check(light.back !== dark.back, `both themes are ${light.back}`);
    await page.reload();
    await idle(page);
    check((await seen()).back === dark.back, 'the chosen theme is forgotten');
    await page.emulateMedia({ colorScheme: 'dark' });
    await page.evaluate(() => localStorage.clear());
    await page.reload();
    await idle(page);
    check((await seen()).back === dark.back, 'the theme is not the system\'s');
    await page.locator('#presets').getByText('Noon').click();
    await idle(page);
    check(/sun=62/.test(page.url()), `after Noon the address is ${page.url()}`);
    await page.setViewportSize({ width: 480, height: 360 });
}

// What the panel of checks says of a file: the verdict, and the sentences.
const checked = async (page, name) => {
    await waitFor(page, (file) => document.getElementById('check-verdict').textContent.startsWith(`${file} is `) &&
        !document.getElementById('check-report').hidden, name);
    return { verdict: await text(page, 'check-verdict'), wrong: await page.locator('#check-verdict.wrong').count() > 0,
             sentences: await page.locator('#check-findings li').allTextContents(),
             levels: await page.locator('#check-levels tr:has(td)').count() };
};

// A file beside the panorama: what the command says of the file stands on the page, and the balls show its levels.
async function aSecondFileIsChecked(page, address) {
    await visit(page, `${address}#samples=1&size=16`);
    await idle(page);
    kiln('bake', 'city.exr', '-q', '--shape', 'panorama', '--size', '64', '--levels', '1', '-o', 'small.hdr');
    const bake = (name, ...args) => kiln('bake', 'small.hdr', '-q', '--size', '32', '--tune', 'none', '-o', name, ...args);
    bake('mirror.glb', '--for', 'gltf', '--mirror');
    bake('right.ktx2', '--for', 'three', '--sh', 'right.json');
    const file = (name) => ({ name, bytes: read(name) });
    await dropOn(page, 'body', ['mirror.glb', 'small.hdr'].map(file));
    const mirror = await checked(page, 'mirror.glb');
    const [{ levels, harmonics }] = JSON.parse(execFileSync('sh', ['-c', `"${kilnPath}" check small.hdr mirror.glb --json || true`],
                                                            { cwd: folder, encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] }));
    check(mirror.wrong && mirror.sentences.includes('The environment is mirrored: left and right are swapped.') &&
          mirror.sentences.length === levels.findings.length + harmonics.findings.length, `of a mirror image it says "${mirror.sentences}"`);
    check(mirror.levels === levels.levels.length && mirror.verdict.includes(`${Number((100 * levels.worst).toPrecision(3))} %`),
          `the verdict is "${mirror.verdict}", the command's worst error ${levels.worst}`);
    check(await page.locator('#check-canvases canvas').count() === mirror.levels, 'a picture of a level is missing');
    check(/^small\.hdr/.test(await text(page, 'status')), `the panorama is "${await text(page, 'status')}"`);

    // The right half of the balls is the mirror image's, until the right file takes its place.
    await button(page, 'Show on the balls').click();
    check(/scene=check/.test(page.url()), `the address is ${page.url()}`);
    await waitFor(page, () => /right of it mirror\.glb$/.test(document.getElementById('note').textContent));
    await drawn(page);
    const halves = () => page.evaluate(() => {
        const view = document.getElementById('view'), small = document.createElement('canvas');
        Object.assign(small, { width: 64, height: 32 });
        const pen = small.getContext('2d', { willReadFrequently: true });
        pen.drawImage(view, 0, 0, 64, 32);
        const of = (x) => [...pen.getImageData(x, 0, 30, 32).data];
        return { left: of(0), right: of(34) };
    });
    const far = (a, b) => Math.max(...a.map((value, i) => Math.abs(value - b[i])));
    const mirrored = await halves();
    await dropOn(page, '#check', [file('right.ktx2')]);
    const right = await checked(page, 'right.ktx2');
    check(!right.wrong && right.sentences.every((sentence) => /axes are those of three/.test(sentence)),
          `of kiln's own file it says "${right.verdict} ${right.sentences}"`);
    await waitFor(page, () => /right of it right\.ktx2$/.test(document.getElementById('note').textContent));
    await drawn(page);
    const straight = await halves();
    check(far(straight.left, mirrored.left) <= 1, 'the exact half changes with the file');
    check(far(straight.right, mirrored.right) > 20, `the file's half stays: ${far(straight.right, mirrored.right)}`);

    // Another engine expects other axes; harmonics are checked alone; a broken file gives a sentence.
    await page.locator('#check-engine').selectOption('unity');
    await waitFor(page, () => /turned by 90/.test(document.getElementById('check-findings').textContent) ||
                               /mirrored/.test(document.getElementById('check-findings').textContent));
    await page.locator('#check-engine').selectOption('');
    await dropOn(page, 'body', [file('right.json')]);
    const alone = await checked(page, 'right.json');
    check(!alone.wrong && !alone.levels && /harmonics err by/.test(alone.verdict), `it says "${alone.verdict}"`);
    await dropOn(page, '#check', [{ name: 'cut.glb', bytes: read('mirror.glb').subarray(0, 900) }]);
    await waitFor(page, () => /^cut\.glb: the glTF file is cut off/.test(document.getElementById('error').textContent));

    // The panorama is placed as by the command.
    await page.evaluate(() => {
        document.body.setAttribute('aria-busy', 'true');
        location.hash = `${location.hash}&turn=33.5&pitch=12&roll=-20&up=z&mirror=1`;
    });
    await idle(page);
    checkSame((await cube(page)).bytes, bakeByCommand('small.hdr', '--size', '16', '--rotate', '33.5,12,-20', '--up', 'z', '--mirror'),
              'the placed cube');
}

const flatError = (page, wanted) => waitFor(
    page, (value) => document.getElementById('flat').dataset.error === value, wanted);

// The figure under the picture is the command's, which has the same rays and random numbers.
async function theErrorIsIntegrated(page, address) {
    await visit(page, `${address}#size=64&samples=1&debug=error&noise=0.4&alone=1&sun=60&fov=45&distance=330`);
    await idle(page);
    await flatError(page, 'whole');
    const note = await text(page, 'note');
    const [, screen, rms] = note.match(/blue too dark: ([0-9.]+) of 255 RMS, ([0-9.]+) of the mean/) ?? [];
    check(rms && Number(screen) > 0, `the note says "${note}"`);
    const [width, height] = await page.evaluate(() => {
        const flat = document.getElementById('flat');
        return [flat.width, flat.height];
    });
    kiln('sky', '-o', 'high.exr', '--elevation', '60', '--azimuth', '150');
    const said = kiln('render', 'high.exr', '-o', 'error.png', '--error', '--alone', '--noise', '0.4',
                      '--samples', '1', '--fov', '45', '--distance', '330', '--bake-size', '64', '--size', `${width}x${height}`);
    const [, wanted] = said.match(/error RMS ([0-9.]+)/);
    check(Math.abs(rms / wanted - 1) < 0.03, `the page's error is ${rms}, the command's ${wanted}`);
    // A change of the view is followed; what takes too long can be stopped, and the page lives on.
    await page.evaluate(() => { location.hash = `${location.hash.replace('noise=0.4', 'noise=0.01')}&azimuth=30`; });
    await idle(page);
    await waitFor(page, () => /^Integrating/.test(document.getElementById('background').textContent));
    await button(page, 'Stop').click();
    check(await text(page, 'background') === '', 'it does not stop');
    await page.waitForTimeout(600);
    check(await text(page, 'background') === '' && !await page.isVisible('#error'), 'it begins again');
    await cube(page);
}

// The textbook's half of compare comes by and by, and the page takes keys meanwhile.
async function theTextbookTakesItsTime(page, address) {
    await visit(page, `${address}#size=64&samples=1&scene=compare`);
    await page.evaluate(() => {
        const background = document.getElementById('background');
        window.told = [];
        new MutationObserver(() => window.told.push(background.textContent)).observe(background, { childList: true });
    });
    await idle(page);
    await waitFor(page, () => /^Sampling the right side/.test(document.getElementById('background').textContent));
    await page.locator('#view').focus();
    await page.keyboard.press('ArrowRight');
    await waitFor(page, () => document.getElementById('view').dataset.textbook === 'whole');
    const told = await page.evaluate(() => window.told);
    check(told.length > 4 && told.every((words) => !words || /^Sampling the right side: \d+ of 1024/.test(words)),
          `in the background is told: ${told.join(' / ')}`);
    check(/azimuth=5/.test(page.url()), `after a key the address is ${page.url()}`);
}

await withPage(site, async (page, address) => {
    // The pictures are drawn by the processor: most of the time goes into their pixels, and few of these will do.
    await page.setViewportSize({ width: 480, height: 360 });
    for (const test of [theSkyIsBakedAtOnce, aFileIsDroppedAndBaked, aBrokenFileGivesASentence,
                        whatWasFoundIsTold, theKeyboardSuffices, theAddressHoldsTheState,
                        theFilesAreTheCommands, theSunIsTakenOut, theEnginesFilesAreTheCommands,
                        theLooksFollowTheVisitor, aSecondFileIsChecked, theErrorIsIntegrated, theTextbookTakesItsTime]) {
        const began = Date.now();
        await test(page, address);
        console.log(`${test.name}: ${Date.now() - began} ms`);
    }
});

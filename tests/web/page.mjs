// The page as a visitor meets it: drop a file, bake, see, download; by keyboard; by address; and what
// a broken file does.
import { downloaded, drawn, drop, idle, withPage } from './browser.mjs';
import fs from 'node:fs';
import path from 'node:path';
import { check, checkSame, inFolder, kiln, read, root, site } from './lib.mjs';

const text = (page, id) => page.textContent(`#${id}`);
const levels = (page) => page.locator('#levels button').count();
const button = (page, name) => page.getByRole('button', { name, exact: true });
const cube = (page) => downloaded(page, () => button(page, 'Cube, KTX2').click());

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

async function theKeyboardSuffices(page, address) {
    await page.goto('about:blank');
    await page.goto(`${address}#samples=1`);
    await idle(page);
    const focus = () => page.evaluate(() => document.activeElement.textContent ||
                                            document.activeElement.id);
    const tabTo = async (name) => {
        for (let i = 0; i < 60 && await focus() !== name; i++)
            await page.keyboard.press('Tab');
        check(await focus() === name, `${name} cannot be reached by Tab`);
    };
    await tabTo('Choose a panorama');
    const chooser = page.waitForEvent('filechooser');
    await page.evaluate(() => {}); // the browser knows by now that somebody waits
    await page.keyboard.press('Enter');
    await (await chooser).setFiles({ name: 'low.hdr', mimeType: '', buffer: read('low.hdr') });
    await page.waitForFunction(() => /^low/.test(document.getElementById('status').textContent));
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
    await tabTo('Cube, KTX2');
    const { name, bytes } = await downloaded(page, () => page.keyboard.press('Enter'));
    checkSame(bytes, bakeByCommand('low.hdr'), name);
}

async function theAddressHoldsTheState(page, address) {
    await page.goto('about:blank');
    await page.goto(`${address}#sun=8&bearing=40&size=64&turn=33.5&stops=-2.5&shown=2&samples=1&size2=x`);
    await idle(page);
    kiln('sky', '-o', 'low.exr', '--elevation', '8', '--azimuth', '40');
    const wanted = bakeByCommand('low.exr', '--size', '64', '--rotate', '33.5', '--exposure', '-2.5');
    checkSame((await cube(page)).bytes, wanted, 'the address\'s cube');
    check(await page.getAttribute('#levels li:nth-child(3) button', 'aria-pressed') === 'true',
          'level 2 is not the chosen one');
    await page.locator('#levels li:nth-child(5) button').click();
    const url = new URL(page.url());
    check(/shown=4/.test(url.hash) && /sun=8/.test(url.hash) && !/size2/.test(url.hash),
          `the address is ${url.hash}`);
    await page.goto('about:blank');
    await page.goto(url.href);
    await idle(page);
    check(await page.getAttribute('#levels li:nth-child(5) button', 'aria-pressed') === 'true',
          'level 4 is not restored');
    checkSame((await cube(page)).bytes, wanted, 'the restored cube');
    // Nonsense in an address is no reason to fail.
    await page.goto('about:blank');
    await page.goto(`${address}#sun=high&size=512.3&turn=&shown=-30&scene=moon&source=mine.exr`);
    await idle(page);
    check(await levels(page) === 10, `${await levels(page)} levels of 512`);
    check(/mine\.exr/.test(await text(page, 'error')), 'the missing file is not named');
}

await withPage(site, async (page, address) => {
    for (const test of [theSkyIsBakedAtOnce, aFileIsDroppedAndBaked, aBrokenFileGivesASentence,
                        theKeyboardSuffices, theAddressHoldsTheState]) {
        const began = Date.now();
        await test(page, address);
        console.log(`${test.name}: ${Date.now() - began} ms`);
    }
});

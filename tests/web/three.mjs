// three.js in the page: its balls with kiln's file look like kiln's own picture, and more so than with three.js'
// own filter, which cuts the sun off:
//     node three.mjs KILN SITE FOLDER
import { drawn, idle, withPage } from './browser.mjs';
import { check, site } from './lib.mjs';

// The mean colour of 9 x 9 pixels in the middle of each ball, by the places of the numbers between the rows.
const colours = (page, id) => page.evaluate((name) => {
    const canvas = document.getElementById(name), copy = document.createElement('canvas');
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const pen = copy.getContext('2d');
    pen.drawImage(canvas, 0, 0);
    const places = [...document.querySelectorAll('#labels .roughness')].map(({ style }) => parseFloat(style.left) / 100);
    const rows = ['.above', '.below'].map((row) => parseFloat(document.querySelector(`#labels ${row}`).style.top) / 100);
    return [-0.29, 0.29].map((down) => places.map((x) => {
        const y = 0.5 * (rows[0] + rows[1]) + down * (rows[1] - rows[0]);
        const { data } = pen.getImageData(Math.round(x * copy.width) - 4, Math.round(y * copy.height) - 4, 9, 9);
        return [0, 1, 2].map((c) => data.reduce((sum, v, i) => sum + (i % 4 === c ? v : 0), 0) / 81);
    }));
}, id);

const off = (a, b) => Math.max(...a.map((v, c) => Math.abs(v - b[c])));

await withPage(site, async (page, address) => {
    await page.setViewportSize({ width: 900, height: 640 });
    await page.goto(`${address}#samples=1&material=white&background=1&sun=40`);
    await idle(page);
    await drawn(page);
    const [wanted] = await colours(page, 'view');
    await page.evaluate(() => { location.hash = `${location.hash}&scene=three`; });
    await page.waitForFunction(() => document.getElementById('three')?.dataset.drawn === 'finely', null, { timeout: 300000 });
    check(/^Both rows are drawn by three\.js/.test(await page.textContent('#note')), await page.textContent('#note'));
    const [kiln, own] = await colours(page, 'three');
    wanted.forEach((colour, i) => console.log(`ball ${i}: kiln's picture ${colour.map(Math.round)}, three.js with kiln's file ` +
                                              `${kiln[i].map(Math.round)}, with its own filter ${own[i].map(Math.round)}`));
    wanted.forEach((colour, i) => check(off(kiln[i], colour) <= 30, `ball ${i} of three.js is off by ${off(kiln[i], colour)}`));
    check(wanted.some((colour, i) => off(own[i], colour) > off(kiln[i], colour) + 15),
          'three.js\' own filter is as near as kiln\'s file, with a sun that it cuts off');
    // The camera moves on, and no other picture is filtered.
    const before = await colours(page, 'three');
    await page.evaluate(() => { location.hash = `${location.hash}&azimuth=25`; });
    await idle(page);
    await page.waitForFunction(() => document.getElementById('three').dataset.drawn === 'finely', null, { timeout: 300000 });
    check(JSON.stringify(await colours(page, 'three')) !== JSON.stringify(before), 'the camera stays');
});

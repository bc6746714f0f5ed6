// How the page feels: no task of the page's main thread takes more than 100 ms, and the first picture is there
// within 2 s of the bake, with WebGL drawn by the processor:
//     node speed.mjs KILN SITE FOLDER
// Both are measured in processor time, so that other programs on the machine do not change the result.
import fs from 'node:fs';
import path from 'node:path';
import { downloaded, drop, idle, withPage } from './browser.mjs';
import { check, root, site } from './lib.mjs';

const LONGEST = 100, FIRST_PICTURE = 2000; // ms

// Processor time in ms of all of the browser's processes.
async function used(session) {
    const { processInfo } = await session.send('SystemInfo.getProcessInfo');
    return 1000 * processInfo.reduce((sum, { cpuTime }) => sum + cpuTime, 0);
}

// The longest tasks of the page's main thread while `work` runs, in ms of processor time.
async function longest(browser, page, work) {
    await browser.startTracing(page, { categories: ['toplevel', '__metadata'] });
    await work();
    const { traceEvents } = JSON.parse((await browser.stopTracing()).toString());
    const main = new Set(traceEvents.filter(({ name, args }) => name === 'thread_name' && args.name === 'CrRendererMain')
        .map(({ pid, tid }) => `${pid} ${tid}`));
    const tasks = traceEvents.filter(({ name, pid, tid, tdur }) => /RunTask/.test(name) && tdur && main.has(`${pid} ${tid}`));
    check(tasks.length > 20, `the trace has ${tasks.length} tasks of the main thread`);
    return tasks.map(({ tdur }) => tdur / 1000).sort((a, b) => b - a).slice(0, 3);
}

const marked = (page, name) => page.waitForFunction(
    (mark) => performance.getEntriesByName(mark).length > 0, name, { timeout: 120000 });

await withPage(site, async (page, address) => {
    const browser = page.context().browser(), session = await browser.newBrowserCDPSession();
    await page.setViewportSize({ width: 1280, height: 900 });
    const clear = () => page.evaluate(() => performance.clearMarks());
    // The time of the processor from the bake to the first picture.
    const firstPicture = async (start) => {
        const began = start();
        await marked(page, 'baked');
        const before = await used(session);
        await marked(page, 'pictured');
        const spent = await used(session) - before;
        await began;
        return spent;
    };
    const drag = async () => {
        await page.mouse.move(400, 250);
        await page.mouse.down();
        for (let x = 400; x < 500; x += 10)
            await page.mouse.move(x, 250);
        await page.mouse.up();
    };
    const show = async () => {
        await page.locator('#levels button').nth(1).click();
        await page.locator('#levels button').nth(1).click();
        await page.locator('#engine').selectOption('PlayCanvas 2, .png');
    };
    let first;
    const works = {
        'the page is opened': async () => { first = await firstPicture(() => page.goto(`${address}#samples=1`)); },
        'a file is dropped': async () => {
            await idle(page);
            await clear();
            first = await firstPicture(() => drop(page, 'city.exr', fs.readFileSync(path.join(root, 'build/data/blender/city.exr'))));
        },
        'the view is dragged': drag,
        'levels and engines are chosen': show,
        'files are downloaded': () => downloaded(page, () => page.getByRole('button', { name: 'Download all (.zip)' }).click()),
    };
    await page.route('**/favicon.ico', (route) => route.fulfill({ body: '' }));
    await page.goto(`${address}style.css`); // the page's process, whose threads are named in the trace
    for (const [name, work] of Object.entries(works)) {
        first = 0;
        const tasks = await longest(browser, page, work);
        console.log(`${name}: longest tasks ${tasks.map((ms) => ms.toFixed(0)).join(', ')} ms` +
                    (first ? `, first picture ${first.toFixed(0)} ms after the bake` : ''));
        check(tasks[0] <= LONGEST, `when ${name}, a task takes ${tasks[0]} ms`);
        if (name !== 'the page is opened') // where the first picture waits for compilers, too
            check(first <= FIRST_PICTURE, `when ${name}, the first picture comes ${first} ms after the bake`);
    }
});

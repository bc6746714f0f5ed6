// A browser for the tests: Debian's Chromium, headless, software WebGL, a fresh profile.
import { chromium } from 'playwright-core';
import fs from 'node:fs';
import { serve } from '../../web/serve.mjs';

const FLAGS = ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
               '--disable-component-update', '--disable-sync', '--ignore-gpu-blocklist',
               '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];

// For pages that nobody sees: they run no faster in processes of their own.
export const HIDDEN = ['--renderer-process-limit=1', '--disable-gpu-compositing'];

// work(visit, address): with a browser and a served folder. visit(show, of) has show(page, fault) on a page of
// its own, which must say nothing on the console and ask nobody but its own server for anything. Every fault
// is reported, `of()` before it. All pages share what can be shared.
export async function withBrowser(site, work, flags = []) {
    const { server, address } = await serve(site);
    try {
        await browse(address, work, flags);
    } finally {
        server.close();
    }
}

// The same for a server that runs already.
export async function browse(address, work, flags = []) {
    const browser = await chromium.launch({ executablePath: '/usr/bin/chromium', args: [...FLAGS, ...flags] });
    const context = await browser.newContext({ viewport: { width: 900, height: 640 } });
    const faults = [];
    const visit = async (show, of = () => '') => {
        const fault = (text) => faults.push(`${of()}${text}`);
        const page = await context.newPage();
        page.setDefaultTimeout(240000); // ends the wait for a page that hangs, not for a slow machine
        page.on('pageerror', (error) => fault(`error: ${error.message}`));
        page.on('console', (line) => {
            if (line.type() === 'error')
                fault(`console: ${line.text()}`);
        });
        page.on('request', (request) => {
            const url = request.url();
            if (!url.startsWith(address) && !/^(blob|data):/.test(url))
                fault(`request to ${url}`);
        });
        try {
            await show(page, fault);
        } catch (error) {
            fault(error.stack);
        }
    };
    try {
        await work(visit, address);
    } catch (error) {
        faults.push(error.stack);
    } finally {
        await browser.close();
    }
    if (faults.length)
        throw new Error(faults.join('\n'));
}

// The same for one page.
export const withPage = (site, work, flags) =>
    withBrowser(site, (visit, address) => visit((page) => work(page, address)), flags);

// Waits until `fulfilled`, which runs in the page with the argument `value`, returns true. Calls it every 50 ms and not
// at each frame, since a browser that draws by software may take seconds for a frame.
export const waitFor = (page, fulfilled, value) => page.waitForFunction(fulfilled, value, { polling: 50 });

export const idle = (page) => waitFor(page, () => document.body.getAttribute('aria-busy') === 'false');

// The view has been drawn finely since the last change.
export const drawn = (page) => waitFor(page, () => document.getElementById('view').dataset.drawn === 'finely');

// Drops files { name, bytes } on the element `selector`.
export async function dropOn(page, selector, files) {
    const texts = files.map(({ name, bytes }) => [name, Buffer.from(bytes).toString('base64')]);
    await page.evaluate(([where, list]) => {
        const data = new DataTransfer();
        for (const [file, base64] of list)
            data.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], file));
        for (const type of ['dragover', 'drop'])
            document.querySelector(where).dispatchEvent(new DragEvent(type, { dataTransfer: data, bubbles: true,
                                                                              cancelable: true }));
    }, [selector, texts]);
}

// Drops bytes on the page as the file of a panorama, and waits until that is baked.
export async function drop(page, name, bytes) {
    await page.evaluate(() => document.body.setAttribute('aria-busy', 'true'));
    await dropOn(page, 'body', [{ name, bytes }]);
    await idle(page);
}

// What `press` makes the page download: its name and bytes.
export async function downloaded(page, press) {
    const [download] = await Promise.all([page.waitForEvent('download'), press()]);
    return { name: download.suggestedFilename(), bytes: fs.readFileSync(await download.path()) };
}

// A browser for the tests: Debian's Chromium, headless, software WebGL, a fresh profile.
import { chromium } from 'playwright-core';
import fs from 'node:fs';
import { serve } from '../../web/serve.mjs';

const FLAGS = ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
               '--disable-component-update', '--disable-sync', '--ignore-gpu-blocklist',
               '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];

// work(page, address): on the served page, which must say nothing on the console and ask nobody
// but its own server for anything.
export async function withPage(site, work) {
    const { server, address } = await serve(site);
    const browser = await chromium.launch({ executablePath: '/usr/bin/chromium', args: FLAGS });
    const faults = [];
    try {
        const page = await browser.newPage({ viewport: { width: 900, height: 640 } });
        page.on('pageerror', (error) => faults.push(`error: ${error.message}`));
        page.on('console', (line) => {
            if (line.type() === 'error')
                faults.push(`console: ${line.text()}`);
        });
        page.on('request', (request) => {
            const url = request.url();
            if (!url.startsWith(address) && !/^(blob|data):/.test(url))
                faults.push(`request to ${url}`);
        });
        await work(page, address);
    } catch (error) {
        faults.push(error.stack);
    } finally {
        await browser.close();
        server.close();
    }
    if (faults.length)
        throw new Error(faults.join('\n'));
}

export const idle = (page) => page.waitForFunction(
    () => document.body.getAttribute('aria-busy') === 'false', null, { timeout: 60000 });

// The view has been drawn finely since the last change.
export const drawn = (page) => page.waitForFunction(
    () => document.getElementById('view').dataset.drawn === 'finely', null, { timeout: 60000 });

// Drops bytes on the page as a file.
export async function drop(page, name, bytes) {
    await page.evaluate(([file, base64]) => {
        const data = new DataTransfer();
        data.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], file));
        for (const type of ['dragover', 'drop'])
            document.body.dispatchEvent(new DragEvent(type, { dataTransfer: data, bubbles: true,
                                                              cancelable: true }));
        document.body.setAttribute('aria-busy', 'true');
    }, [name, Buffer.from(bytes).toString('base64')]);
    await idle(page);
}

// What `press` makes the page download: its name and bytes.
export async function downloaded(page, press) {
    const [download] = await Promise.all([page.waitForEvent('download'), press()]);
    return { name: download.suggestedFilename(), bytes: fs.readFileSync(await download.path()) };
}

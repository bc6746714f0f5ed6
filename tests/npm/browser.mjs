// bake() in a browser, from the unpacked tarball served as it is: the native command's files, progress, abort, the
// module without vectors where an engine has none, and the package on another server than the page.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import http from 'node:http';
import { chromium } from '../web/node_modules/playwright-core/index.mjs';
import { withPage } from '../web/browser.mjs';
import { folder, inFolder, installed, kiln, makeInputs } from './lib.mjs';

makeInputs();
kiln('bake', 'a.exr', '-o', 'wanted.ktx2', '--for', 'three', '--size', '64', '-q');
fs.writeFileSync(inFolder('index.html'), '<!doctype html><meta charset="utf-8"><title>kiln-ibl</title><link rel="icon" href="data:,">');

// Runs in the page. Returns the file in base64, and what was seen.
async function bakeThere(scalar) {
    const validate = WebAssembly.validate;
    if (scalar)
        WebAssembly.validate = (bytes) => (bytes.length < 100 ? false : validate(bytes));
    const { bake, engines } = await import(`/node_modules/kiln-ibl/index.mjs?${scalar}`);
    const input = await (await fetch('/a.exr')).blob();
    let told = 0;
    const began = performance.now();
    const { files, report, sh } = await bake(input, { name: 'a.exr', for: 'three', size: 64, onProgress: () => told++ });
    const seconds = (performance.now() - began) / 1000;
    const controller = new AbortController();
    setTimeout(() => controller.abort(), 100);
    const stopped = await bake(input, { for: 'three', size: 1024, signal: controller.signal }).catch((error) => error.name);
    const wrong = await bake(input, { sise: 3 }).catch((error) => error.message);
    const bytes = Array.from(files[0].bytes, (byte) => String.fromCharCode(byte)).join('');
    return { base64: btoa(bytes), name: files[0].name, cpu: report.cpu, bands: sh.bands, told, stopped, wrong, seconds,
             engines: engines.length };
}

await withPage(folder, async (page, address) => {
    await page.goto(address);
    for (const scalar of [false, true]) {
        const got = await page.evaluate(bakeThere, scalar);
        assert.equal(got.name, 'a.ktx2');
        assert.ok(fs.readFileSync(inFolder('wanted.ktx2')).equals(Buffer.from(got.base64, 'base64')));
        assert.equal(got.cpu, scalar ? 'scalar' : 'simd128');
        assert.equal(got.bands, 3);
        assert.ok(got.told > 5 && got.engines >= 12, `${got.told} reports, ${got.engines} engines`);
        assert.equal(got.stopped, 'AbortError');
        assert.match(got.wrong, /--sise=3: no such option, did you mean --size\?$/);
        console.log(`  ${got.cpu}: the first bake took ${got.seconds.toFixed(2)} s`);
    }
});

// Two servers, which are two origins. withPage would take the second one's address for a fault.
const listen = (answer) => new Promise((resolve) => {
    const server = http.createServer(answer);
    server.listen(0, '127.0.0.1', () => resolve([server, `http://127.0.0.1:${server.address().port}`]));
});
const types = { mjs: 'text/javascript', wasm: 'application/wasm' };
const [packages, far] = await listen((request, response) => {
    const name = request.url.slice(1);
    response.writeHead(200, { 'Access-Control-Allow-Origin': '*', 'Content-Type': types[name.split('.')[1]] });
    response.end(fs.readFileSync(`${installed}/${name}`));
});
// As Vite's server does for a module that is bundled without its WebAssembly.
const [misses, missing] = await listen((request, response) => {
    const name = request.url.slice(1), wasm = name.endsWith('.wasm');
    response.writeHead(200, { 'Access-Control-Allow-Origin': '*', 'Content-Type': wasm ? 'text/html' : types[name.split('.')[1]] });
    response.end(wasm ? '<!doctype html><title>app</title>' : fs.readFileSync(`${installed}/${name}`));
});
const [pages, near] = await listen((request, response) => {
    response.writeHead(200, { 'Content-Type': 'text/html' });
    response.end('<!doctype html><title>kiln-ibl</title>');
});
const browser = await chromium.launch({ executablePath: '/usr/bin/chromium', args: ['--no-sandbox'] });
try {
    const page = await browser.newPage();
    await page.goto(near);
    const texel = await page.evaluate(async (address) => {
        const { bake } = await import(`${address}/index.mjs`);
        const { sh } = await bake({ data: new Float32Array(3 * 32 * 16).fill(2), width: 32, height: 16 }, { size: 8 });
        return sh.coefficients[0][0] / Math.sqrt(4 * Math.PI);
    }, far);
    assert.ok(Math.abs(texel - 2) < 1e-6, `the radiance is ${texel}`);
    console.log('  the package on another server: bakes');
    const problem = await page.evaluate(async (address) => {
        const { bake } = await import(`${address}/index.mjs`);
        return bake(new Uint8Array(10)).catch((error) => error.message);
    }, missing);
    assert.match(problem, /kiln.wasm was asked for .* a web page \(HTML\).* optimizeDeps: \{ exclude: \['kiln-ibl'\] \}/);
} finally {
    await browser.close();
    packages.close();
    misses.close();
    pages.close();
}

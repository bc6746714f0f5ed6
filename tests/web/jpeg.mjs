// The page reads JPEG files, with gain maps, as the command does:
//     node jpeg.mjs KILN SITE FOLDER
// A build of the command without JPEG (the environment's KILN_JPEG is 0) is not compared with.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import { withPage } from './browser.mjs';
import { checkSame, inFolder, kiln, read, site } from './lib.mjs';

// A panorama that the browser draws and writes as JPEG: of one grey, or with a slope of colours.
async function write({ grey, slope }) {
    const canvas = new OffscreenCanvas(64, 32), pen = canvas.getContext('2d');
    for (let x = 0; x < 64; x++) {
        pen.fillStyle = slope ? `rgb(${4 * x} ${grey} ${255 - 4 * x})` : `rgb(${grey} ${grey} ${grey})`;
        pen.fillRect(x, 0, 1, 32);
    }
    return [...new Uint8Array(await (await canvas.convertToBlob({ type: 'image/jpeg', quality: 1 })).arrayBuffer())];
}

async function bake({ bytes, name }) {
    const { Engine } = await import('/engine.mjs');
    const engine = new Engine();
    const source = await engine.open(new Uint8Array(bytes), name);
    const baked = await engine.bake({ size: 8, levels: 2 });
    const broken = await engine.open(new Uint8Array(bytes.slice(0, 400)), 'broken.jpg').catch((error) => error.message);
    const texels = baked.levels.map((level) => [...level.texels]).flat();
    return { source, notes: baked.notes, broken, least: Math.min(...texels), most: Math.max(...texels),
             file: [...await engine.file('out.ktx2', 'rgba32f')] };
}

// The picture with an XMP packet behind its first two bytes.
function withXmp(bytes, attributes) {
    const xmp = Buffer.from('http://ns.adobe.com/xap/1.0/\0<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF ' +
        'xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"><rdf:Description ' +
        `xmlns:hdrgm="http://ns.adobe.com/hdr-gain-map/1.0/" hdrgm:Version="1.0" ${attributes}/></rdf:RDF></x:xmpmeta>`, 'latin1');
    return [...bytes.slice(0, 2), 0xff, 0xe1, xmp.length + 2 >> 8, xmp.length + 2 & 255, ...xmp, ...bytes.slice(2)];
}

const linear = (byte) => ((byte / 255 + 0.055) / 1.055) ** 2.4;

await withPage(site, async (page, address) => {
    await page.goto(address);
    const grey = await page.evaluate(write, { grey: 188 }), white = await page.evaluate(write, { grey: 255 });
    const gain = withXmp(white, 'hdrgm:GainMapMin="0" hdrgm:GainMapMax="2" hdrgm:Gamma="1" hdrgm:OffsetSDR="0" ' +
                                'hdrgm:OffsetHDR="0" hdrgm:HDRCapacityMin="0" hdrgm:HDRCapacityMax="2"');
    const files = {
        'grey.jpg': [grey, linear(188)],
        'gain.jpg': [[...withXmp(grey, ''), ...gain], 4 * linear(188)], // 2^2 times as bright
        'slope.jpg': [await page.evaluate(write, { grey: 90, slope: true }), 0],
    };
    for (const [name, [bytes, wanted]] of Object.entries(files)) {
        const got = await page.evaluate(bake, { bytes, name });
        assert.deepEqual(got.source, { shape: 'panorama', width: 64, height: 32 });
        if (wanted)
            assert.ok(Math.abs(got.least - wanted) < 1e-5 && Math.abs(got.most - wanted) < 1e-5,
                      `texels of ${name} are ${got.least} to ${got.most}, not ${wanted}`);
        else
            assert.ok(got.most > 4 * got.least, `the slope is ${got.least} to ${got.most}`);
        assert.equal(got.notes.some((note) => /^a gain map of 64 x 32 was applied in full/.test(note)), name === 'gain.jpg');
        assert.match(got.broken, /^broken\.jpg: the JPEG /);
        console.log(`  ${name}: ${got.least} to ${got.most}; ${got.notes.join('; ')}`);
        fs.writeFileSync(inFolder(name), Buffer.from(bytes));
        if (process.env.KILN_JPEG === '0')
            continue;
        kiln('bake', name, '-q', '-o', 'out.ktx2', '--size', '8', '--levels', '2', '--format', 'rgba32f');
        checkSame(Buffer.from(got.file), read('out.ktx2'), name);
    }
});

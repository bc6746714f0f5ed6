// The page reads JPEG files by the browser's decoder, and tells of it:
//   node jpeg.mjs KILN SITE FOLDER
import assert from 'node:assert/strict';
import { withPage } from './browser.mjs';
import { site } from './lib.mjs';

// Bakes a panorama of one grey, which the browser itself writes as JPEG; `head` is inserted behind SOI.
async function bakeGrey({ grey, head }) {
    const { Engine } = await import('/engine.mjs');
    const canvas = new OffscreenCanvas(64, 32), pen = canvas.getContext('2d');
    pen.fillStyle = `rgb(${grey} ${grey} ${grey})`;
    pen.fillRect(0, 0, 64, 32);
    const jpeg = new Uint8Array(await (await canvas.convertToBlob({ type: 'image/jpeg', quality: 1 })).arrayBuffer());
    const bytes = new Uint8Array([...jpeg.slice(0, 2), ...head, ...jpeg.slice(2)]);
    const engine = new Engine();
    const source = await engine.open(bytes, 'grey.jpg');
    const baked = await engine.bake({ size: 8, levels: 2 });
    const broken = await engine.open(new Uint8Array([0xff, 0xd8, 0xff, 0xd9]), 'broken.jpg').catch((error) => error.message);
    const texels = baked.levels.map((level) => [...level.texels]).flat();
    return { source, notes: baked.notes, least: Math.min(...texels), most: Math.max(...texels), broken };
}

const xmp = Buffer.from('http://ns.adobe.com/xap/1.0/\0<x hdrgm:Version="1.0"/>', 'latin1');
const segment = [0xff, 0xe1, 0, xmp.length + 2, ...xmp];

await withPage(site, async (page, address) => {
    await page.goto(address);
    for (const head of [[], segment]) {
        const got = await page.evaluate(bakeGrey, { grey: 188, head });
        const wanted = ((188 / 255 + 0.055) / 1.055) ** 2.4;
        assert.deepEqual(got.source, { shape: 'panorama', width: 64, height: 32 });
        assert.ok(Math.abs(got.least - wanted) < 1e-5 && Math.abs(got.most - wanted) < 1e-5,
                  `texels are ${got.least} to ${got.most}, not ${wanted}`);
        assert.equal(got.notes[0], 'the browser decoded the JPEG to sRGB with 8 bits');
        assert.equal(got.notes.includes('the gain map of the JPEG was not applied, which the command kiln does'),
                     head.length > 0);
        assert.equal(got.broken, 'broken.jpg: the browser cannot decode this JPEG');
        console.log(`  grey 188 is ${got.least} to ${got.most}; ${got.notes.join('; ')}`);
    }
});

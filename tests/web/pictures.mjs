// The browser's pictures against those that `kiln render` makes without a screen: RMS at most 0.5 of
// 255, and no pixel more than 2 of 255 off that does not touch a silhouette.
import { drawn, idle, waitFor, withPage } from './browser.mjs';
import { check, kiln, read, site } from './lib.mjs';

const WIDTH = 192, HEIGHT = 108;

const SCENES = [
    ['assignment', {}, []],
    ['assignment', { asPrinted: 1 }, ['--as-printed']],
    ['ibl', { material: 'copper', azimuth: 20, turn: 70, stops: -4 },
     ['--material', 'copper', '--azimuth', '20', '--rotate', '70', '--exposure', '-4']],
    ['ibl', { material: 'plastic', method: 'turquin', occlusion: 1, background: 0.4, stops: -5 },
     ['--material', 'plastic', '--method', 'turquin', '--occlusion', '--background', '0.4',
      '--exposure', '-5']],
    ['ibl', { lamps: 'extract', ground: 1, turn: -160, elevation: 14, stops: -5 },
     ['--sun', 'extract', '--ground', '--rotate', '-160', '--elevation', '14', '--exposure', '-5']],
    ['furnace', {}, []],
    ['grid', { cubeDiffuse: 1, method: 'fdez-aguera', stops: -4 },
     ['--diffuse', 'cube', '--method', 'fdez-aguera', '--exposure', '-4']],
    ['compare', { split: 0.4, stops: -4 }, ['--split', '0.4', '--exposure', '-4']],
];

// The distances of the camera by which `kiln render` draws each scene. The page draws two of the scenes from other
// distances by default.
const CAMERAS = { ibl: { distance: 640 }, grid: { distance: 1170 }, assignment: {} };

// Red, green and blue bytes of the view, or of a PNG.
function pixels(page, png) {
    return page.evaluate(async ([base64, width, height]) => {
        const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
        const from = base64 ? await createImageBitmap(new Blob([bytes]))
                            : document.getElementById('view');
        const copy = new OffscreenCanvas(width, height), pen = copy.getContext('2d');
        pen.drawImage(from, 0, 0);
        return [...pen.getImageData(0, 0, width, height).data].filter((_, i) => i % 4 < 3);
    }, [png ? png.toString('base64') : '', WIDTH, HEIGHT]);
}

// Pixels whose neighbours differ from them by more than this in the picture lie on an edge.
const EDGE = 24;
function onEdge(picture, x, y) {
    const at = (i, j, c) => picture[3 * (Math.min(Math.max(j, 0), HEIGHT - 1) * WIDTH +
                                         Math.min(Math.max(i, 0), WIDTH - 1)) + c];
    for (let j = y - 1; j <= y + 1; j++)
        for (let i = x - 1; i <= x + 1; i++)
            for (let c = 0; c < 3; c++)
                if (Math.abs(at(i, j, c) - at(x, y, c)) > EDGE)
                    return true;
    return false;
}

function compare(got, wanted, name) {
    let sum = 0, most = 0, most_inside = 0, edges = 0, spread = 0;
    for (let y = 0; y < HEIGHT; y++)
        for (let x = 0; x < WIDTH; x++) {
            const edge = onEdge(wanted, x, y);
            edges += edge;
            for (let c = 0; c < 3; c++) {
                const i = 3 * (y * WIDTH + x) + c, off = Math.abs(got[i] - wanted[i]);
                sum += off * off;
                most = Math.max(most, off);
                most_inside = Math.max(most_inside, edge ? 0 : off);
                spread = Math.max(spread, Math.abs(wanted[i] - wanted[0]));
            }
        }
    const rms = Math.sqrt(sum / got.length);
    console.log(`${name}: RMS ${rms.toFixed(3)}, largest ${most}, away from edges ${most_inside} ` +
                `(${(100 * edges / WIDTH / HEIGHT).toFixed(0)} % edges)`);
    check(got.length === wanted.length && rms <= 0.5 && most_inside <= 2 &&
          edges < 0.4 * WIDTH * HEIGHT, `${name} is another picture`);
    check(name === 'furnace' || spread > 40, `${name} shows nothing`);
}

kiln('sky', '-o', 'sky.exr', '--elevation', '20', '--azimuth', '140');
await withPage(site, async (page, address) => {
    await page.goto(`${address}#size=64&samples=1`);
    await idle(page);
    await page.evaluate(([width, height]) => {
        Object.assign(document.getElementById('stage').style,
                      { width: `${width}px`, height: `${height}px`, minHeight: 0, justifySelf: 'start', alignSelf: 'start' });
    }, [WIDTH, HEIGHT]);
    for (const [scene, state, args] of SCENES) {
        const hash = new URLSearchParams({ scene, size: 64, sun: 20, bearing: 140, samples: 2, auto: 0,
                                           ...CAMERAS[scene] ?? CAMERAS.ibl, ...state });
        await page.evaluate((wanted) => {
            document.body.setAttribute('aria-busy', 'true');
            location.hash = wanted;
        }, hash.toString());
        await idle(page);
        if (scene === 'compare')
            await waitFor(page, () => document.getElementById('view').dataset.textbook === 'whole');
        await drawn(page);
        const bare = scene === 'assignment' || scene === 'furnace';
        kiln('render', ...(bare ? [] : ['sky.exr', '--bake-size', '64']), '-q', '-o', 'native.png', '--scene', scene,
             '--size', `${WIDTH}x${HEIGHT}`, '--samples', '2', ...args);
        compare(await pixels(page), await pixels(page, read('native.png')), scene);
    }
});

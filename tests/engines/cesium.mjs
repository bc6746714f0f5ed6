// CesiumJS shows what kiln wrote, and a light of `kiln lights`, by the lines of docs/engines/cesium.md.
import { BALL_VIEWS, INPUT, compareLight } from './lights.mjs';
import { cesium } from './models.mjs';
import { CELL, check, kiln, readFile } from './rig.mjs';

const LEAST = 0.001; // cosine that Cesium's shader gives to a surface that turns away from the light
// What the test's page must say after CesiumJS was given a cube in each format. CesiumJS' reader of KTX2 expects four
// numbers for each texel in every format. Where texels have fewer bytes, it reads beyond the end of the file and fails.
const FORMATS = { rgba16f: /^loaded$/, rgb9e5: /Invalid typed array length/, b10g11r11: /Invalid typed array length/,
                  bc6h: /Invalid typed array length/, uastc: /Invalid typed array length/ };
const HALVES = 1 / 2048; // by which pixels are rounded at most

export default [{
    name: 'cesium', title: 'lights in cesium', page: 'cesium/cesium.html',
    prepare: async () => {
        await kiln('lights', INPUT, '-o', 'cesium.json');
        return JSON.parse(readFile('cesium.json'));
    },
    check: async (lights, draw, say) =>
        compareLight(await draw('', BALL_VIEWS, [1], CELL, { lights }), lights, (n) => n, HALVES, say, LEAST),
}, {
    name: 'cesium', title: 'formats in cesium', page: 'cesium/cesium.html',
    prepare: () => Promise.all(Object.keys(FORMATS).map((format) =>
        kiln('bake', INPUT, '-q', '--size', 32, '--levels', 4, '--format', format, '-o', `cesium-${format}.ktx2`))),
    check: async (_, draw, say) => {
        for (const [format, wanted] of Object.entries(FORMATS)) {
            const said = await draw(`cesium-${format}.ktx2`, [], [], 0, { tries: true });
            say(`${format}: ${said}`);
            check(wanted.test(said), `of ${format} it says "${said}"`);
        }
    },
}, {
    ...cesium,
    bounds: { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-3, most: 2e-3 },
              real: { rms: 1e-3, most: 5e-3 }, diffuse: { rms: 1e-3, most: 5e-3 } },
}];

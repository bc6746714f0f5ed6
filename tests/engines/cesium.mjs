// CesiumJS shows what kiln wrote, and a light of `kiln lights`, by the lines of docs/engines/cesium.md.
import { BALL_VIEWS, INPUT, compareLight } from './lights.mjs';
import { cesium } from './models.mjs';
import { CELL, kiln, readFile } from './rig.mjs';

const LEAST = 0.001; // cosine that Cesium's shader gives to a surface that turns away from the light
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
    ...cesium,
    bounds: { coded: { axes: 0.01, lod: 0.01 }, white: { rms: 1e-3, most: 2e-3 },
              real: { rms: 1e-3, most: 5e-3 }, diffuse: { rms: 1e-3, most: 5e-3 } },
}];

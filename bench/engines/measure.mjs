// Errors of an engine's pixels: the engine draws white metal as in tests/engines, at 19 roughnesses in 192
// directions. The pixels are compared with the engine's own shading formula applied to light that a brute-force sum
// filters for each direction and roughness. The errors therefore come from mixing two levels and from interpolating
// texels, and not from the engine's formula.
import { execFileSync } from 'node:child_process';
import path from 'node:path';
import { makeViews, predict } from '../../tests/engines/rig.mjs';
import { engineOf } from './ways.mjs';

export const CELL = 4;
export const ROUGHNESS = Array.from({ length: 19 }, (_, i) => (10 + 5 * i) / 100);
// Six views, which show 192 directions.
export const VIEWS = makeViews([[0.9, 0.3, 0.1], [-0.9, -0.2, 0.2], [0.1, 0.9, 0.3], [-0.2, -0.9, 0.1],
                                [0.3, 0.2, 0.9], [-0.4, 0.1, -0.9]]);

// Returns the pixels [roughness][pixel][channel] that the engine would draw if the light of a panorama (a path) were
// filtered exactly. bench_reference is called once for all pixels.
export function truth(bin, engine, panorama) {
    const { size, level_count: count } = engineOf(bin, engine.name);
    const model = engine.model(count, size), asked = [];
    const asset = { radiance: () => [0, 0, 0], irradiance: () => [0, 0, 0] };
    const rows = ROUGHNESS.map((roughness) => VIEWS.map((view) =>
        predict(model, asset, view, roughness, ROUGHNESS).map((p) => {
            asked.push([p.r, ...model.toKiln(p.way)]);
            return p;
        })));
    // GGX of roughness 1 with n = v gives irradiance / pi.
    VIEWS.forEach((view) => view.normals.forEach((n) => asked.push([1, ...model.toKiln(n)])));
    const values = execFileSync(path.join(bin, 'bench_reference'), [panorama], {
        input: `${asked.map((line) => line.join(' ')).join('\n')}\n`, encoding: 'utf8', maxBuffer: 1 << 26,
    }).trim().split('\n').map((line) => line.split(' ').map(Number));
    if (values.length !== asked.length)
        throw new Error(`${values.length} values of brute force for ${asked.length} directions`);
    const each = VIEWS.length * VIEWS[0].normals.length, around = values.slice(-each);
    let at = 0;
    return rows.map((views) => views.flat().map((p, i) =>
        values[at++].map((x, c) => p.single * x + p.multiple * around[i][c])));
}

// Returns the RMS error at each roughness, relative to the RMS value of `whole`: the pixels wanted, or these with
// more light.
export function errors(shown, wanted, whole = wanted) {
    return ROUGHNESS.map((_, row) => {
        let off = 0, scale = 0;
        shown.flatMap((view) => view[row]).forEach((pixel, i) => pixel.forEach((x, c) => {
            off += (x - wanted[row][i][c]) ** 2;
            scale += whole[row][i][c] ** 2;
        }));
        return Math.sqrt(off / scale);
    });
}

export const overAll = (rms) => Math.sqrt(rms.reduce((sum, x) => sum + x * x, 0) / rms.length);
export const percent = (x) => (100 * x).toPrecision(2).padStart(6);

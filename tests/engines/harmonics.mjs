// The nine vectors by which trueReflections() knows bands 0 to 2 of an environment give, in every direction, what the
// spherical harmonics give, whatever the axes of the engine; and the irradiance polynomial of an .env file holds the
// harmonics that it was made of.
import assert from 'node:assert/strict';
import { checkHarmonics, harmonicsOf, lightOf } from '../../npm/lobes.mjs';

// Numbers that look random, -1 to 1.
let state = 1;
const random = () => {
    state = state * 16807 % 2147483647;
    return 2 * state / 2147483647 - 1;
};

// Orthonormal real spherical harmonics of bands 0 to 2 in the order l (l + 1) + m.
function basisAt([x, y, z]) {
    const pi = Math.PI;
    return [Math.sqrt(1 / (4 * pi)), ...[y, z, x].map((a) => Math.sqrt(3 / (4 * pi)) * a),
            ...[x * y, y * z].map((a) => Math.sqrt(15 / (4 * pi)) * a), Math.sqrt(5 / (16 * pi)) * (3 * z * z - 1),
            Math.sqrt(15 / (4 * pi)) * x * z, Math.sqrt(15 / (16 * pi)) * (x * x - y * y)];
}
const radianceAt = (coefficients, way) => [0, 1, 2].map((c) =>
    basisAt(way).reduce((sum, b, i) => sum + b * coefficients[i][c], 0));

const coefficients = Array.from({ length: 9 }, () => [random(), random(), random()]);
const axesOf = { kiln: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], three: [[0, 0, -1], [0, 1, 0], [1, 0, 0]],
                 babylon: [[1, 0, 0], [0, 1, 0], [0, 0, -1]] };
for (const [name, axes] of Object.entries(axesOf)) {
    const light = lightOf(coefficients, axes);
    assert.equal(light.length, 9);
    for (let i = 0; i < 100; i++) {
        const d = [random(), random(), random()], length = Math.hypot(...d), [x, y, z] = d.map((a) => a / length);
        const way = [0, 1, 2].map((k) => x * axes[0][k] + y * axes[1][k] + z * axes[2][k]);
        radianceAt(coefficients, way).forEach((wanted, c) => {
            const [mean, ex, ey, ez, xx, yy, xy, xz, yz] = light.map((rgb) => rgb[c]), zz = -xx - yy;
            const found = mean + ex * x + ey * y + ez * z + xx * x * x + yy * y * y + zz * z * z +
                          2 * (xy * x * y + xz * x * z + yz * y * z);
            assert.ok(Math.abs(found - wanted) < 1e-12, `${name}: ${found} in place of ${wanted}`);
        });
    }
}

// The polynomial of an .env file: in Babylon's axes, band 1 times 4/9 and band 2 times 1/16.
const [mean, ex, ey, ez, mxx, myy, mxy, mxz, myz] = lightOf(coefficients, axesOf.babylon);
const scale = (k, v) => v.map((a) => k * a), plus = (a, b) => a.map((x, i) => x + b[i]);
const zz = scale(-1, plus(mxx, myy));
const back = harmonicsOf({ x: scale(4 / 9, ex), y: scale(4 / 9, ey), z: scale(4 / 9, ez),
                           xx: plus(mean, scale(1 / 16, mxx)), yy: plus(mean, scale(1 / 16, myy)),
                           zz: plus(mean, scale(1 / 16, zz)), xy: scale(1 / 8, mxy), zx: scale(1 / 8, mxz),
                           yz: scale(1 / 8, myz) });
back.coefficients.forEach((rgb, i) => rgb.forEach((x, c) => assert.ok(Math.abs(x - coefficients[i][c]) < 1e-12,
    `coefficient ${i} is ${x} in place of ${coefficients[i][c]}`)));

for (const [sh, pattern] of [[{ coefficients, irradiance: true }, /those of the irradiance; leave out --sh-irradiance/],
                             [{ coefficients, window: 3 }, /are windowed; leave out --sh-window/],
                             [{ coefficients: coefficients.slice(0, 4) }, /9 coefficients of 3 numbers/],
                             [undefined, /9 coefficients of 3 numbers/]])
    assert.throws(() => checkHarmonics(sh, 'here'), pattern);

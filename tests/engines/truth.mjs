// What a rough metal truly reflects of an environment: the integral of the reflection model over all texels of a cube.
// In: a level of rig.mjs's readCube(), and the normal, direction and roughness of a patch. Out: the radiance of one
// bounce, and that with the further bounces as an engine adds them.
import { dot } from './rig.mjs';

// Direction, solid angle and radiance of each texel of a cube's faces, in one array of seven floats a texel.
export function texelsOf({ size, row }) {
    const axes = [(s, t) => [1, -t, -s], (s, t) => [-1, -t, s], (s, t) => [s, 1, t],
                  (s, t) => [s, -1, -t], (s, t) => [s, -t, 1], (s, t) => [-s, -t, -1]];
    const texels = new Float64Array(7 * 6 * size * size);
    for (let i = 0, at = 0; i < 6 * size; i++)
        for (let x = 0; x < size; x++, at += 7) {
            const [s, t] = [x, i % size].map((k) => 2 * (k + 0.5) / size - 1), length = Math.hypot(1, s, t);
            const way = axes[Math.floor(i / size)](s, t).map((c) => c / length);
            texels.set([...way, 4 / (size * size * length ** 3), ...row(i).slice(4 * x, 4 * x + 3)], at);
        }
    return texels;
}

// The radiance that GGX metal of the reflectance f0 reflects once towards v, with height-correlated masking by Smith
// and Schlick's Fresnel reflectance; the irradiance / pi at the normal n; and the albedo, of which f0 is 1.
export function reflect(texels, n, v, roughness, f0) {
    const a2 = roughness ** 4, nov = dot(n, v), once = [0, 0, 0], around = [0, 0, 0];
    const base = [0, 0, 0], rim = [0, 0, 0]; // the sums whose weights are 1 - (1 - v.h)^5 and (1 - v.h)^5
    let albedo = 0;
    const gv = Math.sqrt(a2 + (1 - a2) * nov * nov);
    for (let i = 0; i < texels.length; i += 7) {
        const x = texels[i], y = texels[i + 1], z = texels[i + 2], nol = n[0] * x + n[1] * y + n[2] * z;
        if (nol <= 0)
            continue;
        const vol = v[0] * x + v[1] * y + v[2] * z, half = Math.sqrt(2 + 2 * vol) || 1;
        const noh = (nol + nov) / half, voh = (1 + vol) / half;
        const d = a2 / Math.PI / (noh * noh * (a2 - 1) + 1) ** 2;
        const visible = 0.5 / (nol * gv + nov * Math.sqrt(a2 + (1 - a2) * nol * nol));
        const light = nol * texels[i + 3], weight = d * visible * light, f = (1 - voh) ** 5;
        albedo += weight;
        for (let c = 0; c < 3; c++) {
            const radiance = texels[i + 4 + c];
            around[c] += radiance * light / Math.PI;
            base[c] += radiance * weight * (1 - f);
            rim[c] += radiance * weight * f;
        }
    }
    for (let c = 0; c < 3; c++)
        once[c] = f0[c] * base[c] + rim[c];
    return { once, around, albedo };
}

// The light of further bounces as each engine adds it, which is no concern of the lobe. three.js, by Fdez-Aguera: diffuse
// light, where table(r, nov) is the engine's own A and B. Babylon.js: the same factor for all light.
export const addDiffuse = (table, f0) => ({ nov, r, once, around }) => {
    const [a, b] = table(r, nov), lost = 1 - a - b;
    return once.map((x, c) => {
        const average = f0[c] + (1 - f0[c]) / 21;
        return x + (f0[c] * a + b) * average / (1 - lost * average) * lost * around[c];
    });
};
export const brighten = (f0) => ({ once, albedo }) => once.map((x, c) => x * (1 + f0[c] * (1 / albedo - 1)));

// Differences of pictures are judged on a screen: steps of 255 after x / (x + mean), with the mean radiance of the
// environment.
export const toSteps = (mean) => (x) => 255 * Math.max(0, x) / (Math.max(0, x) + mean);

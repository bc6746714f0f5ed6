// Reflections of a rough surface from a few lookups of prefiltered radiance, in place of the one
// lookup of the split sum. Include brdf.glsl and kulla_conty.glsl before this file.
//
// In: a table by `kiln tables --table lobes`, nine harmonics of the radiance, and the levels of a
// prefiltered environment. Out: the radiance by which the split sum's F0 A + B is multiplied. The
// lobe of GGX, which is long and cut off by the horizon, is replaced by one to three round lobes of
// the environment's levels, called taps. What the taps lack in degrees 0 to 2 of spherical harmonics
// is added from the nine harmonics. docs/theory/lobes.md derives the table. The functions use only
// their arguments:
//
//     Lobes lobes = lobes_at(table, layout_, 2, nov, roughness);
//     vec3 t = lobe_tangent(n, v, nov), sum = vec3(0.0), lowest = vec3(1e30);
//     for (int k = 0; k < 2; k++) {
//         vec3 d = lobe_direction(n, t, nov, lobes.tap[k].x);
//         vec3 c = textureLod(levels, d, lobes.tap[k].y).rgb;
//         sum += lobes.tap[k].z * c;
//         lowest = min(lowest, c);
//     }
//     vec3 specular = (f0 * A + B) * lobes_sum(sum, lobes_rest(harmonics, n, t, lobes.rest), lowest,
//                                             lobes.rest[5]);
//
// SPDX-License-Identifier: MIT

// Smallest part of the darkest tap, times the weights' sum, that lobes_sum returns.
const float LOBES_LEAST = 0.6;

// What a table holds for one n.v and one roughness.
struct Lobes
{
    vec4 tap[3];   // x: angle in radians from the mirror direction towards the normal; y: mip level
                   // with its fraction; z: weight; w: one of the numbers that `rest` holds
    float rest[6]; // factors of the harmonics: c10, c11, c20, c21, c22, and c00, which is 1 minus all
                   // weights
};

// Reads a table of `count` taps, 1 to 3, by linear interpolation between the four nearest texels.
// The texture has count + 1 slices one above the other. layout_ is table_place's.
Lobes lobes_at(sampler2D table, vec4 layout_, int count, float nov, float roughness)
{
    ivec2 size = textureSize(table, 0);
    size.y /= count + 1;
    vec2 at = table_place(layout_, size, nov, roughness);
    ivec2 a = ivec2(at), b = min(a + 1, size - 1);
    vec2 t = at - vec2(a);
    Lobes lobes;
    lobes.rest[5] = 1.0;
    for (int k = 0; k <= count; k++) {
        int row = k * size.y;
        vec4 low = mix(texelFetch(table, ivec2(a.x, a.y + row), 0),
                       texelFetch(table, ivec2(b.x, a.y + row), 0), t.x);
        vec4 high = mix(texelFetch(table, ivec2(a.x, b.y + row), 0),
                        texelFetch(table, ivec2(b.x, b.y + row), 0), t.x);
        vec4 value = mix(low, high, t.y);
        if (k < count) {
            lobes.tap[k] = value;
            lobes.rest[k] = value.w;
            lobes.rest[5] -= value.z;
        } else {
            for (int i = 0; i < 4 && count + i < 5; i++)
                lobes.rest[count + i] = value[i];
        }
    }
    return lobes;
}

// The unit tangent of the surface in the plane of incidence, on the side of the mirror direction.
// Where v is the normal, any tangent.
vec3 lobe_tangent(vec3 n, vec3 v, float nov)
{
    vec3 t = nov * n - v;
    float size2 = dot(t, t);
    vec3 other = abs(n.y) < 0.9 ? vec3(n.z, 0.0, -n.x) : vec3(0.0, n.z, -n.y);
    return size2 > 1e-12 ? t * inversesqrt(size2) : normalize(other);
}

// The direction of a tap, which leans by `lean` radians from the mirror direction towards the
// normal n. t is lobe_tangent's.
vec3 lobe_direction(vec3 n, vec3 t, float nov, float lean)
{
    float sine = sqrt((1.0 - nov) * (1.0 + nov)), c = cos(lean), s = sin(lean);
    return (nov * c + sine * s) * n + (sine * c - nov * s) * t;
}

// What the taps lack in degrees 0 to 2. c has the nine coefficients of the radiance in kiln's order
// and sign (docs/conventions.md). With L00, e and M such that degrees 0 to 2 of the radiance from
// direction d are L00 + e.d + d'M d, and with b = n x t:
//     c00 L00 + c10 n.e + c11 t.e + c20 n'M n + c21 n'M t + c22 (t'M t - b'M b)
// The trace of M is 0, so t'M t - b'M b = 2 t'M t + n'M n.
vec3 lobes_rest(vec3 c[9], vec3 n, vec3 t, float rest[6])
{
    vec3 first = rest[0] * n + rest[1] * t;
    vec3 u = (rest[2] + rest[4]) * n + rest[3] * t, w = 2.0 * rest[4] * t;
    // Products of n'M u + t'M w: diagonal elements, and the sums of the elements xy, yz and xz.
    vec3 same = n * u + t * w;
    vec3 other = n.xyx * u.yzz + n.yzz * u.xyx + t.xyx * w.yzz + t.yzz * w.xyx;
    return 0.28209479 * rest[5] * c[0] +
           0.48860251 * (c[1] * first.y + c[2] * first.z + c[3] * first.x) +
           0.54627422 * (c[4] * other.x + c[5] * other.y + c[7] * other.z +
                         c[8] * (same.x - same.y)) +
           0.31539157 * c[6] * (2.0 * same.z - same.x - same.y);
}

// The radiance of all taps, each times its weight, and of `rest`, which is lobes_rest's. The sum can
// be negative beside bright light. It is therefore kept above a part of what the darkest tap,
// `lowest`, would give alone with the weights of all. `lacking` is 1 minus all weights, Lobes.rest[5].
vec3 lobes_sum(vec3 taps, vec3 rest, vec3 lowest, float lacking)
{
    return max(taps + rest, LOBES_LEAST * clamp(1.0 - lacking, 0.0, 1.0) * lowest);
}

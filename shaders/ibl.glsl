// Shading by a baked environment: irradiance from spherical harmonics, the mip level for a
// roughness, and occlusion. The functions use only their arguments.
// SPDX-License-Identifier: MIT

// Irradiance over pi in the direction n. c has the nine coefficients of the radiance in real
// spherical harmonics of degree 0 to 2, in kiln's order and sign (docs/conventions.md). The cosine
// lobe multiplies degree 0 by 1, degree 1 by 2/3 and degree 2 by 1/4.
vec3 sh_irradiance(vec3 c[9], vec3 n)
{
    return 0.28209479 * c[0] +
           0.48860251 * (2.0 / 3.0) * (c[1] * n.y + c[2] * n.z + c[3] * n.x) +
           0.25 * (1.09254843 * (c[4] * (n.x * n.y) + c[5] * (n.y * n.z) + c[7] * (n.x * n.z)) +
                   0.31539157 * c[6] * (3.0 * n.z * n.z - 1.0) +
                   0.54627422 * c[8] * (n.x * n.x - n.y * n.y));
}

// The fractional mip level whose roughness is `roughness`. of_level has the roughness of each of
// `count` levels, increasing from 0, packed four to a vec4.
float environment_level(vec4 of_level[4], int count, float roughness)
{
    float level = 0.0;
    for (int i = 1; i < count; i++) {
        float low = of_level[(i - 1) / 4][(i - 1) % 4], high = of_level[i / 4][i % 4];
        level += clamp((roughness - low) / max(high - low, 1e-6), 0.0, 1.0);
    }
    return level;
}

// The direction, not normalised, in which a rough surface looks up prefiltered radiance. The
// specular lobe of a rough surface leans from the mirror direction r towards the normal n (Lagarde
// and de Rousiers 2014, section 4.9.3).
vec3 bent_reflection(vec3 n, vec3 r, float roughness)
{
    float alpha = roughness * roughness;
    return mix(n, r, (1.0 - alpha) * (sqrt(1.0 - alpha) + alpha));
}

// The share of diffuse light that reaches a surface point with the normal n past a ball of radius
// r, whose centre is at `offset` from the point: 1 minus the ball's form factor. Exact for a ball
// above the horizon.
float ball_occlusion(vec3 n, vec3 offset, float r)
{
    float d2 = dot(offset, offset);
    return 1.0 - clamp(dot(n, offset), 0.0, sqrt(d2)) * r * r / (d2 * sqrt(d2));
}

// The share of specular light that reaches a surface point, from the share `ambient` of diffuse
// light that does (ball_occlusion): Lagarde and de Rousiers 2014, section 4.10.2.
float specular_occlusion(float nov, float ambient, float roughness)
{
    float alpha = roughness * roughness;
    return clamp(pow(nov + ambient, exp2(-16.0 * alpha - 1.0)) - 1.0 + ambient, 0.0, 1.0);
}

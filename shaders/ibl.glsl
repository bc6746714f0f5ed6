// Shading by a baked environment. Needs brdf.glsl and kulla_conty.glsl.
// SPDX-License-Identifier: MIT

// The irradiance divided by pi in direction n from the first three bands of the radiance's real
// harmonics, in kiln's order and sign (docs/conventions.md): each band times the cosine lobe's 1,
// 2/3, 1/4. As kiln_sh_evaluate of the irradiance, divided by pi.
vec3 sh_irradiance(vec3 c[9], vec3 n)
{
    return 0.28209479 * c[0] +
           0.48860251 * (2.0 / 3.0) * (c[1] * n.y + c[2] * n.z + c[3] * n.x) +
           0.25 * (1.09254843 * (c[4] * (n.x * n.y) + c[5] * (n.y * n.z) + c[7] * (n.x * n.z)) +
                   0.31539157 * c[6] * (3.0 * n.z * n.z - 1.0) +
                   0.54627422 * c[8] * (n.x * n.x - n.y * n.y));
}

// The level of a chain at which the environment is filtered for this roughness; the levels'
// roughness rises from 0 and stands in four vec4.
float environment_level(vec4 of_level[4], int count, float roughness)
{
    float level = 0.0;
    for (int i = 1; i < count; i++) {
        float low = of_level[(i - 1) / 4][(i - 1) % 4], high = of_level[i / 4][i % 4];
        level += clamp((roughness - low) / max(high - low, 1e-6), 0.0, 1.0);
    }
    return level;
}

// Where a rough surface's lobe leans to, between the mirror direction r and the normal: Lagarde and de
// Rousiers 2014, section 4.9.3. Not normalised.
vec3 bent_reflection(vec3 n, vec3 r, float roughness)
{
    float alpha = roughness * roughness;
    return mix(n, r, (1.0 - alpha) * (sqrt(1.0 - alpha) + alpha));
}

// How much of the sky a ball of radius r at `offset` from the point leaves, seen from a surface with
// normal n: one minus the form factor, exact while the ball is above the horizon.
float ball_occlusion(vec3 n, vec3 offset, float r)
{
    float d2 = dot(offset, offset);
    return 1.0 - clamp(dot(n, offset), 0.0, sqrt(d2)) * r * r / (d2 * sqrt(d2));
}

// The same for a lobe about the reflection: Lagarde and de Rousiers 2014, section 4.10.2.
float specular_occlusion(float nov, float ambient, float roughness)
{
    float alpha = roughness * roughness;
    return clamp(pow(nov + ambient, exp2(-16.0 * alpha - 1.0)) - 1.0 + ambient, 0.0, 1.0);
}

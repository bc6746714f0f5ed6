// Tone curves and encoding: functions from linear radiance to the values that a screen takes.
// SPDX-License-Identifier: MIT

// The tone curve of the GAMES202 assignment: c / (c + 1), raised to the power 1 / 2.2.
vec3 tone_assignment(vec3 c)
{
    return pow(c / (c + 1.0), vec3(1.0 / 2.2));
}

// A tone curve that leaves colours unchanged whose brightest channel is at most 0.8. It maps a
// brightest channel c above 0.8 to 1 - 0.04 / (c - 0.6), whose slope at 0.8 is 1, and blends the
// colour towards white. The curve is Khronos's PBR Neutral (2024) without that curve's offset for
// Fresnel reflection.
vec3 tone_neutral(vec3 c)
{
    float peak = max(c.r, max(c.g, c.b));
    if (peak <= 0.8)
        return c;
    float over = peak - 0.8, less = over * over / (peak - 0.6); // less = peak - bent
    float bent = peak - less, white = 0.15 * less / (0.15 * less + 1.0);
    return mix(c * (bent / peak), vec3(bent), white);
}

// Encodes linear values in [0, 1] as sRGB (IEC 61966-2-1).
vec3 srgb_encode(vec3 c)
{
    vec3 low = 12.92 * c, high = 1.055 * pow(max(c, 0.0031308), vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, vec3(lessThanEqual(c, vec3(0.0031308))));
}

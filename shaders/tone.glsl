// From radiance to what a screen shows.
// SPDX-License-Identifier: MIT

// The assignment's: c / (c + 1), then the power 1 / 2.2.
vec3 tone_assignment(vec3 c)
{
    return pow(c / (c + 1.0), vec3(1.0 / 2.2));
}

// Keeps colours as they are up to 0.8 and bends what is brighter towards white, the brightest channel
// by 1 - 0.04 / (c - 0.6), whose slope is 1 at 0.8. After Khronos's PBR Neutral (2024), without its
// offset for Fresnel.
vec3 tone_neutral(vec3 c)
{
    float peak = max(c.r, max(c.g, c.b));
    if (peak <= 0.8)
        return c;
    float over = peak - 0.8, less = over * over / (peak - 0.6); // peak - bent
    float bent = peak - less, white = 0.15 * less / (0.15 * less + 1.0);
    return mix(c * (bent / peak), vec3(bent), white);
}

// IEC 61966-2-1.
vec3 srgb_encode(vec3 c)
{
    vec3 low = 12.92 * c, high = 1.055 * pow(max(c, 0.0031308), vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, vec3(lessThanEqual(c, vec3(0.0031308))));
}

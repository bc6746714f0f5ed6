// Microfacet reflection as functions of plain numbers, GLSL ES 3.00. Each function has the name,
// without prefix, and the arguments of a C function in kiln's src/brdf/, and agrees with it to a
// relative 1e-5. nov, nol, noh and voh are the cosines n.v, n.l, n.h and v.h of the normal n, the
// view v, the light l and the half vector h, each in [0, 1]. roughness is the perceptual roughness,
// and alpha = roughness^2.
// SPDX-License-Identifier: MIT

const float PI = 3.14159265358979;

// Names of the masking function G. The values are those of kiln's enum kiln_g.
const int SMITH = 0;             // Smith, of correlated heights
const int SMITH_UNCORRELATED = 1;
const int SCHLICK_K2 = 2;        // Schlick with k = roughness^2 / 2
const int SCHLICK_TEXT = 3;      // Schlick with k = (roughness + 1)^2 / 8

// ------------------------------------------------------------------------------------ distribution

// The GGX distribution D of microfacet normals, per steradian (Walter et al. 2007, eq. 33). d is
// the denominator's (n.h)^2 (alpha^2 - 1) + 1, written as a sum of positive terms, because the
// difference cancels near n.h = 1.
float ggx_d(float alpha, float noh)
{
    float a2 = alpha * alpha;
    float d = a2 * noh * noh + (1.0 - noh) * (1.0 + noh);
    return a2 / (PI * d * d);
}

// ----------------------------------------------------------------------------- masking, shadowing

// Schlick's masking G1 of one direction, whose cosine nox is n.v or n.l.
float smith_g1_schlick(float k, float nox)
{
    return nox / (nox * (1.0 - k) + k);
}

// Schlick's masking G of view and light: the product of G1(nov) and G1(nol).
float smith_g_schlick(float k, float nov, float nol)
{
    return smith_g1_schlick(k, nov) * smith_g1_schlick(k, nol);
}

// Schlick's k for image-based light, alpha / 2 (Karis 2013).
float schlick_k_ibl(float alpha)
{
    return alpha / 2.0;
}

// Schlick's k for point lights, (roughness + 1)^2 / 8 (Karis 2013).
float schlick_k_direct(float roughness)
{
    return (roughness + 1.0) * (roughness + 1.0) / 8.0;
}

// x (1 + 2 Lambda(x)) for GGX and a direction of cosine x, with Smith's Lambda (Heitz 2014, eq.
// 72).
float ggx_root(float alpha, float x)
{
    return sqrt(x * x + alpha * alpha * ((1.0 - x) * (1.0 + x)));
}

// Smith's masking G1 for GGX of one direction over its cosine nox (n.v or n.l). The quotient is
// finite at nox = 0.
float smith_g1_over_cosine(float alpha, float nox)
{
    return 2.0 / (nox + ggx_root(alpha, nox));
}

// The masking G over nov nol, which is finite at grazing angles. g is one of the names of G: SMITH
// and the following constants. The specular BRDF is F D visibility / 4.
float visibility(int g, float roughness, float nov, float nol)
{
    float alpha = roughness * roughness;
    if (g == SMITH)
        return 2.0 / (nol * ggx_root(alpha, nov) + nov * ggx_root(alpha, nol));
    if (g == SMITH_UNCORRELATED)
        return smith_g1_over_cosine(alpha, nov) * smith_g1_over_cosine(alpha, nol);
    float k = g == SCHLICK_TEXT ? schlick_k_direct(roughness) : schlick_k_ibl(alpha);
    return 1.0 / ((nov * (1.0 - k) + k) * (nol * (1.0 - k) + k));
}

// ----------------------------------------------------------------------------------------- Fresnel

// (1 - voh)^5, the factor of Schlick's Fresnel term F = f0 + (1 - f0) (1 - voh)^5 that depends on
// the angle.
float schlick_fresnel(float voh)
{
    float c = 1.0 - voh, c2 = c * c;
    return c2 * c2 * c;
}

// The coefficient `edge` of a metal's Fresnel term F = f0 + (1 - f0) (1 - voh)^5 - edge voh (1 -
// voh)^6 (Lazanyi and Szirmay-Kalos 2005), such that F is f82 at voh = 1 / 7, an angle of 82
// degrees (Kutz et al. 2021).
vec3 f82_edge(vec3 f0, vec3 f82)
{
    const float edge = 6.0 / 7.0, power = edge * edge * edge * edge * edge;
    return (f0 + (1.0 - f0) * power - f82) * (7.0 / (power * edge));
}

// The Fresnel term of a metal with reflectance f0 at normal incidence and f82 at 82 degrees.
vec3 fresnel_f82(vec3 f0, vec3 f82, float voh)
{
    float power = schlick_fresnel(voh);
    vec3 f = f0 + (1.0 - f0) * power - f82_edge(f0, f82) * (voh * power * (1.0 - voh));
    return clamp(f, 0.0, 1.0);
}

// The exact Fresnel reflectance of a dielectric for unpolarised light. ior is n_transmitted /
// n_incident, and c the cosine of the angle of incidence. Born and Wolf 1999, section 1.5.2.
float fresnel_dielectric(float ior, float c)
{
    float contrast = (1.0 - ior) * (1.0 + ior), s2 = (1.0 - c) * (1.0 + c);
    float g2 = c * c - contrast;
    if (g2 <= 0.0)
        return contrast > 0.0 ? 1.0 : 0.0;
    float g = sqrt(g2), r = contrast / ((c + g) * (c + g)), p = (c * g - s2) / (c * g + s2);
    return min(r * r * (1.0 + p * p) / 2.0, 1.0);
}

// Approximates the average 2 int F(mu) mu dmu of a conductor with reflectivity r and edge tint g,
// by the polynomial of Kulla and Conty 2017, page 26. The error is up to 0.10.
vec3 fresnel_conductor_average_fit(vec3 r, vec3 g)
{
    vec3 r2 = r * r, g2 = g * g;
    return 0.087237 + 0.0230685 * g - 0.0864902 * g2 + 0.0774594 * (g2 * g) + 0.782654 * r -
           0.136432 * r2 + 0.278708 * (r2 * r) + 0.19744 * (r * g) + 0.0360605 * (g2 * r) -
           0.2586 * (g * r2);
}

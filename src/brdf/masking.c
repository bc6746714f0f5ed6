// The distribution D and the masking G that a kiln_model names. ki_visibility returns G / (n.v n.l)
// instead of G, which stays finite at grazing angles.
#include "brdf/beckmann.h"
#include "brdf/brdf.h"

#include "brdf/arguments.h"
#include "math/math.h"

#include <math.h>

double ki_brdf_d(kiln_d d, double roughness, double noh)
{
    double alpha = roughness * roughness;
    if (d == KILN_D_GGX)
        return ki_ggx_d(alpha, noh);
    if (!(alpha > 0))
        return noh < 1 ? 0 : HUGE_VAL;
    // At smaller cosines the denominator of D, which contains cos^4, underflows. D is 0 there,
    // since its exponential underflows at far larger cosines already.
    return noh > 1e-70 ? ki_beckmann_d(alpha, noh) : 0;
}

// sqrt(x^2 + alpha^2 (1 - x^2)), which is x (1 + 2 Lambda(x)) for GGX and a direction of cosine x.
// Heitz 2014, eq. 72.
static double ggx_root(double alpha, double x)
{
    return sqrt(x * x + alpha * alpha * ((1 - x) * (1 + x)));
}

// x (1 + Lambda(x)) for Beckmann's D and a direction of cosine x. Its limit at x = 0 is alpha / (2
// sqrt pi).
static double beckmann_slope(double alpha, double x)
{
    return x > 1e-100 ? x * (1 + ki_beckmann_lambda(alpha, x)) : alpha / (2 * sqrt(KI_PI));
}

// G / (n.v n.l) of Smith's masking for Beckmann's D. With correlated heights, G = 1 / (1 +
// Lambda(v) + Lambda(l)). Uncorrelated, G is the product of 1 / (1 + Lambda(v)) and 1 / (1 +
// Lambda(l)).
static double beckmann_visibility(kiln_g g, double alpha, double nov, double nol)
{
    double v = beckmann_slope(alpha, nov), l = beckmann_slope(alpha, nol);
    if (g == KILN_G_SMITH_UNCORRELATED)
        return 1 / (v * l);
    return 1 / (nol * v + nov * l - nov * nol);
}

double ki_smith_g1_over_cosine(double alpha, double nox)
{
    return 2 / (nox + ggx_root(alpha, nox));
}

// For Schlick's two maskings, GGX and Beckmann have the same formula. Smith's correlated masking
// for GGX is Heitz 2014, eq. 99.
double ki_visibility(const kiln_model *model, double roughness, double nov, double nol)
{
    double alpha = roughness * roughness;
    double k =
        model->g == KILN_G_SCHLICK_TEXT ? ki_schlick_k_direct(roughness) : ki_schlick_k_ibl(alpha);
    if (model->g == KILN_G_SCHLICK_K2 || model->g == KILN_G_SCHLICK_TEXT)
        return 1 / ((nov * (1 - k) + k) * (nol * (1 - k) + k));
    if (model->d == KILN_D_BECKMANN)
        return beckmann_visibility(model->g, alpha, nov, nol);
    if (model->g == KILN_G_SMITH_UNCORRELATED)
        return ki_smith_g1_over_cosine(alpha, nov) * ki_smith_g1_over_cosine(alpha, nol);
    return 2 / (nol * ggx_root(alpha, nov) + nov * ggx_root(alpha, nol));
}

double ki_masking(const kiln_model *model, double roughness, double nov, double nol)
{
    // At a cosine of 0 a mirror masks nothing (G = 1), and a rough surface masks all light (G = 0).
    // Schlick's k of KILN_G_SCHLICK_TEXT is 1/8 at roughness 0, so that even a mirror has G = 0.
    if (!(nov > 0 && nol > 0))
        return roughness > 0 || model->g == KILN_G_SCHLICK_TEXT ? 0 : 1;
    double g = nov * nol * ki_visibility(model, roughness, nov, nol);
    return g < 1 ? g : 1;
}

double kiln_brdf_d(kiln_d d, double roughness, double noh)
{
    return ki_brdf_d(d, ki_roughness(roughness), ki_unit(noh));
}

double kiln_brdf_g(const kiln_model *model, double roughness, double nov, double nol)
{
    return ki_masking(model, ki_roughness(roughness), ki_cosine(nov), ki_cosine(nol));
}

double kiln_brdf_specular(const kiln_model *model, double roughness, double nov, double nol,
                          double noh)
{
    double r = ki_roughness(roughness), d = ki_brdf_d(model->d, r, ki_unit(noh));
    if (!(d > 0 && d < HUGE_VAL))
        return d;
    return d * ki_visibility(model, r, ki_cosine(nov), ki_cosine(nol)) / 4;
}

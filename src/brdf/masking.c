// D and G by the names of the model. G has the form G / (n.v n.l) too, finite at grazing angles.
#include "brdf/beckmann.h"
#include "brdf/brdf.h"

#include "math/math.h"

#include <math.h>

double ki_brdf_d(kiln_d d, double roughness, double noh)
{
    double alpha = roughness * roughness;
    if (d == KILN_D_GGX)
        return ki_ggx_d(alpha, noh);
    if (!(alpha > 0))
        return noh < 1 ? 0 : HUGE_VAL;
    // Below, cos^4 underflows, and the exponential has long done so.
    return noh > 1e-70 ? ki_beckmann_d(alpha, noh) : 0;
}

// sqrt(x^2 + alpha^2 (1 - x^2)): x (1 + 2 Lambda(x)) of GGX. Heitz 2014, eq. 72.
static double ggx_root(double alpha, double x)
{
    return sqrt(x * x + alpha * alpha * ((1 - x) * (1 + x)));
}

// x (1 + Lambda(x)) of Beckmann, whose limit at x = 0 is alpha / (2 sqrt pi).
static double beckmann_slope(double alpha, double x)
{
    return x > 1e-100 ? x * (1 + ki_beckmann_lambda(alpha, x)) : alpha / (2 * sqrt(KI_PI));
}

// Smith: 1 / (1 + Lambda(v) + Lambda(l)), or the product of 1 / (1 + Lambda).
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

// Heitz 2014, eq. 99, for GGX; Schlick's two for both.
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
    // The limits at 0: the mirror does not shadow, anything rough does wholly.
    if (!(nov > 0 && nol > 0))
        return roughness > 0 || model->g == KILN_G_SCHLICK_TEXT ? 0 : 1;
    double g = nov * nol * ki_visibility(model, roughness, nov, nol);
    return g < 1 ? g : 1;
}

#include "brdf/brdf.h"

#include "math/math.h"

#include <math.h>

double ki_ggx_d(double alpha, double noh)
{
    // d = (n.h)^2 (alpha^2 - 1) + 1 is written as a sum of squares: the difference would cancel
    // near n.h = 1.
    double a2 = alpha * alpha;
    double rest = (1 - noh) * (1 + noh);
    double d = a2 * noh * noh + rest;
    return d > 0 ? a2 / d / d / KI_PI : HUGE_VAL;
}

void ki_ggx_half_vector(double alpha, const double xi[2], double h[3])
{
    // The angle theta of the half vector to the normal has tan^2 theta = alpha^2 x / (1 - x) with x
    // = xi[1].
    double a2 = alpha * alpha, d = (1 - xi[1]) + a2 * xi[1];
    double cos_theta = sqrt((1 - xi[1]) / d), sin_theta = alpha * sqrt(xi[1] / d);
    double sin_phi, cos_phi;
    ki_sincos(2 * KI_PI * xi[0], &sin_phi, &cos_phi);
    h[0] = sin_theta * cos_phi;
    h[1] = sin_theta * sin_phi;
    h[2] = cos_theta;
}

double ki_smith_g1_schlick(double k, double nox)
{
    return nox / (nox * (1 - k) + k);
}

double ki_smith_g_schlick(double k, double nov, double nol)
{
    return ki_smith_g1_schlick(k, nov) * ki_smith_g1_schlick(k, nol);
}

double ki_schlick_k_ibl(double alpha)
{
    return alpha / 2;
}

double ki_schlick_k_direct(double roughness)
{
    return (roughness + 1) * (roughness + 1) / 8;
}

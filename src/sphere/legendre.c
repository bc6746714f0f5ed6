#include "sphere/legendre.h"

#include "math/math.h"
#include "sphere/kernels.h"

#include <math.h>

size_t ki_legendre_row(const ki_legendre *legendre, int m)
{
    size_t row = (size_t)m, length = (size_t)legendre->degree + 1 + KI_LEGENDRE_PADDING;
    return row * length - row * (row - (row > 0)) / 2;
}

void ki_legendre_order(int degree, int m, double *start, double *f, double *scale)
{
    // For order m, P_mm = sqrt((2m+1)!! / (2m)!! / 4 pi) sin^m theta. For l > m,
    // P_l = a_l (x P_{l-1} - P_{l-2} / a_{l-1}) with a_l = sqrt((4 l^2 - 1) / (l^2 - m^2)).
    // With P_l = scale_l q_l and q_l = 2 x q_{l-1} - f_l q_{l-2}, that makes
    // scale_l = a_l scale_{l-1} / 2 and f_l = 4 / a_{l-1}^2.
    if (m > 0)
        *start *= sqrt((2.0 * m + 1) / (2.0 * m));
    else
        *start = sqrt(1 / (4 * KI_PI));
    f[0] = f[1] = 0;
    scale[0] = *start;
    double m2 = (double)m * m;
    for (int i = 1; i < degree + 1 - m + KI_LEGENDRE_PADDING; i++) {
        double l = m + i, k = l - 1;
        f[i] = i > 1 ? 4 * (k * k - m2) / (4 * k * k - 1) : 0;
        scale[i] = scale[i - 1] * 0.5 * sqrt((4 * l * l - 1) / (l * l - m2));
    }
}

bool ki_legendre_create(kiln_context *context, int degree, ki_legendre *legendre)
{
    *legendre = (ki_legendre){.degree = degree};
    size_t count = ki_legendre_row(legendre, degree + 1);
    legendre->f = ki_alloc_raw(context, count, sizeof(double));
    legendre->scale = ki_alloc_raw(context, count, sizeof(double));
    if (!legendre->f || !legendre->scale) {
        ki_legendre_destroy(legendre);
        return false;
    }
    double start = 0;
    for (int m = 0; m <= degree; m++) {
        size_t row = ki_legendre_row(legendre, m);
        ki_legendre_order(degree, m, &start, legendre->f + row, legendre->scale + row);
    }
    return true;
}

void ki_legendre_destroy(ki_legendre *legendre)
{
    ki_free(legendre->f);
    ki_free(legendre->scale);
    *legendre = (ki_legendre){0};
}

// Returns the margin by which m must exceed l sin theta so that |P_lm| is below 1e-13 of its
// largest value. Beyond the turning point m = l sin theta, P_lm decays like an Airy function.
static double order_margin(double l_sin)
{
    return 12 + 9 * ki_pow(l_sin, 1.0 / 3);
}

bool ki_rings_create(kiln_context *context, const double *theta, int pair_count, int degree,
                     ki_rings *rings)
{
    int vectors = (pair_count + 2 * KI_LANES - 1) / (2 * KI_LANES) * 2, lanes = vectors * KI_LANES;
    *rings = (ki_rings){.pair_count = pair_count, .vector_count = vectors, .degree = degree};
    rings->twice_cos = ki_alloc_raw(context, (size_t)lanes, sizeof(double));
    rings->start = ki_alloc_raw(context, (size_t)lanes * (size_t)(degree + 1), sizeof(double));
    rings->first = ki_alloc(context, (size_t)degree + 1, sizeof(int));
    if (!rings->twice_cos || !rings->start || !rings->first) {
        ki_rings_destroy(rings);
        return false;
    }
    for (int k = 0; k < lanes; k++) {
        double sine, cosine, power = 1;
        ki_sincos(theta[k < pair_count ? k : pair_count - 1], &sine, &cosine);
        rings->twice_cos[k] = 2 * cosine;
        double reach = degree * sine + order_margin(degree * sine);
        for (int m = 0; m <= degree; m++) {
            rings->start[(size_t)m * (size_t)lanes + (size_t)k] = power;
            power = power > 1e-280 ? power * sine : 0;
            // Rings lie nearer to the equator from lane to lane. The last lane of a vector
            // therefore has the largest sin theta, and decides whether the vector contributes to
            // order m.
            if (k % KI_LANES == KI_LANES - 1 && m > reach)
                rings->first[m] = k / KI_LANES + 1;
        }
    }
    return true;
}

bool ki_rings_create_grid(kiln_context *context, int degree, ki_ring_excess excess, ki_rings *rings)
{
    *rings = (ki_rings){0};
    int pairs = (degree + degree * (int)excess / 8 + 8 + 31) / 32 * 16;
    double *theta = ki_alloc_raw(context, (size_t)pairs, sizeof *theta);
    if (!theta)
        return false;
    for (int k = 0; k < pairs; k++)
        theta[k] = (k + 0.5) * KI_PI / (2 * pairs);
    bool good = ki_rings_create(context, theta, pairs, degree, rings);
    ki_free(theta);
    return good;
}

void ki_rings_destroy(ki_rings *rings)
{
    ki_free(rings->twice_cos);
    ki_free(rings->start);
    ki_free(rings->first);
    *rings = (ki_rings){0};
}

size_t ki_coefficient_row(int degree, int m)
{
    // Row k holds the coefficients of order k: degree - k + 1 of them, and one of padding if that
    // number is odd. Counts those of the rows before row m.
    size_t row = (size_t)m, length = (size_t)degree + 1;
    size_t full = row * length - row * (row - (row > 0)) / 2;
    size_t odd_rows = length % 2 ? (row + 1) / 2 : row / 2;
    return KI_COMPONENTS * (full + odd_rows);
}

size_t ki_coefficient_count(int degree)
{
    return ki_coefficient_row(degree, degree + 1);
}

#include "sphere/legendre.h"

#include "math/math.h"
#include "sphere/kernels.h"

#include <math.h>

size_t ki_legendre_row(const ki_legendre *legendre, int m)
{
    size_t row = (size_t)m, length = (size_t)legendre->degree + 1 + KI_LEGENDRE_PADDING;
    return row * length - row * (row - (row > 0)) / 2;
}

// Returns the coefficient f_lm of the recurrence. It is 0 for l = m + 1.
static double recurrence(int l, int m)
{
    double k = l - 1;
    return 4 * (k * k - (double)m * m) / (4 * k * k - 1);
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
        double l = m + i;
        f[i] = i > 1 ? recurrence(m + i, m) : 0;
        scale[i] = scale[i - 1] * 0.5 * sqrt((4 * l * l - 1) / (l * l - m2));
    }
}

void ki_legendre_steps(int degree, int m, const double *f, double *steps)
{
    int length = degree + 1 - m + KI_LEGENDRE_PADDING;
    for (int i = 0; i < length; i++)
        steps[i] = i % 2 ? f[i - 1] * f[i] : i + 2 < length ? f[i + 1] + f[i + 2] : 0;
}

bool ki_legendre_create(kiln_context *context, int degree, ki_legendre *legendre)
{
    *legendre = (ki_legendre){.degree = degree};
    size_t count = ki_legendre_row(legendre, degree + 1);
    double *f = ki_alloc_raw(context, (size_t)degree + 1 + KI_LEGENDRE_PADDING, sizeof *f);
    legendre->steps = ki_alloc_raw(context, count, sizeof(double));
    legendre->scale = ki_alloc_raw(context, count, sizeof(double));
    if (!f || !legendre->steps || !legendre->scale) {
        ki_free(f);
        ki_legendre_destroy(legendre);
        return false;
    }
    double start = 0;
    for (int m = 0; m <= degree; m++) {
        size_t row = ki_legendre_row(legendre, m);
        ki_legendre_order(degree, m, &start, f, legendre->scale + row);
        ki_legendre_steps(degree, m, f, legendre->steps + row);
    }
    ki_free(f);
    return true;
}

void ki_legendre_destroy(ki_legendre *legendre)
{
    ki_free(legendre->steps);
    ki_free(legendre->scale);
    *legendre = (ki_legendre){0};
}

// From the highest degree down, b_l q_l = 2 x b_l q_{l-1} - f_l b_l q_{l-2}: the first term is one of
// the sum that is wanted, the second changes the coefficient of the degree l - 2.
void ki_legendre_join_odd(int degree, int m, double *row)
{
    for (int l = m + (degree - m + 1) / 2 * 2 - 1; l > m + 2; l -= 2) {
        double *at = row + KI_COMPONENTS * (size_t)(l - m), f = recurrence(l, m);
        for (int c = 0; c < KI_COMPONENTS; c++)
            at[c - 2 * KI_COMPONENTS] -= f * at[c];
    }
}

void ki_legendre_part_odd(int degree, int m, double *row)
{
    for (int l = m + 3; l <= degree; l += 2) {
        double *at = row + KI_COMPONENTS * (size_t)(l - m), f = recurrence(l, m);
        for (int c = 0; c < KI_COMPONENTS; c++)
            at[c] -= f * at[c - 2 * KI_COMPONENTS];
    }
}

// Returns an l sin theta below which |P_lm| is certain to be less than 1e-13 of its largest value, and
// is less than 1e-16 up to degree 412. Beyond the turning point, where l sin theta is less than m,
// P_lm decays like an Airy function. It is negligible where m > t + 12 + 9 t^(1/3) with t = l sin
// theta. The root of this cubic equation for t^(1/3) is Cardano's.
static double order_begin(int m)
{
    if (m <= 12)
        return 0;
    double half = (m - 12) / 2.0, w = ki_pow(half + sqrt(half * half + 27), 1.0 / 3);
    double root = w - 3 / w;
    return root * root * root;
}

// Finds which functions of order m are negligible on vectors of rings. `sines` holds the largest
// sin theta of each vector.
static void find_skips(ki_rings *rings, int m, const double *sines)
{
    double begin = order_begin(m);
    int *skip = rings->skip + (size_t)m * (size_t)rings->vector_count;
    for (int g = 0; g < rings->vector_count; g++) {
        if (begin > rings->degree * sines[g])
            rings->first[m] = g + 1;
        // The degree from which on the functions count. sin theta may be 0, at a pole.
        double degree = begin > 0 ? fmin(begin / sines[g], rings->degree) : 0;
        skip[g] = degree > m ? ((int)degree - m) / 4 * 2 : 0;
    }
}

bool ki_rings_create(kiln_context *context, const double *theta, int pair_count, int degree,
                     ki_rings *rings)
{
    int vectors = (pair_count + 2 * KI_LANES - 1) / (2 * KI_LANES) * 2, lanes = vectors * KI_LANES;
    *rings = (ki_rings){.pair_count = pair_count, .vector_count = vectors, .degree = degree};
    rings->twice_cos = ki_alloc_raw(context, (size_t)lanes, sizeof(double));
    rings->start = ki_alloc_raw(context, (size_t)lanes * (size_t)(degree + 1), sizeof(double));
    rings->first = ki_alloc(context, (size_t)degree + 1, sizeof(int));
    rings->skip = ki_alloc_raw(context, (size_t)vectors * (size_t)(degree + 1), sizeof(int));
    double *sines = ki_alloc_raw(context, (size_t)vectors, sizeof *sines);
    if (!rings->twice_cos || !rings->start || !rings->first || !rings->skip || !sines) {
        ki_free(sines);
        ki_rings_destroy(rings);
        return false;
    }
    for (int k = 0; k < lanes; k++) {
        double sine, cosine, power = 1;
        ki_sincos(theta[k < pair_count ? k : pair_count - 1], &sine, &cosine);
        rings->twice_cos[k] = 2 * cosine;
        // Rings lie nearer to the equator from lane to lane. The last lane of a vector therefore has
        // the largest sin theta, and decides which functions are negligible on all its rings.
        if (k % KI_LANES == KI_LANES - 1)
            sines[k / KI_LANES] = sine;
        for (int m = 0; m <= degree; m++) {
            rings->start[(size_t)m * (size_t)lanes + (size_t)k] = power;
            power = power > 1e-280 ? power * sine : 0;
        }
    }
    for (int m = 0; m <= degree; m++)
        find_skips(rings, m, sines);
    ki_free(sines);
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
    ki_free(rings->skip);
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

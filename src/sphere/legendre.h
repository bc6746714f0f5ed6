// The associated Legendre functions' recurrence, and rings to evaluate it on.
#ifndef KI_LEGENDRE_H
#define KI_LEGENDRE_H

#include "base/base.h"

/// Coefficients of all orders up to a degree. With P_lm orthonormal over the sphere, without the
/// Condon-Shortley sign, P_lm = scale_lm q_lm and
///     q_lm = 2 x q_{l-1,m} - f_lm q_{l-2,m},   q_mm = sin^m theta.
typedef struct ki_legendre {
    int degree;
    double *f, *scale;
} ki_legendre;

bool ki_legendre_create(kiln_context *context, int degree, ki_legendre *legendre);
void ki_legendre_destroy(ki_legendre *legendre);
/// Where order m's row starts in `f` and `scale`; it holds l = m .. degree and some more.
size_t ki_legendre_row(const ki_legendre *legendre, int m);

/// Rings in pairs, mirror images of each other at the equator. Vector g, lane j is pair 8 g + j.
typedef struct ki_rings {
    int pair_count, vector_count, degree;
    double *twice_cos; // of the northern ring, [vector][8]
    double *start;     // sin^m theta, [degree + 1][vector][8]
    int *first;        // [degree + 1], vectors before it hold nothing of that order
} ki_rings;

/// Pairs of rings at the given theta, increasing, at most pi / 2. The last is repeated to make the
/// number of vectors even.
bool ki_rings_create(kiln_context *context, const double *theta, int pair_count, int degree,
                     ki_rings *rings);
/// Rings at equal steps, theta = (k + 1/2) pi / (2 pair_count): half as many again as the degree, so
/// that interpolation between them errs less than the degree does, rounded up to fill the vectors.
bool ki_rings_create_grid(kiln_context *context, int degree, ki_rings *rings);
void ki_rings_destroy(ki_rings *rings);

/// Rows of spherical-harmonic coefficients a_lm by order: row m holds l = m .. degree, six doubles
/// each (re, im of r, g, b), padded to an even number of degrees.
size_t ki_coefficient_row(int degree, int m);
/// Doubles in all rows.
size_t ki_coefficient_count(int degree);

#endif

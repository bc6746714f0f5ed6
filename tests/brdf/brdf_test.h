// Quadrature and random numbers shared by the tests of the reflection model, independent of the
// library's own integrators.
#ifndef KILN_BRDF_TEST_H
#define KILN_BRDF_TEST_H

#include "check.h"

#include "math/math.h"

static const double pi = 3.14159265358979323846;

enum { GAUSS = 24, DISTRIBUTIONS = 2 };

/// The integral of f over [from, to], by `panels` equal panels of 24 Gauss nodes each.
static inline double integrate(double (*f)(void *data, double x), void *data, double from,
                               double to, int panels)
{
    double node[GAUSS], weight[GAUSS], sum = 0, half = (to - from) / panels / 2;
    ki_gauss_legendre(GAUSS, node, weight);
    for (int p = 0; p < panels; p++)
        for (int i = 0; i < GAUSS; i++)
            sum += weight[i] * half * f(data, from + half * (2 * p + 1 + node[i]));
    return sum;
}

/// A random number, uniform in [0, 1), by xorshift64.
static inline double uniform(uint64_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return (double)(*state >> 11) / 9007199254740992.0;
}

#endif

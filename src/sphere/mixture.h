// A zonal kernel that is a weighted sum of GGX lobes, with weights of either sign.
#ifndef KI_MIXTURE_H
#define KI_MIXTURE_H

#include "base/base.h"

#include <string.h>

/// The kernel is tabulated as cubics in x = 1 - cos theta + 2^-20: each octave of x is divided into
/// KI_MIXTURE_STEPS ranges, and each range has a cubic.
enum { KI_MIXTURE_STEPS = 32, KI_MIXTURE_OCTAVES = 21 };
/// KI_MIXTURE_STEP_BITS: number of bits of a range's number within its octave, the first bits of
/// the mantissa of x. KI_MIXTURE_FIRST: exponent of the first octave.
enum { KI_MIXTURE_STEP_BITS = 5, KI_MIXTURE_FIRST = -20 };

/// The weight of a mixture is the sum of weights[i] times the GGX lobe of alphas[i] over its
/// integral integrals[i], and 0 beyond the horizon. The error of the table is below 1e-7.
typedef struct ki_mixture {
    double cubic[KI_MIXTURE_STEPS * KI_MIXTURE_OCTAVES][4];
} ki_mixture;

void ki_mixture_create(ki_mixture *mixture, const double *alphas, const double *weights,
                       const double *integrals, int count);
/// Returns the number of the cubic for `x` = 1 - cos theta + 2^-20, and sets *t to the cubic's
/// argument, 0 to 1. The exponent and the first bits of the mantissa of x choose the cubic; the
/// remaining bits of the mantissa are its argument.
static inline size_t ki_mixture_range(double x, double *t)
{
    const int rest = 52 - KI_MIXTURE_STEP_BITS;
    uint64_t bits, first = (uint64_t)(1023 + KI_MIXTURE_FIRST) << KI_MIXTURE_STEP_BITS;
    memcpy(&bits, &x, sizeof bits);
    *t = (double)(int64_t)(bits & ((UINT64_C(1) << rest) - 1)) * 0x1p-47;
    return (size_t)((bits >> rest) - first);
}
/// Returns the weight of the mixture at the angle theta from its axis; `one_minus_cos` is 1 - cos
/// theta.
double ki_mixture_weight(const ki_mixture *mixture, double one_minus_cos);

#endif

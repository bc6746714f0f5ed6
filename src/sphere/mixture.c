#include "sphere/mixture.h"

_Static_assert(1 << KI_MIXTURE_STEP_BITS == KI_MIXTURE_STEPS, "steps are a mantissa's first bits");
static const double offset = 0x1p-20;

// Returns the weight of a mixture of GGX lobes without its factor cos theta, whose kink at the
// horizon a cubic could not follow.
static double exact(const double *alphas, const double *weights, const double *integrals, int count,
                    double versine)
{
    double sum = 0;
    for (int i = 0; i < count; i++) {
        double a2 = alphas[i] * alphas[i], d = a2 / (a2 + (1 - a2) * 0.5 * versine);
        sum += weights[i] / integrals[i] * d * d;
    }
    return sum;
}

void ki_mixture_create(ki_mixture *mixture, const double *alphas, const double *weights,
                       const double *integrals, int count)
{
    double start = offset;
    for (int i = 0; i < KI_MIXTURE_STEPS * KI_MIXTURE_OCTAVES; i++) {
        if (i > 0 && i % KI_MIXTURE_STEPS == 0)
            start *= 2;
        double f[4], *c = mixture->cubic[i];
        for (int k = 0; k < 4; k++) {
            double part = (i % KI_MIXTURE_STEPS + k / 3.0) / KI_MIXTURE_STEPS;
            f[k] = exact(alphas, weights, integrals, count, start * (1 + part) - offset);
        }
        // Sets c to the coefficients c[0] + c[1] t + c[2] t^2 + c[3] t^3 of the cubic that has the
        // values f at t = 0, 1/3, 2/3 and 1.
        c[0] = f[0];
        c[1] = -5.5 * f[0] + 9 * f[1] - 4.5 * f[2] + f[3];
        c[2] = 9 * f[0] - 22.5 * f[1] + 18 * f[2] - 4.5 * f[3];
        c[3] = -4.5 * f[0] + 13.5 * f[1] - 13.5 * f[2] + 4.5 * f[3];
    }
}

double ki_mixture_weight(const ki_mixture *mixture, double one_minus_cos)
{
    if (!(one_minus_cos < 1))
        return 0;
    double t;
    const double *c =
        mixture->cubic[ki_mixture_range((one_minus_cos > 0 ? one_minus_cos : 0) + offset, &t)];
    return (1 - one_minus_cos) * (c[0] + t * (c[1] + t * (c[2] + t * c[3])));
}

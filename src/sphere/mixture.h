// A zonal kernel made of GGX lobes, some of which may be taken away.
#ifndef KI_MIXTURE_H
#define KI_MIXTURE_H

#include "base/base.h"

/// Ranges of a cubic table over 1 - cos + 2^-20, which goes by octaves.
enum { KI_MIXTURE_STEPS = 32, KI_MIXTURE_OCTAVES = 21 };

/// weight = sum of weights[i] lobe_i / integral_i, 0 beyond the horizon; tabulated to 1e-7.
typedef struct ki_mixture {
    double cubic[KI_MIXTURE_STEPS * KI_MIXTURE_OCTAVES][4];
} ki_mixture;

void ki_mixture_create(ki_mixture *mixture, const double *alphas, const double *weights,
                       const double *integrals, int count);
/// The weight at 1 - cos theta.
double ki_mixture_weight(const ki_mixture *mixture, double one_minus_cos);

#endif

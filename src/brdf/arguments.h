// Clamps arguments of the public functions of the reflection model into their ranges.
#ifndef KI_ARGUMENTS_H
#define KI_ARGUMENTS_H

#include "base/base.h"

static inline double ki_unit(double x)
{
    return ki_clamp(x, 0, 1);
}

// Cosines so small that products of two would underflow are 0.
static inline double ki_cosine(double x)
{
    return x >= 1e-150 ? ki_unit(x) : 0;
}

// So is a roughness whose eighth power would.
static inline double ki_roughness(double x)
{
    return x >= 1e-35 ? ki_unit(x) : 0;
}

static inline double ki_index(double x)
{
    return ki_clamp(x, 0, 1e8);
}

#endif

// Clamps arguments of the public functions of the reflection model into their ranges.
#ifndef KI_ARGUMENTS_H
#define KI_ARGUMENTS_H

#include "base/base.h"

static inline double ki_unit(double x)
{
    return ki_clamp(x, 0, 1);
}

// Clamps a cosine to [0, 1]. Cosines so small that the product of two would underflow become 0.
static inline double ki_cosine(double x)
{
    return x >= 1e-150 ? ki_unit(x) : 0;
}

// Clamps a roughness to [0, 1]. A roughness so small that its eighth power would underflow becomes
// 0.
static inline double ki_roughness(double x)
{
    return x >= 1e-35 ? ki_unit(x) : 0;
}

static inline double ki_index(double x)
{
    return ki_clamp(x, 0, 1e8);
}

#endif

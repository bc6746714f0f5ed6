// Clamps the arguments of public functions of the reflection model into their ranges, so that no
// argument, not even not-a-number, gives an undefined result.
#ifndef KI_ARGUMENTS_H
#define KI_ARGUMENTS_H

#include "base/base.h"

// Clamps a share or a cosine to [0, 1].
static inline double ki_unit(double x)
{
    return ki_clamp(x, 0, 1);
}

// Clamps a cosine to [0, 1]. Cosines below 1e-150 become 0, because the product of two such cosines
// would underflow.
static inline double ki_cosine(double x)
{
    return x >= 1e-150 ? ki_unit(x) : 0;
}

// Clamps a roughness to [0, 1]. A roughness below 1e-35 becomes 0, because its eighth power, alpha
// to the fourth, would underflow.
static inline double ki_roughness(double x)
{
    return x >= 1e-35 ? ki_unit(x) : 0;
}

// Clamps a refractive index or an extinction coefficient to [0, 1e8].
static inline double ki_index(double x)
{
    return ki_clamp(x, 0, 1e8);
}

#endif

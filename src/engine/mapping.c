// The two mappings from levels to roughness that several engines share, and their inverses: levels
// at equal steps of the roughness r, or of r (2 - r).
#include "engine/engine.h"

#include <math.h>

double ki_even_roughness(int level, int level_count, int size)
{
    (void)size;
    return level_count > 1 ? (double)level / (level_count - 1) : 0;
}

double ki_even_level(double roughness, int level_count, int size)
{
    (void)size;
    return (level_count - 1) * roughness;
}

double ki_quadratic_roughness(int level, int level_count, int size)
{
    (void)size;
    return level_count > 1 ? 1 - sqrt(1 - (double)level / (level_count - 1)) : 0;
}

double ki_quadratic_level(double roughness, int level_count, int size)
{
    (void)size;
    double r = fmax(roughness, 0.045);
    return (level_count - 1) * r * (2 - r);
}

// Helpers of the test programs in the folders bake, tune, table and course: a context, reproducible
// random numbers, and directions of panorama texels.
#ifndef KILN_BAKE_TEST_H
#define KILN_BAKE_TEST_H

#include "check.h"

static const double pi = 3.14159265358979323846;

/// Uniform in (0, 1): a linear congruential generator (Knuth's MMIX constants).
static inline double random_number(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return ((double)(*state >> 32) + 0.5) / 4294967296.0;
}

static inline void random_direction(uint64_t *state, double d[3])
{
    double z = 2 * random_number(state) - 1, phi = 2 * pi * random_number(state);
    double s = sqrt(1 - z * z);
    d[0] = s * cos(phi);
    d[1] = z;
    d[2] = s * sin(phi);
}

static inline kiln_context *make_context(int threads)
{
    kiln_error error = {0};
    kiln_context *context = NULL;
    kiln_context_def def = {.thread_count = threads};
    CHECK_OK(kiln_context_create(&def, &context, &error));
    return context;
}

static inline kiln_map make_panorama(kiln_context *context, int size)
{
    kiln_error error = {0};
    kiln_map map;
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_PANORAMA, size, 1, &map, &error));
    return map;
}

/// The texel in column x, row y of a panorama.
static inline float *texel_at(const kiln_map *map, int x, int y)
{
    return map->level[0] + 3 * ((size_t)y * 2 * (size_t)map->size + (size_t)x);
}

/// Unit direction of the point (x, y) of a panorama, in texels; x and y may have fractions.
static inline void panorama_direction(int size, double x, double y, double d[3])
{
    double theta = pi * y / size, phi = pi * x / size - pi;
    d[0] = sin(theta) * sin(phi);
    d[1] = cos(theta);
    d[2] = -sin(theta) * cos(phi);
}

#endif

// Environments and comparisons that several programs use.
#ifndef KILN_SCENES_H
#define KILN_SCENES_H

#include "check.h"
#include "scene.h"

#define SCENE_PI 3.14159265358979323846

static inline kiln_context *scene_context(int threads, enum kiln_cpu cpu)
{
    kiln_context_def def = {.thread_count = threads, .cpu = cpu};
    kiln_context *context;
    kiln_error error;
    CHECK_OK(kiln_context_create(&def, &context, &error));
    return context;
}

static inline kiln_map scene_panorama(kiln_context *context, int size, uint32_t seed)
{
    kiln_map map;
    kiln_error error;
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_PANORAMA, size, 1, &map, &error));
    scene_fill(&map, seed);
    return map;
}

/// Largest |a - b| / (|b| + floor) over a level.
static inline double scene_distance(const kiln_map *a, const kiln_map *b, int level, double base)
{
    double worst = 0;
    for (size_t i = 0; i < 3 * kiln_map_texels(a, level); i++) {
        double x = (double)a->level[level][i], y = (double)b->level[level][i];
        worst = fmax(worst, fabs(x - y) / (fabs(y) + base));
    }
    return worst;
}

typedef struct scene_errors {
    double rms, most; // both relative: to the reference's rms, to each value
} scene_errors;

/// Compares up to `count` random texels of a level with brute force.
static inline scene_errors scene_compare(kiln_context *context, const kiln_map *panorama,
                                         const kiln_map *result, int level, const kiln_lobe *lobe,
                                         double rotation, int count)
{
    size_t texels = kiln_map_texels(result, level);
    count = texels < (size_t)count ? (int)texels : count;
    double(*directions)[3] = malloc((size_t)count * sizeof *directions);
    double(*values)[3] = malloc((size_t)count * sizeof *values);
    size_t *index = malloc((size_t)count * sizeof *index);
    uint32_t seed = 7u + (uint32_t)level;
    for (int i = 0; i < count; i++) {
        index[i] =
            texels == (size_t)count ? (size_t)i : (size_t)(scene_random(&seed) * (double)texels);
        kiln_map_direction(result, level, index[i], directions[i]);
    }
    kiln_error error;
    CHECK_OK(kiln_reference_filter(context, panorama, lobe, rotation,
                                   (const double(*)[3])directions, count, values, &error));
    double square = 0, whole = 0, most = 0;
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) {
            double off = (double)result->level[level][3 * index[i] + (size_t)c] - values[i][c];
            square += off * off;
            whole += values[i][c] * values[i][c];
            most = fmax(most, fabs(off) / values[i][c]);
        }
    free(directions);
    free(values);
    free(index);
    return (scene_errors){sqrt(square / whole), most};
}

#endif

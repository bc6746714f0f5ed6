// Reading of atlases, the flat pictures that hold all levels in an engine's own arrangement. In: an
// atlas and the function by which the engine's shader looks a direction up. Out: a cube whose
// texels are what the shader reads in the directions of their centres.
#include "engine/engine.h"

#include "math/math.h"

#include <math.h>

void ki_atlas_read(const kiln_image *atlas, double x, double y, bool roots, float rgb[3])
{
    double column = ki_clamp(x - 0.5, 0, atlas->width - 1),
           row = ki_clamp(y - 0.5, 0, atlas->height - 1);
    int left = ki_min((int)column, atlas->width - 2), top = ki_min((int)row, atlas->height - 2);
    double s = column - left, t = row - top, sum[3] = {0, 0, 0};
    for (int i = 0; i < 4; i++) {
        const float *texel =
            atlas->pixels +
            (size_t)3 * ((size_t)(top + i / 2) * (size_t)atlas->width + (size_t)(left + i % 2));
        double weight = (i % 2 ? s : 1 - s) * (i / 2 ? t : 1 - t);
        for (int c = 0; c < 3; c++)
            sum[c] += weight * (roots ? sqrt(fmax(0, (double)texel[c])) : (double)texel[c]);
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)(roots ? sum[c] * sum[c] : sum[c]);
}

typedef struct fill_job {
    const kiln_image *atlas;
    ki_atlas_look *look;
    kiln_map *map;
    int level;
} fill_job;

// Task of one thread: fills one row of a level.
static void fill_row(void *data, int row)
{
    const fill_job *job = data;
    int n = kiln_map_level_size(job->map, job->level);
    for (int x = 0; x < n; x++) {
        double direction[3];
        size_t index = (size_t)row * (size_t)n + (size_t)x;
        kiln_map_direction(job->map, job->level, index, direction);
        job->look(job->atlas, job->level, direction, job->map->level[job->level] + 3 * index);
    }
}

kiln_result ki_atlas_fill(kiln_context *context, const ki_recipe *recipe, const kiln_image *atlas,
                          ki_atlas_look *look, kiln_map *map, kiln_error *error)
{
    kiln_result result = ki_map_allocate(context, map, error);
    for (int k = 0; k < map->level_count && result == KILN_OK; k++) {
        fill_job job = {atlas, look, map, k};
        map->roughness[k] = (float)recipe->roughness(k, map->level_count, map->size);
        if (!ki_parallel_steps(context, NULL, 6 * kiln_map_level_size(map, k), fill_row, &job))
            result = ki_fail_cancelled(error, "reading");
    }
    if (result != KILN_OK)
        kiln_map_free(map);
    return result;
}

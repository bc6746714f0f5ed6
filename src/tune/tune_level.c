#include "tune/tune_level.h"

#include "image/light.h"

#include <string.h>

// -------------------------------------------------------------------------------------- the mirror

typedef struct halving {
    const float *from;
    float *to;
    int width;
} halving;

// Task of one thread: computes a row of a level whose texels are the means of 2 x 2 texels of the
// level before.
static void halve_row(void *data, int row)
{
    const halving *h = data;
    size_t width = (size_t)h->width;
    const float *above = h->from + 12 * width * (size_t)row, *below = above + 6 * width;
    float *to = h->to + 3 * width * (size_t)row;
    for (size_t x = 0; x < width; x++)
        for (size_t c = 0; c < 3; c++)
            to[3 * x + c] = 0.25F * ((above[6 * x + c] + above[6 * x + 3 + c]) +
                                     (below[6 * x + c] + below[6 * x + 3 + c]));
}

void ki_make_mirrors(kiln_context *context, const kiln_map *map, kiln_map *mirrors)
{
    memcpy(mirrors->level[0], map->level[0], 3 * kiln_map_texels(map, 0) * sizeof(float));
    for (int k = 1; k < mirrors->level_count; k++) {
        int width, height;
        ki_level_extent(mirrors, k, &width, &height);
        halving h = {mirrors->level[k - 1], mirrors->level[k], width};
        ki_parallel_for(context, height, halve_row, &h);
    }
}

typedef struct adding {
    const float *from;
    float *to;
    int width, ratio; // `ratio` texels of `to` cover the width of one texel of `from`
    float weight;
} adding;

// Task of one thread: adds the unfiltered environment (the mirror), times its weight, to a row of a
// level.
static void add_row(void *data, int row)
{
    const adding *a = data;
    int from_width = a->width / a->ratio;
    const float *from = a->from + 3 * (size_t)from_width * (size_t)(row / a->ratio);
    float *to = a->to + 3 * (size_t)a->width * (size_t)row;
    for (int x = 0; x < a->width; x++)
        for (int c = 0; c < 3; c++)
            to[3 * x + c] += a->weight * from[3 * (x / a->ratio) + c];
}

void ki_add_mirror(kiln_context *context, const kiln_map *mirrors, double weight, kiln_map *map,
                   int level)
{
    int size = kiln_map_level_size(map, level), k = 0, width, height;
    if (weight == 0)
        return;
    while (kiln_map_level_size(mirrors, k) > size)
        k++;
    ki_level_extent(map, level, &width, &height);
    adding a = {mirrors->level[k], map->level[level], width, size / kiln_map_level_size(mirrors, k),
                (float)weight};
    ki_parallel_for(context, height, add_row, &a);
}

// ------------------------------------------------------------------------------------ no negatives

typedef struct clearing {
    float *level;
    int width, size;
    kiln_shape shape;
    // sums of the texels of each row by channel, [row]: before, and after negative texels become 0
    double (*sums)[2][3];
    float scale[3];
} clearing;

// Task of one thread: sets the negative texels of a row to 0, and sums the row's texels before and
// after, weighted by solid angle.
static void clear_row(void *data, int row)
{
    clearing *c = data;
    float *texel = c->level + 3 * (size_t)c->width * (size_t)row;
    for (int x = 0; x < c->width; x++, texel += 3) {
        double weight = ki_texel_weight(c->shape, c->size, row, x);
        for (int k = 0; k < 3; k++) {
            c->sums[row][0][k] += weight * (double)texel[k];
            texel[k] = texel[k] < 0 ? 0 : texel[k];
            c->sums[row][1][k] += weight * (double)texel[k];
        }
    }
}

// Task of one thread: multiplies the texels of a row by c->scale of their channel, which restores
// the mean over the sphere.
static void scale_row(void *data, int row)
{
    const clearing *c = data;
    float *texel = c->level + 3 * (size_t)c->width * (size_t)row;
    for (int i = 0; i < 3 * c->width; i++)
        texel[i] *= c->scale[i % 3];
}

kiln_result ki_clear_negative(kiln_context *context, kiln_map *map, int level, kiln_error *error)
{
    int height;
    clearing c = {
        .level = map->level[level], .size = kiln_map_level_size(map, level), .shape = map->shape};
    ki_level_extent(map, level, &c.width, &height);
    c.sums = ki_alloc(context, (size_t)height, sizeof *c.sums);
    if (!c.sums)
        return ki_fail_memory(context, error, "a level's sums", (size_t)height * sizeof *c.sums);
    ki_parallel_for(context, height, clear_row, &c);
    double sums[2][3] = {{0}};
    for (int row = 0; row < height; row++)
        for (int i = 0; i < 6; i++)
            sums[i / 3][i % 3] += c.sums[row][i / 3][i % 3];
    for (int k = 0; k < 3; k++)
        c.scale[k] = sums[1][k] > 0 && sums[0][k] > 0 ? (float)(sums[0][k] / sums[1][k]) : 1;
    ki_parallel_for(context, height, scale_row, &c);
    ki_free(c.sums);
    return KILN_OK;
}

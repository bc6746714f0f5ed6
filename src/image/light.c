// Counts and removes values below zero, and sums the light of maps. In: maps. Out: the same maps
// without values below zero, and the light that was cut off.
#include "image/light.h"

#include "math/math.h"

#include <math.h>
#include <string.h>

double ki_texel_weight(kiln_shape shape, int size, int row, int x)
{
    double n = size, s = (2 * x + 1) / n - 1, t = (2 * (row % size) + 1) / n - 1;
    if (shape == KILN_SHAPE_CUBE) {
        double square = 1 + s * s + t * t;
        return 1 / (square * sqrt(square));
    }
    if (shape == KILN_SHAPE_PANORAMA)
        return ki_sin((row + 0.5) * KI_PI / n);
    return 1;
}

// Adds the light of texels of equal weight. Eight sums are taken side by side.
static void add_even_light(double weight, const float *rgb, size_t count, double limit,
                           ki_light *light)
{
    enum { LANES = 8 };
    double above[LANES] = {0}, below[LANES] = {0}, over[LANES] = {0};
    for (size_t i = 0; i < count; i += LANES) {
        float values[LANES] = {0};
        memcpy(values, rgb + i, (count - i < LANES ? count - i : LANES) * sizeof *values);
        for (int k = 0; k < LANES; k++) {
            double value = (double)values[k];
            above[k] += value > 0 ? value : 0;
            below[k] -= value < 0 ? value : 0;
            over[k] += value > limit ? value - limit : 0;
        }
    }
    for (int k = 0; k < LANES; k++) {
        light->above_zero += weight * above[k];
        light->below_zero += weight * below[k];
        light->above_limit += weight * over[k];
    }
}

void ki_add_light(kiln_shape shape, int size, int row, int width, const float *rgb, double limit,
                  ki_light *light)
{
    // Only a cube's texels differ in weight within a row.
    for (int x = 0; x < width && shape == KILN_SHAPE_CUBE; x++)
        add_even_light(ki_texel_weight(shape, size, row, x), rgb + 3 * (size_t)x, 3, limit, light);
    if (shape != KILN_SHAPE_CUBE)
        add_even_light(ki_texel_weight(shape, size, row, 0), rgb, 3 * (size_t)width, limit, light);
}

double ki_share_below(const ki_light *light)
{
    return light->above_zero > 0 ? light->below_zero / light->above_zero : light->below_zero > 0;
}

static void add_level(const kiln_map *map, int level, double limit, ki_light *light)
{
    int width, height, size = kiln_map_level_size(map, level);
    ki_level_extent(map, level, &width, &height);
    for (int row = 0; row < height; row++)
        ki_add_light(map->shape, size, row, width,
                     map->level[level] + 3 * (size_t)width * (size_t)row, limit, light);
}

ki_light ki_map_light(const kiln_map *map, double limit)
{
    ki_light light = {0};
    for (int level = 0; level < map->level_count; level++)
        add_level(map, level, limit, &light);
    return light;
}

// ------------------------------------------------------------------------------- values below zero

// Number of strips of rows into which a level is cut, one for each task. The number does not depend
// on the number of threads, so that sums are added in the same order with any number of threads.
enum { STRIPS = 64 };

typedef struct cutting {
    kiln_map *map;
    int level, width, height;
    size_t counts[STRIPS];
    ki_light light[STRIPS];
} cutting;

static int first_row(const cutting *c, int strip)
{
    return (int)((int64_t)c->height * strip / STRIPS);
}

// Task of one thread: counts the values below zero of a strip.
static void count_strip(void *data, int index)
{
    cutting *c = data;
    size_t row_floats = 3 * (size_t)c->width, count = 0;
    const float *rgb = c->map->level[c->level] + row_floats * (size_t)first_row(c, index);
    size_t floats = row_floats * (size_t)(first_row(c, index + 1) - first_row(c, index));
    for (size_t i = 0; i < floats; i++)
        count += rgb[i] < 0;
    c->counts[index] = count;
}

// Task of one thread: sums the light of a strip and sets values below zero to 0.
static void cut_strip(void *data, int index)
{
    cutting *c = data;
    size_t row_floats = 3 * (size_t)c->width;
    c->light[index] = (ki_light){0};
    for (int row = first_row(c, index); row < first_row(c, index + 1); row++) {
        float *rgb = c->map->level[c->level] + row_floats * (size_t)row;
        ki_add_light(c->map->shape, kiln_map_level_size(c->map, c->level), row, c->width, rgb,
                     (double)INFINITY, &c->light[index]);
        for (size_t i = 0; i < row_floats; i++)
            rgb[i] = rgb[i] < 0 ? 0 : rgb[i];
    }
}

// Runs a task, count_strip or cut_strip, for all strips of a level of the map.
static void run(kiln_context *context, ki_task *task, kiln_map *map, int level, cutting *c)
{
    *c = (cutting){.map = map, .level = level};
    ki_level_extent(map, level, &c->width, &c->height);
    ki_parallel_for(context, STRIPS, task, c);
}

void ki_cut_negative(kiln_context *context, kiln_map *map, int first, int count, kiln_cut *cut)
{
    cutting c;
    ki_light light = {0};
    *cut = (kiln_cut){0};
    for (int level = first; level < first + count; level++) {
        run(context, count_strip, map, level, &c);
        cut->value_count += 3 * kiln_map_texels(map, level);
        for (int i = 0; i < STRIPS; i++)
            cut->cut_count += c.counts[i];
    }
    // Summing light takes longer than counting values below zero, so maps without such values skip
    // the sums.
    for (int level = first; level < first + count && cut->cut_count; level++) {
        run(context, cut_strip, map, level, &c);
        for (int i = 0; i < STRIPS; i++) {
            light.above_zero += c.light[i].above_zero;
            light.below_zero += c.light[i].below_zero;
        }
    }
    cut->share = ki_share_below(&light);
}

void kiln_map_cut_negative(kiln_context *context, kiln_map *map, kiln_cut *cut)
{
    kiln_cut unused;
    ki_cut_negative(context, map, 0, map->level_count, cut ? cut : &unused);
}

// Maps and images as the caller sees them.
#include "image/image.h"
#include "math/math.h"

#include <float.h>
#include <math.h>

kiln_result kiln_map_create(kiln_context *context, kiln_shape shape, int size, int level_count,
                            kiln_map *map, kiln_error *error)
{
    if (level_count == 0 && size > 0)
        while (level_count < KILN_MAX_LEVELS && size >> level_count)
            level_count++;
    *map = (kiln_map){.shape = shape, .size = size, .level_count = level_count};
    return ki_map_allocate(context, map, error);
}

void kiln_map_free(kiln_map *map)
{
    if (!map)
        return;
    ki_free(map->owner);
    *map = (kiln_map){0};
}

kiln_result kiln_image_create(kiln_context *context, int width, int height, int channels,
                              kiln_image *image, kiln_error *error)
{
    *image = (kiln_image){.width = width, .height = height, .channels = channels};
    return ki_image_allocate(context, image, error);
}

void kiln_image_free(kiln_image *image)
{
    if (!image)
        return;
    ki_free(image->owner);
    *image = (kiln_image){0};
}

int kiln_map_level_size(const kiln_map *map, int level)
{
    return level < 0 || level >= KILN_MAX_LEVELS
               ? 1
               : ki_max(ki_max(1, map->smallest), map->size >> level);
}

size_t kiln_map_texels(const kiln_map *map, int level)
{
    int width, height;
    ki_level_extent(map, ki_min(ki_max(level, 0), KILN_MAX_LEVELS - 1), &width, &height);
    return (size_t)width * (size_t)height;
}

void kiln_map_direction(const kiln_map *map, int level, size_t index, double direction[3])
{
    level = ki_min(ki_max(level, 0), KILN_MAX_LEVELS - 1);
    int width, height, n = kiln_map_level_size(map, level);
    ki_level_extent(map, level, &width, &height);
    size_t row = index / (size_t)width;
    double u = ((double)(index % (size_t)width) + 0.5) / width;
    double v = ((double)(row % (size_t)n) + 0.5) / n;
    if (map->shape == KILN_SHAPE_PANORAMA) {
        ki_panorama_direction(u, v, direction);
    } else if (map->shape == KILN_SHAPE_OCTAHEDRON) {
        ki_octahedron_direction(u, v, direction);
    } else {
        ki_face_direction((int)(row / (size_t)n), 2 * u - 1, 2 * v - 1, direction);
        double *d = direction, length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (int c = 0; c < 3; c++)
            d[c] /= length;
    }
}

static void swap_texels(float *a, float *b)
{
    for (int c = 0; c < 3; c++) {
        float swap = a[c];
        a[c] = b[c];
        b[c] = swap;
    }
}

void kiln_map_mirror(kiln_map *map)
{
    for (int level = 0; level < map->level_count; level++) {
        int width, height, n = kiln_map_level_size(map, level);
        ki_level_extent(map, level, &width, &height);
        float *texel = map->level[level];
        size_t row = (size_t)width * 3;
        int done = 0;
        if (map->shape == KILN_SHAPE_CUBE) {
            // +X and -X change places, each turned left to right.
            float *other = texel + (size_t)n * row;
            for (int y = 0; y < n; y++)
                for (int x = 0; x < n; x++)
                    swap_texels(texel + (size_t)y * row + (size_t)x * 3,
                                other + (size_t)y * row + (size_t)(n - 1 - x) * 3);
            done = 2 * n;
        }
        for (int y = done; y < height; y++)
            for (int x = 0; x < width / 2; x++)
                swap_texels(texel + (size_t)y * row + (size_t)x * 3,
                            texel + (size_t)y * row + (size_t)(width - 1 - x) * 3);
    }
}

void kiln_map_expose(kiln_map *map, double stops)
{
    if (stops == 0 || !isfinite(stops))
        return;
    // Whole stops are exact; what would overflow becomes the largest float.
    double whole = floor(ki_clamp(stops, -600, 600)), part = ki_clamp(stops - whole, 0, 1);
    double factor = ldexp(ki_exp(part * 0.69314718055994530942), (int)whole);
    for (int level = 0; level < map->level_count; level++) {
        size_t count = kiln_map_texels(map, level) * 3;
        float *value = map->level[level];
        for (size_t i = 0; i < count; i++)
            value[i] =
                (float)ki_clamp((double)value[i] * factor, -(double)FLT_MAX, (double)FLT_MAX);
    }
}

kiln_result kiln_map_convert(kiln_context *context, const kiln_map *source, kiln_shape shape,
                             int size, double rotation, kiln_map *map, kiln_error *error)
{
    kiln_map made = {.shape = shape, .size = size, .level_count = 1};
    kiln_result result = ki_map_check(source, error);
    if (result)
        goto done;
    result = ki_map_allocate(context, &made, error);
    if (result)
        goto done;
    result = ki_map_resample(context, source, rotation, &made, 0, error);
done:
    if (result)
        kiln_map_free(&made);
    *map = made;
    return result;
}

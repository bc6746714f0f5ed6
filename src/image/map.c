// Maps and images. In: shapes, sizes and level counts. Out: allocated texels, the size and
// direction of texels, and maps that are mirrored or exposed in place. The levels of a map lie in
// one block of memory, each aligned to 64 bytes; a level is faces, rows and RGB texels in this
// order.
#include "image/image.h"
#include "math/math.h"

#include <float.h>
#include <math.h>
#include <string.h>

static const char *const shape_names[] = {
    [KILN_SHAPE_PANORAMA] = "panorama",
    [KILN_SHAPE_CUBE] = "cube",
    [KILN_SHAPE_OCTAHEDRON] = "octahedron",
};

static kiln_result check_numbers(const kiln_map *map, kiln_error *error)
{
    if ((int)map->shape < KILN_SHAPE_PANORAMA || map->shape > KILN_SHAPE_OCTAHEDRON)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "shape is %d, it must be %d to %d",
                       (int)map->shape, KILN_SHAPE_PANORAMA, KILN_SHAPE_OCTAHEDRON);
    if (map->size < 1 || map->size > KILN_MAX_SIZE)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s size is %d, it must be 1 to %d",
                       shape_names[map->shape], map->size, KILN_MAX_SIZE);
    if (map->smallest < 0 || map->smallest > map->size)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "smallest is %d, it must be from 0 to the size, which is %d", map->smallest,
                       map->size);
    if (map->level_count < 1 || map->level_count > KILN_MAX_LEVELS)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "level_count is %d, it must be 1 to %d",
                       map->level_count, KILN_MAX_LEVELS);
    return KILN_OK;
}

kiln_result ki_map_check(const kiln_map *map, kiln_error *error)
{
    if (check_numbers(map, error))
        return KILN_ERROR_ARGUMENT;
    for (int k = 0; k < map->level_count; k++)
        if (!map->level[k])
            return ki_fail(error, KILN_ERROR_ARGUMENT,
                           "level %d of the %d levels of the %s is NULL", k, map->level_count,
                           shape_names[map->shape]);
    return KILN_OK;
}

kiln_result ki_map_check_panorama(const kiln_map *panorama, kiln_error *error)
{
    kiln_result result = ki_map_check(panorama, error);
    if (!result && panorama->shape != KILN_SHAPE_PANORAMA)
        result = ki_fail(error, KILN_ERROR_ARGUMENT,
                         "the source is a %s, it must be a panorama (kiln_map_convert makes one)",
                         panorama->shape == KILN_SHAPE_CUBE ? "cube" : "octahedron");
    return result;
}

void ki_level_extent(const kiln_map *map, int level, int *width, int *height)
{
    int n = ki_max(ki_max(1, map->smallest), map->size >> level);
    *width = map->shape == KILN_SHAPE_PANORAMA ? 2 * n : n;
    *height = map->shape == KILN_SHAPE_CUBE ? 6 * n : n;
}

// Sets *count to the number of floats of a level, rounded up so that the next level is aligned to
// 64 bytes. Returns false if the number is too large.
static bool level_floats(const kiln_map *map, int level, size_t *count)
{
    int width, height;
    ki_level_extent(map, level, &width, &height);
    if (!ki_mul_size((size_t)width, (size_t)height, count) || !ki_mul_size(*count, 3, count) ||
        *count > SIZE_MAX / sizeof(float) - 16)
        return false;
    *count = (*count + 15) & ~(size_t)15;
    return true;
}

kiln_result ki_map_allocate(kiln_context *context, kiln_map *map, kiln_error *error)
{
    memset(map->level, 0, sizeof map->level);
    map->owner = NULL;
    if (check_numbers(map, error)) {
        *map = (kiln_map){0};
        return KILN_ERROR_ARGUMENT;
    }
    size_t offset[KILN_MAX_LEVELS], total = 0;
    bool fits = true;
    for (int k = 0; k < map->level_count; k++) {
        size_t count = 0;
        offset[k] = total;
        fits = fits && level_floats(map, k, &count) && total <= SIZE_MAX / sizeof(float) - count;
        total += count;
    }
    void *memory = NULL;
    kiln_result result =
        ki_alloc_zeroed(context, fits ? total : SIZE_MAX, sizeof(float), "a map", &memory, error);
    if (result != KILN_OK) {
        *map = (kiln_map){0};
        return result;
    }
    for (int k = 0; k < map->level_count; k++)
        map->level[k] = (float *)memory + offset[k];
    map->owner = memory;
    return KILN_OK;
}

kiln_result ki_image_allocate(kiln_context *context, kiln_image *image, kiln_error *error)
{
    // Greatest width and height of a picture in texels: six faces of the largest cube, one below
    // the other.
    enum { LIMIT = 6 * KILN_MAX_SIZE };
    kiln_image made = *image;
    *image = (kiln_image){0};
    if (made.width < 1 || made.width > LIMIT || made.height < 1 || made.height > LIMIT)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "image is %d x %d, each side must be 1 to %d",
                       made.width, made.height, LIMIT);
    if (made.channels < 1 || made.channels > 4)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "image has %d channels, it must be 1 to 4",
                       made.channels);
    size_t count = (size_t)made.channels * sizeof(float);
    if (!ki_mul_size((size_t)made.width, count, &count))
        count = SIZE_MAX;
    kiln_result result =
        ki_alloc_zeroed(context, (size_t)made.height, count, "an image", &made.owner, error);
    if (result != KILN_OK)
        return result;
    made.pixels = made.owner;
    *image = made;
    return KILN_OK;
}

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

void ki_mirror_row(float *rgb, int width)
{
    for (int x = 0; x < width / 2; x++)
        swap_texels(rgb + (size_t)x * 3, rgb + (size_t)(width - 1 - x) * 3);
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
            // The faces +X and -X change places, and each of the two is mirrored left to right.
            float *other = texel + (size_t)n * row;
            for (int y = 0; y < n; y++)
                for (int x = 0; x < n; x++)
                    swap_texels(texel + (size_t)y * row + (size_t)x * 3,
                                other + (size_t)y * row + (size_t)(n - 1 - x) * 3);
            done = 2 * n;
        }
        for (int y = done; y < height; y++)
            ki_mirror_row(texel + (size_t)y * row, width);
    }
}

void ki_expose_values(float *value, size_t count, double stops)
{
    if (stops == 0 || !isfinite(stops))
        return;
    // The whole part of `stops` is applied as an exact power of two. Values that would overflow
    // become the largest float.
    double whole = floor(ki_clamp(stops, -600, 600)), part = ki_clamp(stops - whole, 0, 1);
    double factor = ldexp(ki_exp(part * 0.69314718055994530942), (int)whole);
    for (size_t i = 0; i < count; i++)
        value[i] = (float)ki_clamp((double)value[i] * factor, -(double)FLT_MAX, (double)FLT_MAX);
}

void kiln_map_expose(kiln_map *map, double stops)
{
    for (int level = 0; level < map->level_count; level++)
        ki_expose_values(map->level[level], kiln_map_texels(map, level) * 3, stops);
}

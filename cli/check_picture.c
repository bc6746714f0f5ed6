// The picture of kiln check. In: the differences of levels from the exact levels. Out: a PNG of one
// panorama for each level, one below the other. Grey is no difference, red is too bright, blue is too
// dark, and the full colours stand for three times the root mean square difference of the level.
#include "check.h"

#include <math.h>

enum { ROWS = 128, COLUMNS = 2 * ROWS };

static double rms_of(const kiln_map *map)
{
    double sum = 0;
    size_t count = 3 * kiln_map_texels(map, 0);
    for (size_t i = 0; i < count; i++)
        sum += (double)map->level[0][i] * (double)map->level[0][i];
    return sqrt(sum / (double)count);
}

static void draw(const kiln_map *panorama, float *pixels)
{
    double full = 3 * rms_of(panorama);
    for (size_t i = 0; i < kiln_map_texels(panorama, 0); i++) {
        const float *rgb = panorama->level[0] + 3 * i;
        double d = ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3;
        double t = full > 0 ? fmin(1, fabs(d) / full) : 0;
        double bright = 0.5 + 0.5 * t, dark = 0.5 - 0.5 * t;
        pixels[3 * i + 0] = (float)(d > 0 ? bright : dark);
        pixels[3 * i + 1] = (float)dark;
        pixels[3 * i + 2] = (float)(d > 0 ? dark : bright);
    }
}

kiln_result check_draw(kiln_context *context, const kiln_map *difference, const char *path,
                       kiln_error *error)
{
    kiln_image picture;
    kiln_result result =
        kiln_image_create(context, COLUMNS, ROWS * difference->level_count, 3, &picture, error);
    for (int k = 0; k < difference->level_count && result == KILN_OK; k++) {
        kiln_map panorama = {0};
        const kiln_map level = {.shape = difference->shape,
                                .size = kiln_map_level_size(difference, k),
                                .level_count = 1,
                                .level = {difference->level[k]}};
        result = kiln_map_convert(context, &level, KILN_SHAPE_PANORAMA, ROWS, 0, &panorama, error);
        if (result == KILN_OK)
            draw(&panorama, picture.pixels + (size_t)3 * COLUMNS * ROWS * (size_t)k);
        kiln_map_free(&panorama);
    }
    if (result == KILN_OK)
        result = kiln_image_save(context, &picture, path, error);
    kiln_image_free(&picture);
    return result;
}

// kiln_check_picture. In: the differences of levels from the exact levels. Out: a picture of one
// panorama for each level, one below the other. Grey is no difference, red is too bright, blue is
// too dark, and the full colours stand for three times the root mean square difference of the
// level.
#include "check/check.h"

#include "image/image.h"

#include <math.h>

enum { ROWS = 128, COLUMNS = 2 * ROWS };

// Root mean square over the sphere.
static double rms_of(const kiln_map *map)
{
    double sum = 0, weight = 0;
    for (size_t i = 0; i < kiln_map_texels(map, 0); i++) {
        double w = ki_weight_of(map, i);
        for (size_t c = 0; c < 3; c++) {
            double d = (double)map->level[0][3 * i + c];
            sum += w * d * d;
            weight += w;
        }
    }
    return sqrt(sum / weight);
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

kiln_result kiln_check_picture(kiln_context *context, const kiln_map *difference,
                               kiln_image *picture, kiln_error *error)
{
    *picture = (kiln_image){0};
    kiln_result result = ki_map_check(difference, error);
    if (result == KILN_OK)
        result =
            kiln_image_create(context, COLUMNS, ROWS * difference->level_count, 3, picture, error);
    for (int k = 0; k < difference->level_count && result == KILN_OK; k++) {
        kiln_map panorama = {0};
        const kiln_map level = ki_single_level(difference, k);
        result = kiln_map_convert(context, &level, KILN_SHAPE_PANORAMA, ROWS, 0, &panorama, error);
        if (result == KILN_OK)
            draw(&panorama, picture->pixels + (size_t)3 * COLUMNS * ROWS * (size_t)k);
        kiln_map_free(&panorama);
    }
    if (result != KILN_OK)
        kiln_image_free(picture);
    return result;
}

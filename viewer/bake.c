// Bakes an environment map into the cubes and harmonics that the shaders read.
#include "internal.h"

#include <kiln/course.h>
#include <string.h>

enum { SIZE = 256, SMALLEST = 8, IRRADIANCE_SIZE = 32 };

// Levels are halved while they have SMALLEST texels a side: a level of one texel would describe the
// whole sphere by six values.
static int count_levels(int size)
{
    int count = 1;
    while (size >> count >= SMALLEST && count < KILN_MAX_LEVELS)
        count++;
    return count;
}

static kiln_result copy(kiln_context *context, const kiln_map *from, kiln_map *to,
                        kiln_error *error)
{
    kiln_result result =
        kiln_map_create(context, from->shape, from->size, from->level_count, to, error);
    for (int level = 0; level < from->level_count && result == KILN_OK; level++) {
        memcpy(to->level[level], from->level[level],
               kiln_map_texels(from, level) * 3 * sizeof(float));
        to->roughness[level] = from->roughness[level];
    }
    return result;
}

static kiln_result textbook_levels(kiln_context *context, const kiln_map *source, int size,
                                   int level_count, int samples, kiln_map *levels,
                                   kiln_error *error)
{
    kiln_map panorama = {0};
    kiln_textbook_def def = {.shape = KILN_SHAPE_CUBE,
                             .size = size,
                             .level_count = level_count,
                             .sample_count = samples};
    bool convert = source->shape != KILN_SHAPE_PANORAMA;
    kiln_result result = convert ? kiln_map_convert(context, source, KILN_SHAPE_PANORAMA,
                                                    2 * source->size, 0, &panorama, error)
                                 : KILN_OK;
    if (result == KILN_OK)
        result =
            kiln_textbook_prefilter(context, convert ? &panorama : source, &def, levels, error);
    kiln_map_free(&panorama);
    return result;
}

// Bakes irradiance and harmonics only. kiln_bake makes at least one level, which serves as the
// irradiance: its lobe is the cosine.
static kiln_result bake_diffuse(kiln_context *context, const kiln_map *source,
                                kiln_environment *environment, kiln_error *error)
{
    kiln_bake_def def = {
        .levels = {.size = IRRADIANCE_SIZE, .level_count = 1, .lobe = KILN_LOBE_LAMBERT},
        .irradiance_size = KILN_NO_IRRADIANCE};
    kiln_result result = kiln_bake(context, source, &def, environment, error);
    environment->irradiance = environment->levels;
    environment->levels = (kiln_map){0};
    environment->lobe = KILN_LOBE_GGX;
    return result;
}

kiln_result view_bake(kiln_context *context, const kiln_map *source, int size, int samples,
                      kiln_environment *environment, kiln_error *error)
{
    *environment = (kiln_environment){0};
    size = size ? size : SIZE;
    if (size < 16 || size > 2048)
        return view_fail(error, KILN_ERROR_ARGUMENT,
                         "the size of the environment's cube is %d, it must be from 16 to 2048",
                         size);
    int level_count = count_levels(size);
    bool is_baked = source->shape == KILN_SHAPE_CUBE && source->level_count > 1;
    if (!samples && !is_baked) {
        kiln_bake_def def = {.levels = {.size = size, .level_count = level_count},
                             .irradiance_size = IRRADIANCE_SIZE};
        return kiln_bake(context, source, &def, environment, error);
    }
    kiln_result result = bake_diffuse(context, source, environment, error);
    if (result == KILN_OK)
        result = samples ? textbook_levels(context, source, size, level_count, samples,
                                           &environment->levels, error)
                         : copy(context, source, &environment->levels, error);
    if (result == KILN_OK)
        kiln_map_cut_negative(context, &environment->levels, &environment->levels_cut);
    if (result != KILN_OK)
        kiln_environment_free(environment);
    return result;
}

// The orientation of a file. In: a panorama and a map that shows the panorama under some axes. Out:
// the axes, a signed permutation of x, y and z, and a sentence about them. Method: both are reduced
// to cubes of 16 x 16 texels, which all 48 signed permutations map to themselves, and the axes with
// the largest correlation are taken. Values v count as v / (v + mean), so that a sun does not
// outweigh everything else.
#include "check/check.h"

#include "image/light.h"
#include "image/texel.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { EDGE = 16, TEXELS = 6 * EDGE * EDGE, WAYS = 48 };

const ki_axes ki_axes_none = {{0, 1, 2}, {1, 1, 1}};

void ki_axes_apply(const ki_axes *axes, const double direction[3], double turned[3])
{
    for (int i = 0; i < 3; i++)
        turned[i] = axes->sign[i] * direction[axes->axis[i]];
}

ki_axes ki_axes_inverse(const ki_axes *axes)
{
    ki_axes inverse;
    for (int i = 0; i < 3; i++) {
        inverse.axis[axes->axis[i]] = i;
        inverse.sign[axes->axis[i]] = axes->sign[i];
    }
    return inverse;
}

bool ki_axes_equal(const ki_axes *a, const ki_axes *b)
{
    return !memcmp(a, b, sizeof *a);
}

ki_axes ki_axes_shown(const ki_axes *found, const ki_axes *expected)
{
    ki_axes shown, inverse = ki_axes_inverse(expected);
    for (int i = 0; i < 3; i++) {
        shown.axis[i] = inverse.axis[found->axis[i]];
        shown.sign[i] = found->sign[i] * inverse.sign[found->axis[i]];
    }
    return shown;
}

ki_axes ki_axes_numbered(int index)
{
    static const int orders[6][3] = {{0, 1, 2}, {2, 1, 0}, {1, 0, 2},
                                     {0, 2, 1}, {1, 2, 0}, {2, 0, 1}};
    ki_axes axes;
    for (int i = 0; i < 3; i++) {
        axes.axis[i] = orders[index / 8][i];
        axes.sign[i] = index >> i & 1 ? -1 : 1;
    }
    return axes;
}

kiln_map ki_single_level(const kiln_map *map, int level)
{
    return (kiln_map){.shape = map->shape,
                      .size = kiln_map_level_size(map, level),
                      .level_count = 1,
                      .level = {map->level[level]},
                      .roughness = {map->roughness[level]}};
}

double ki_weight_of(const kiln_map *map, size_t index)
{
    size_t width = (size_t)map->size * (map->shape == KILN_SHAPE_PANORAMA ? 2 : 1);
    return ki_texel_weight(map->shape, map->size, (int)(index / width), (int)(index % width));
}

double ki_map_mean(const kiln_map *map)
{
    double sum = 0, weight = 0;
    for (size_t i = 0; i < kiln_map_texels(map, 0); i++) {
        double w = ki_weight_of(map, i);
        const float *rgb = map->level[0] + 3 * i;
        sum += w * ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3;
        weight += w;
    }
    return sum / weight;
}

// ------------------------------------------------------------------------------------ correlation

// The texels of a small cube as one number each, with the mean 0 and the norm 1.
typedef struct thumbnail {
    double value[TEXELS];
} thumbnail;

static kiln_result make_thumbnail(kiln_context *context, const kiln_map *map, thumbnail *small,
                                  kiln_error *error)
{
    kiln_map cube, level = ki_single_level(map, 0);
    kiln_result result = kiln_map_convert(context, &level, KILN_SHAPE_CUBE, EDGE, 0, &cube, error);
    if (result != KILN_OK)
        return result;
    double mean = fabs(ki_map_mean(&cube)), sum = 0, norm = 0;
    for (int i = 0; i < TEXELS; i++) {
        const float *rgb = cube.level[0] + 3 * (size_t)i;
        double v = fmax(0, ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3);
        small->value[i] = v > 0 ? v / (v + mean) : 0;
        sum += small->value[i];
    }
    for (int i = 0; i < TEXELS; i++) {
        small->value[i] -= sum / TEXELS;
        norm += small->value[i] * small->value[i];
    }
    for (int i = 0; i < TEXELS; i++)
        small->value[i] = norm > 0 ? small->value[i] / sqrt(norm) : 0;
    kiln_map_free(&cube);
    return KILN_OK;
}

static double correlate(const thumbnail *source, const thumbnail *map, const ki_axes *axes)
{
    const kiln_map cube = {.shape = KILN_SHAPE_CUBE, .size = EDGE, .level_count = 1};
    double sum = 0;
    for (int i = 0; i < TEXELS; i++) {
        double at[3], from[3];
        kiln_map_direction(&cube, 0, (size_t)i, at);
        ki_axes_apply(axes, at, from);
        sum += map->value[i] * source->value[ki_texel_of_direction(&cube, from)];
    }
    return sum;
}

static bool is_of_engine(const ki_axes *axes)
{
    const ki_recipe *recipe;
    for (int i = 0; (recipe = ki_recipe_at(i)) != NULL; i++)
        if (ki_axes_equal(axes, &recipe->axes))
            return true;
    return false;
}

kiln_result ki_find_axes(kiln_context *context, const kiln_map *source, const kiln_map *map,
                         const ki_axes *expected, ki_axes *axes, kiln_error *error)
{
    // What the axes of a symmetric environment must surpass expected axes by.
    const double margin = 0.004;
    thumbnail from, to;
    kiln_result result = make_thumbnail(context, source, &from, error);
    if (result == KILN_OK)
        result = make_thumbnail(context, map, &to, error);
    if (result != KILN_OK)
        return result;
    *axes = *expected;
    double best = correlate(&from, &to, expected) + margin;
    for (int i = 0; i < WAYS; i++) {
        ki_axes tried = ki_axes_numbered(i);
        if (map->shape != KILN_SHAPE_CUBE && (tried.axis[1] != 1 || tried.sign[1] < 0))
            continue;
        double like = correlate(&from, &to, &tried) + (is_of_engine(&tried) ? margin / 2 : 0);
        if (like > best) {
            best = like;
            *axes = tried;
        }
    }
    return KILN_OK;
}

// ------------------------------------------------------------------------------------------ words

// Returns the angle about +Y, as for kiln_map_convert, by which a map with these axes is turned
// after it was mirrored if `mirrored`; -1 if no such angle exists.
static int yaw(const ki_axes *axes, bool mirrored)
{
    const double at[3] = {0.2, 0.3, 0.5};
    double wanted[3], turned[3];
    ki_axes_apply(axes, at, wanted);
    for (int degrees = 0; degrees < 360; degrees += 90) {
        ki_turn(at, degrees, turned);
        turned[0] = mirrored ? -turned[0] : turned[0];
        double far = 0;
        for (int i = 0; i < 3; i++)
            far += fabs(turned[i] - wanted[i]);
        if (far < 1e-6)
            return degrees;
    }
    return -1;
}

// Writes how a map with these axes is turned, for example "mirrored (left and right are swapped)".
static void describe(const ki_axes *axes, char text[128])
{
    static const char names[] = "xyz";
    const ki_axes upside_down = {{0, 1, 2}, {1, -1, 1}};
    int turn = yaw(axes, false), mirror = yaw(axes, true);
    if (turn >= 0)
        snprintf(text, 128, "turned by %d degrees about +Y", turn);
    else if (mirror == 0)
        snprintf(text, 128, "mirrored: left and right are swapped");
    else if (mirror > 0)
        snprintf(text, 128,
                 "mirrored (left and right are swapped) and turned by %d degrees about +Y", mirror);
    else if (ki_axes_equal(axes, &upside_down))
        snprintf(text, 128, "upside down: +Y and -Y are swapped");
    else
        snprintf(text, 128,
                 "turned: where the file is read at (x, y, z) it shows (%c%c, %c%c, %c%c)",
                 axes->sign[0] < 0 ? '-' : '+', names[axes->axis[0]], axes->sign[1] < 0 ? '-' : '+',
                 names[axes->axis[1]], axes->sign[2] < 0 ? '-' : '+', names[axes->axis[2]]);
}

// Writes the names of the engines that read cubes under these axes.
static void list_engines(const ki_axes *axes, char text[128])
{
    const ki_recipe *recipe;
    text[0] = 0;
    for (int i = 0; (recipe = ki_recipe_at(i)) != NULL; i++) {
        size_t length = strlen(text);
        if (ki_axes_equal(axes, &recipe->axes))
            snprintf(text + length, 128 - length, "%s%s", length ? ", " : "", recipe->about.name);
    }
}

bool ki_axes_known(const ki_axes *axes)
{
    char engines[128];
    list_engines(axes, engines);
    return engines[0] != 0;
}

void ki_say_axes(const ki_axes *found, const ki_axes *expected, kiln_findings *findings)
{
    char how[128], engines[128];
    if (expected && ki_axes_equal(found, expected))
        return;
    list_engines(found, engines);
    describe(found, how);
    if (expected)
        ki_find(findings, KILN_FINDING_AXES, true, "the environment is %s", how);
    else if (ki_axes_equal(found, &ki_axes_none))
        ki_find(findings, KILN_FINDING_AXES, false, "the axes are those of kiln");
    else if (engines[0])
        ki_find(findings, KILN_FINDING_AXES, false, "the axes are those of %s: %s", engines, how);
    else
        ki_find(findings, KILN_FINDING_AXES, true,
                "the environment is %s, which no engine that kiln knows expects", how);
}

kiln_result ki_map_unturn(kiln_context *context, const kiln_map *map, const ki_axes *axes,
                          kiln_map *turned, kiln_error *error)
{
    *turned = (kiln_map){.shape = map->shape,
                         .size = map->size,
                         .level_count = map->level_count,
                         .smallest = map->smallest};
    kiln_result result = ki_map_allocate(context, turned, error);
    ki_axes back = ki_axes_inverse(axes);
    for (int k = 0; k < map->level_count && result == KILN_OK; k++) {
        kiln_map from = ki_single_level(map, k);
        turned->roughness[k] = map->roughness[k];
        for (size_t i = 0; i < kiln_map_texels(map, k); i++) {
            double at[3], way[3];
            kiln_map_direction(map, k, i, at);
            ki_axes_apply(&back, at, way);
            memcpy(turned->level[k] + 3 * i, from.level[0] + 3 * ki_texel_of_direction(&from, way),
                   3 * sizeof(float));
        }
    }
    return result;
}

kiln_result kiln_levels_unturn(kiln_context *context, const kiln_map *levels, const int axis[3],
                               const int sign[3], kiln_map *map, kiln_error *error)
{
    ki_axes axes;
    int seen = 0;
    *map = (kiln_map){0};
    kiln_result result = ki_map_check(levels, error);
    for (int i = 0; i < 3; i++) {
        axes.axis[i] = axis[i];
        axes.sign[i] = sign[i];
        seen |= axis[i] >= 0 && axis[i] < 3 && (sign[i] == 1 || sign[i] == -1) ? 1 << axis[i] : 0;
    }
    if (result == KILN_OK && seen != 7)
        return ki_fail(
            error, KILN_ERROR_ARGUMENT,
            "the axes are (%d, %d, %d) with the signs (%d, %d, %d), they must be 0, 1 and "
            "2 in any order with signs of 1 or -1",
            axis[0], axis[1], axis[2], sign[0], sign[1], sign[2]);
    if (result == KILN_OK)
        result = ki_map_unturn(context, levels, &axes, map, error);
    if (result != KILN_OK)
        kiln_map_free(map);
    return result;
}

// The public functions for compact lights. In: a map and how many lights are wanted. Out: the
// lights, and the map without them. lights_search.c finds regions, lights_measure.c makes a light
// of each; the functions here choose among them by their share of the map's light.
#include "bake/lights.h"

#include "image/image.h"
#include "image/light.h"
#include "math/math.h"

#include <math.h>
#include <string.h>

// Radiance, as a multiple of the base, at which a map is clamped if the caller names no limit.
static const double clamp_over_base = 32;

kiln_result ki_lights_check(const kiln_lights_def *def, kiln_error *error)
{
    if (def->count < 0 || def->count > KILN_MAX_LIGHTS)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "count of lights is %d, it must be 0 to %d",
                       def->count, KILN_MAX_LIGHTS);
    if (!(def->share >= 0 && def->share <= 1))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "share of lights is %g, it must be 0 to 1",
                       def->share);
    return KILN_OK;
}

// Returns the region with the largest share that was not yet looked at, or NULL.
static ki_region *largest(const ki_search *search, const bool *seen)
{
    ki_region *best = NULL;
    for (int i = 0; i < search->region_count; i++)
        if (!seen[i] && (!best || search->region[i].light.share > best->light.share))
            best = &search->region[i];
    return best;
}

// Adds a region's mismatch to those of the lights chosen before. Returns false, and adds nothing,
// if the sum would be too large.
static bool add_mismatch(const ki_region *region, double sum[KI_SH_COUNT][3])
{
    double next[KI_SH_COUNT][3];
    for (int k = 0; k < KI_SH_COUNT; k++)
        for (int c = 0; c < 3; c++)
            next[k][c] = sum[k][c] + region->mismatch[k][c];
    if (ki_mismatch_size((const double(*)[3])next) > ki_lights_mismatch)
        return false;
    memcpy(sum, next, sizeof next);
    return true;
}

// Finds the normals of nine surfaces whose horizons pass through two lights: through the centres,
// and half a radius above and below. Returns the number of normals, 0 if the lights are too close
// to each other or opposite.
static int find_common_horizons(const kiln_light *one, const kiln_light *other,
                                double normals[9][3])
{
    const double *a = one->direction, *b = other->direction;
    double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    double squares = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    if (squares < 1e-4)
        return 0;
    for (int i = 0; i < 9; i++) {
        // The heights over the horizon are the cosines of the normal with both directions.
        int column = i % 3, row = i / 3;
        double x = (column - 1) * 0.5 * ki_sin(one->angular_radius * (KI_PI / 180));
        double y = (row - 1) * 0.5 * ki_sin(other->angular_radius * (KI_PI / 180));
        double in_a = (x - cosine * y) / squares, in_b = (y - cosine * x) / squares;
        double flat = x * in_a + y * in_b; // squared length of the part in the plane of a and b
        double up = sqrt(fmax(0, 1 - flat) / squares);
        for (int k = 0; k < 3; k++)
            normals[i][k] = in_a * a[k] + in_b * b[k] + up * n[k];
    }
    return 9;
}

// Returns whether the discs of all chosen lights together replace what is taken out, for surfaces
// that have the last of these lights and another one on their horizon. Lights of fewer than
// KI_SHAPED texels are left out.
static bool fits_others(const ki_search *search, const ki_region *const *chosen, int count)
{
    const kiln_light *last = &chosen[count - 1]->light;
    if (chosen[count - 1]->count < KI_SHAPED)
        return true;
    for (int i = 0; i < count - 1; i++) {
        if (chosen[i]->count < KI_SHAPED)
            continue;
        double normals[9][3], errors[9][3] = {{0}};
        int found = find_common_horizons(last, &chosen[i]->light, normals);
        for (int k = 0; k < count && found; k++)
            if (chosen[k]->count >= KI_SHAPED)
                ki_region_add_errors(search, chosen[k], (const double(*)[3])normals, found, errors);
        for (int n = 0; n < found; n++)
            for (int c = 0; c < 3; c++)
                if (fabs(errors[n][c]) > ki_light_error)
                    return false;
    }
    return true;
}

// Chooses the wanted lights, and takes them out of `target` if it is not NULL.
static void choose(ki_search *search, const kiln_lights_def *def, kiln_map *target,
                   kiln_lights *lights)
{
    bool seen[KI_MOST_REGIONS] = {false};
    const ki_region *chosen[KILN_MAX_LIGHTS] = {NULL};
    double sum[KI_SH_COUNT][3] = {{0}};
    int count = def->count ? def->count : def->share != 0 ? KILN_MAX_LIGHTS : 1;
    double share = def->share != 0 ? def->share : 0.01;
    ki_region *region;
    while (lights->count < count && (region = largest(search, seen)) != NULL &&
           region->light.share >= share) {
        seen[region - search->region] = true;
        chosen[lights->count] = region;
        if (!ki_region_is_disc(search, region) || !fits_others(search, chosen, lights->count + 1) ||
            !add_mismatch(region, sum))
            continue;
        lights->light[lights->count++] = region->light;
    }
    for (int i = 0; i < lights->count && target; i++)
        ki_region_measure(search, &search->region[chosen[i] - search->region], target);
}

static kiln_result run(kiln_context *context, const kiln_map *map, const kiln_lights_def *def,
                       kiln_map *target, kiln_lights *lights, kiln_error *error)
{
    static const kiln_lights_def defaults = {0};
    ki_search search = {0};
    def = def ? def : &defaults;
    memset(lights, 0, sizeof *lights);
    kiln_result result = ki_map_check(map, error);
    if (result == KILN_OK)
        result = ki_lights_check(def, error);
    if (result == KILN_OK)
        result = ki_search_run(context, map, &search, error);
    if (result == KILN_OK)
        choose(&search, def, target, lights);
    ki_search_free(&search);
    return result;
}

kiln_result kiln_lights_find(kiln_context *context, const kiln_map *map, const kiln_lights_def *def,
                             kiln_lights *lights, kiln_error *error)
{
    return run(context, map, def, NULL, lights, error);
}

kiln_result kiln_lights_extract(kiln_context *context, kiln_map *map, const kiln_lights_def *def,
                                kiln_lights *lights, kiln_error *error)
{
    return run(context, map, def, map, lights, error);
}

kiln_result kiln_lights_sh(const kiln_lights *lights, int bands, kiln_sh *sh, kiln_error *error)
{
    *sh = (kiln_sh){0};
    if (lights->count < 0 || lights->count > KILN_MAX_LIGHTS)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "count of lights is %d, it must be 0 to %d",
                       lights->count, KILN_MAX_LIGHTS);
    if (bands < 1 || bands > KILN_MAX_BANDS)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "bands is %d, it must be 1 to %d", bands,
                       KILN_MAX_BANDS);
    for (int i = 0; i < lights->count; i++)
        ki_light_add_sh(&lights->light[i], sh->c);
    sh->bands = bands;
    for (int k = bands * bands; k < KI_SH_COUNT; k++)
        sh->c[k][0] = sh->c[k][1] = sh->c[k][2] = 0;
    return KILN_OK;
}

// ------------------------------------------------------------------------------------------- clamp

kiln_result kiln_map_clamp(kiln_context *context, kiln_map *map, double limit, kiln_clamp *clamp,
                           kiln_error *error)
{
    kiln_clamp unused = {0};
    double before[3], after[3], base;
    clamp = clamp ? clamp : &unused;
    *clamp = (kiln_clamp){0};
    (void)context;
    kiln_result result = ki_map_check(map, error);
    if (result != KILN_OK)
        return result;
    if (!(limit >= 0))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "limit of a clamp is %g, it must be 0 or more",
                       limit);
    ki_light_base(map, before, &base);
    clamp->limit = limit > 0 ? limit : clamp_over_base * base;
    size_t count = kiln_map_texels(map, 0);
    for (size_t i = 0; i < count; i++) {
        float *rgb = map->level[0] + 3 * i;
        double largest_value = fmax(fmax((double)rgb[0], (double)rgb[1]), (double)rgb[2]);
        if (!(largest_value > clamp->limit))
            continue;
        clamp->texel_count++;
        for (int c = 0; c < 3; c++)
            rgb[c] = (float)((double)rgb[c] * (clamp->limit / largest_value));
    }
    ki_light_base(map, after, &base);
    double all = before[0] + before[1] + before[2];
    clamp->light_share = all > 0 ? 1 - (after[0] + after[1] + after[2]) / all : 0;
    return KILN_OK;
}

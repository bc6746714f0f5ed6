// Finds regions of bright texels. In: a map of any shape. Out: connected regions that stand far
// above their surroundings, each with the light that it holds.
//
// The base is the mean brightness of the map after texels above 8 times the base are cut off at
// this limit, which suns then do not move. The brightest texel above 100 times the base begins a
// region. The region is all texels above a threshold that are connected, across gaps of one texel
// too: 8 times the base, and 4 times the median of three circles 8 to 12 degrees around the
// beginning, which are the surroundings. A region that reaches further than 10 degrees, or that a
// disc cannot replace, is grown again with twice the threshold, which leaves glow and haze in the
// map and keeps the core. A region that is still too large at half the brightness of its beginning
// is no compact light.
#include "bake/lights.h"

#include "image/texel.h"
#include "math/math.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double least_over_base = 8, least_over_surroundings = 4;
static const double seed_over_base = 100, seed_over_surroundings = 8;
static const double reach = 10 * KI_PI / 180;

// ------------------------------------------------------------------------------------------- base

static double brightness_of(const float *rgb)
{
    return ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3;
}

// Adds up level 0 of a map: radiance times solid angle by channel, and the brightness, which is cut
// off at `limit`.
static double sum_map(const kiln_map *map, double limit, double light[3])
{
    int width, height;
    double cut = 0;
    ki_level_extent(map, 0, &width, &height);
    light[0] = light[1] = light[2] = 0;
    for (int row = 0; row < height; row++) {
        double sums[4] = {0};
        size_t first = (size_t)row * (size_t)width;
        double solid = ki_texel_solid_angle(map, first);
        for (int x = 0; x < width; x++) {
            const float *rgb = map->level[0] + 3 * (first + (size_t)x);
            if (map->shape != KILN_SHAPE_PANORAMA)
                solid = ki_texel_solid_angle(map, first + (size_t)x);
            for (int c = 0; c < 3; c++)
                sums[c] += solid * (double)rgb[c];
            sums[3] += solid * ki_clamp(brightness_of(rgb), 0, limit);
        }
        for (int c = 0; c < 3; c++)
            light[c] += sums[c];
        cut += sums[3];
    }
    return cut / (4 * KI_PI);
}

void ki_light_base(const kiln_map *map, double light[3], double *base)
{
    enum { STEPS = 4 }; // a sun of 99 % of the light is cut off after the second step
    *base = sum_map(map, HUGE_VAL, light);
    for (int i = 0; i < STEPS; i++)
        *base = sum_map(map, least_over_base * *base, light);
}

// ----------------------------------------------------------------------------------------- growing

static int compare(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

// Returns the median brightness of circles around a direction.
static double surroundings_of(const ki_search *search, const double d[3])
{
    enum { CIRCLES = 3, POINTS = 48 };
    float values[CIRCLES * POINTS];
    // Two unit vectors at right angles to the direction and to each other.
    double a[3] = {d[2], 0, -d[0]}, b[3], length = sqrt(d[0] * d[0] + d[2] * d[2]);
    if (length < 1e-3) {
        a[0] = length = 1;
        a[2] = 0;
    }
    for (int k = 0; k < 3; k++)
        a[k] /= length;
    for (int k = 0; k < 3; k++)
        b[k] = d[(k + 1) % 3] * a[(k + 2) % 3] - d[(k + 2) % 3] * a[(k + 1) % 3];
    for (int i = 0; i < CIRCLES * POINTS; i++) {
        double sine, cosine, s, c, at[3];
        int circle = i / POINTS;
        ki_sincos((8 + 2 * circle) * (KI_PI / 180), &sine, &cosine);
        ki_sincos(2 * KI_PI * i / POINTS, &s, &c);
        for (int k = 0; k < 3; k++)
            at[k] = cosine * d[k] + sine * (c * a[k] + s * b[k]);
        values[i] = search->brightness[ki_texel_of_direction(search->map, at)];
    }
    qsort(values, sizeof values / sizeof *values, sizeof *values, compare);
    return fmax(0, (double)values[CIRCLES * POINTS / 2]);
}

static bool is_negative(const ki_search *search, size_t index)
{
    const float *rgb = search->map->level[0] + 3 * index;
    return rgb[0] < 0 || rgb[1] < 0 || rgb[2] < 0;
}

static void set_owner(ki_search *search, const ki_region *region, uint16_t owner)
{
    for (size_t i = 0; i < region->count; i++)
        search->owner[search->list[region->first + i]] = owner;
}

// Adds a texel to a region if the texel is above the threshold, or below zero next to a texel above
// the threshold: lossy compression leaves such texels beside bright ones.
static void consider(ki_search *search, ki_region *region, size_t index, double threshold,
                     bool touches)
{
    if (search->owner[index])
        return;
    if ((double)search->brightness[index] > threshold || (touches && is_negative(search, index))) {
        search->owner[index] = (uint16_t)(region - search->region + 1);
        search->list[region->first + region->count++] = index;
    }
}

// Grows a region from a texel to all texels above a threshold that are connected, also across a gap
// of one texel. Returns false if the region reaches too far.
static bool grow(ki_search *search, ki_region *region, size_t seed, double threshold)
{
    double centre[3], d[3], nearest = ki_cos(reach);
    kiln_map_direction(search->map, 0, seed, centre);
    *region = (ki_region){.first = search->used};
    consider(search, region, seed, threshold, false);
    for (size_t i = 0; i < region->count; i++) {
        size_t index = search->list[region->first + i], near[4], next[4];
        if (!((double)search->brightness[index] > threshold))
            continue; // a texel below zero
        kiln_map_direction(search->map, 0, index, d);
        if (d[0] * centre[0] + d[1] * centre[1] + d[2] * centre[2] < nearest)
            return false;
        ki_texel_neighbors(search->map, index, near);
        for (int k = 0; k < 4; k++) {
            consider(search, region, near[k], threshold, true);
            ki_texel_neighbors(search->map, near[k], next);
            for (int j = 0; j < 4; j++)
                consider(search, region, next[j], threshold, false);
        }
    }
    return true;
}

// Grows the region of a light from its brightest texel and measures the light. Returns false if
// there is no compact light.
static bool find_region(ki_search *search, ki_region *region, size_t seed)
{
    double peak = (double)search->brightness[seed], direction[3];
    kiln_map_direction(search->map, 0, seed, direction);
    double around = surroundings_of(search, direction);
    double threshold = fmax(least_over_base * search->base, least_over_surroundings * around);
    if (peak < seed_over_surroundings * around)
        return false;
    for (; threshold < peak; threshold *= 2) {
        if (grow(search, region, seed, threshold)) {
            ki_region_measure(search, region, NULL);
            if (ki_mismatch_size((const double(*)[3])region->mismatch) <= ki_light_mismatch &&
                ki_region_is_disc(search, region))
                return true;
        }
        set_owner(search, region, 0);
    }
    return false;
}

// Finds the region of the light whose brightest texel is `seed`, or marks the surrounding texels as
// rejected.
static void take_region(ki_search *search, size_t seed)
{
    ki_region *region = &search->region[search->region_count];
    if (find_region(search, region, seed)) {
        search->used += region->count;
        search->region_count++;
        return;
    }
    grow(search, region, seed, 0.5 * (double)search->brightness[seed]);
    set_owner(search, region, KI_REJECTED);
}

// ------------------------------------------------------------------------------------------ search

// Returns the brightest seed that belongs to no region, or texel_count if there is none.
static size_t next_seed(const ki_search *search)
{
    size_t best = search->texel_count;
    float most = 0;
    for (size_t i = 0; i < search->seed_count; i++) {
        size_t index = search->seed[i];
        if (search->brightness[index] > most && !search->owner[index]) {
            most = search->brightness[index];
            best = index;
        }
    }
    return best;
}

// Sets the brightness of every texel, and lists the seeds: texels that are bright enough to begin a
// region. Allocates the list of the texels that regions may hold.
static bool list_texels(ki_search *search)
{
    size_t room = 0, count = 0;
    double least = least_over_base * search->base, bright = seed_over_base * search->base;
    for (size_t i = 0; i < search->texel_count; i++) {
        search->brightness[i] = (float)brightness_of(search->map->level[0] + 3 * i);
        room += (double)search->brightness[i] > least || is_negative(search, i);
        count += (double)search->brightness[i] > bright;
    }
    search->list = ki_alloc_raw(search->context, room + 1, sizeof *search->list);
    search->seed = ki_alloc_raw(search->context, count + 1, sizeof *search->seed);
    for (size_t i = 0; i < search->texel_count && search->list && search->seed; i++)
        if ((double)search->brightness[i] > bright)
            search->seed[search->seed_count++] = i;
    return search->list && search->seed;
}

// Sets the norm of the map's harmonics and its greatest irradiance, which five bands have within 3
// %, at POINTS directions on a spiral of golden angles.
static kiln_result find_norm(ki_search *search, kiln_error *error)
{
    enum { POINTS = 1024 };
    kiln_sh sh, cosine;
    double squares = 0;
    kiln_result result = kiln_map_sh(search->context, search->map, KILN_MAX_BANDS, 0, &sh, error);
    if (result == KILN_OK)
        result = kiln_sh_filter(&sh, KILN_MAX_BANDS, true, 0, &cosine, error);
    if (result != KILN_OK)
        return result;
    for (int k = 0; k < KI_SH_COUNT; k++)
        for (int c = 0; c < 3; c++)
            squares += sh.c[k][c] * sh.c[k][c];
    search->norm = sqrt(squares / 3);
    for (int i = 0; i < POINTS; i++) {
        double z = (2 * i + 1.0) / POINTS - 1, s, c, value[3], out = sqrt(1 - z * z);
        ki_sincos(2.39996322972865332 * i, &s, &c);
        kiln_sh_evaluate(&cosine, (const double[3]){out * c, out * s, z}, value);
        for (int k = 0; k < 3; k++)
            search->brightest[k] = fmax(search->brightest[k], value[k]);
    }
    return KILN_OK;
}

kiln_result ki_search_run(kiln_context *context, const kiln_map *map, ki_search *search,
                          kiln_error *error)
{
    size_t count = kiln_map_texels(map, 0);
    *search = (ki_search){.context = context, .map = map, .texel_count = count};
    search->brightness = ki_alloc_raw(context, count, sizeof *search->brightness);
    search->owner = ki_alloc(context, count, sizeof *search->owner);
    search->region = ki_alloc_raw(context, KI_MOST_REGIONS, sizeof *search->region);
    if (!search->brightness || !search->owner || !search->region)
        return ki_fail_memory(context, error, "the search for lights", count * sizeof(float));
    ki_light_base(map, search->light, &search->base);
    if (!list_texels(search))
        return ki_fail_memory(context, error, "the search for lights", count * sizeof(size_t));
    kiln_result result = find_norm(search, error);
    if (result != KILN_OK || !(search->light[0] + search->light[1] + search->light[2] > 0))
        return result;
    for (int i = 0; i < KI_MOST_REGIONS; i++) {
        size_t seed = next_seed(search);
        if (seed == count)
            break;
        if (!ki_go_on(context))
            return ki_fail_cancelled(error, "searching for lights");
        take_region(search, seed);
    }
    // The border of a region may have held texels of regions that were found later.
    for (int i = 0; i < search->region_count; i++)
        ki_region_measure(search, &search->region[i], NULL);
    return KILN_OK;
}

void ki_search_free(ki_search *search)
{
    ki_free(search->brightness);
    ki_free(search->owner);
    ki_free(search->list);
    ki_free(search->seed);
    ki_free(search->region);
}

// Replaces values that are no radiance. In: maps or pictures as decoders leave them, with values of
// every kind. Out: finite values, and counts of what was replaced. Method: a first pass over all
// texels replaces infinite values and finds the texels that are not a number. Those are filled from
// the border of each hole inwards, one ring of texels in each round, so that the result does not
// depend on an order within a ring and each texel is visited once.
#include "image/mend.h"

#include "image/light.h"
#include "image/pack.h"

#include <float.h>
#include <math.h>
#include <string.h>

// A level of a map, or a flat picture, whose shape is KILN_SHAPE_AUTO.
typedef struct plane {
    kiln_shape shape;
    int size;          // number of rows of a face
    int width, height; // size in texels; the height counts the rows of all faces
    float *rgb;
} plane;

// ---------------------------------------------------------------------------------- the first pass

enum { STRIPS = 64 }; // number of strips of rows, each of which is a task

typedef struct counts {
    size_t infinite, nan, negative;
    size_t bad; // number of texels with a channel that is infinite or not a number
} counts;

typedef struct survey {
    plane plane;
    kiln_negative negative;
    counts counts[STRIPS];
    ki_light light[STRIPS];
} survey;

static int first_row(const survey *s, int strip)
{
    return (int)((int64_t)s->plane.height * strip / STRIPS);
}

static float *row_of(const survey *s, int row)
{
    return s->plane.rgb + 3 * (size_t)s->plane.width * (size_t)row;
}

// Returns whether all values are finite and have no minus sign. The bits of such a float, read as
// an integer, are below the bits of infinity.
static bool is_plain(const float *values, size_t count)
{
    uint32_t any = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        // 2^23 is the unit of a float's exponent: adding it to the bits of infinity or not-a-number
        // carries into the sign bit
        any |= bits | (bits + (1U << 23));
    }
    return !(any >> 31);
}

static void survey_texel(float rgb[3], counts *found)
{
    bool infinite = false, nan = false, negative = false;
    for (int c = 0; c < 3; c++) {
        if (rgb[c] > FLT_MAX) {
            rgb[c] = KI_HALF_MAX;
            infinite = true;
        } else if (!(rgb[c] >= -FLT_MAX)) {
            rgb[c] = NAN;
            nan = true;
        } else if (rgb[c] == 0) {
            rgb[c] = 0; // the value may have been minus zero
        }
        negative |= rgb[c] < 0;
    }
    found->infinite += infinite;
    found->nan += nan;
    found->negative += negative;
    found->bad += infinite || nan;
}

// Counts the texels of a row and replaces infinite values.
static void survey_row(float *rgb, int width, counts *found)
{
    if (is_plain(rgb, 3 * (size_t)width))
        return;
    for (int x = 0; x < width; x++)
        survey_texel(rgb + 3 * (size_t)x, found);
}

// Task of one thread: counts the texels of a strip and replaces infinite values.
static void survey_strip(void *data, int index)
{
    survey *s = data;
    counts found = {0};
    for (int row = first_row(s, index); row < first_row(s, index + 1); row++)
        survey_row(row_of(s, row), s->plane.width, &found);
    s->counts[index] = found;
}

// ------------------------------------------------------------------------------------------- holes

// State of a texel while holes are filled: its value is known, is unknown, or is unknown and the
// texel is listed.
enum { GOOD, BAD, LISTED };

typedef struct holes {
    kiln_context *context;
    const plane *plane;
    uint8_t *state;
    size_t *list, count; // the texels to fill, in the order in which they are filled
} holes;

// Finds the at most eight texels around the texel `index` and returns their number. Texels at a
// panorama's left and right edge, and at the edges of a cube's faces, have neighbours across the
// edge.
static int find_neighbours(const plane *p, size_t index, size_t found[8])
{
    int x = (int)(index % (size_t)p->width), row = (int)(index / (size_t)p->width), count = 0;
    for (int i = 0; i < 9; i++) {
        int u = x + i % 3 - 1, v = row + i / 3 - 1;
        if (i == 4)
            continue;
        if (p->shape == KILN_SHAPE_CUBE) {
            found[count++] = ki_cube_texel(p->size, row / p->size, u, row % p->size + i / 3 - 1);
            continue;
        }
        if (p->shape == KILN_SHAPE_PANORAMA)
            u = (u + p->width) % p->width;
        if (u >= 0 && u < p->width && v >= 0 && v < p->height)
            found[count++] = (size_t)v * (size_t)p->width + (size_t)u;
    }
    return count;
}

static int find_good(const holes *h, size_t index, size_t found[8])
{
    size_t all[8];
    int count = 0, all_count = find_neighbours(h->plane, index, all);
    for (int i = 0; i < all_count; i++)
        if (h->state[all[i]] == GOOD)
            found[count++] = all[i];
    return count;
}

// Adds a texel to the list of texels to fill if it has a channel that is not a number, is not in
// the list yet, and has a neighbour whose value is known.
static void list(holes *h, size_t index)
{
    size_t good[8];
    if (h->state[index] != BAD || !find_good(h, index, good))
        return;
    h->state[index] = LISTED;
    h->list[h->count++] = index;
}

static bool is_nan(const float rgb[3])
{
    return isnan(rgb[0]) || isnan(rgb[1]) || isnan(rgb[2]);
}

// Sets the channels of a listed texel that are not a number to the mean of those neighbours whose
// value is known.
static void fill(const holes *h, size_t index)
{
    size_t good[8];
    int count = find_good(h, index, good);
    float *rgb = h->plane->rgb + 3 * index;
    for (size_t c = 0; c < 3; c++) {
        double sum = 0;
        for (int i = 0; i < count; i++)
            sum += (double)h->plane->rgb[3 * good[i] + c];
        if (isnan(rgb[c]))
            rgb[c] = (float)(sum / count);
    }
}

// Asks whether to go on, once in 65536 calls for successive texels.
static bool go_on(const holes *h, size_t texel)
{
    return texel % 65536 != 65535 || ki_go_on(h->context);
}

// Fills the texels of the list from `begin` on, one ring around the holes, and marks them as known.
// Then lists the unknown texels around them, the next ring. Returns false if the caller wants to
// stop.
static bool fill_ring(holes *h, size_t begin)
{
    size_t end = h->count, around[8];
    for (size_t i = begin; i < end; i++) {
        fill(h, h->list[i]);
        if (!go_on(h, i))
            return false;
    }
    for (size_t i = begin; i < end; i++)
        h->state[h->list[i]] = GOOD;
    for (size_t i = begin; i < end; i++) {
        if (!go_on(h, i))
            return false;
        int count = find_neighbours(h->plane, h->list[i], around);
        for (int k = 0; k < count; k++)
            list(h, around[k]);
    }
    return ki_go_on(h->context);
}

// Lists all texels beside known ones, and then fills ring after ring.
static bool fill_all(holes *h, size_t texels)
{
    for (size_t i = 0; i < texels; i++) {
        h->state[i] = is_nan(h->plane->rgb + 3 * i) ? BAD : GOOD;
        if (!go_on(h, i))
            return false;
    }
    for (size_t i = 0; i < texels; i++) {
        list(h, i);
        if (!go_on(h, i))
            return false;
    }
    for (size_t begin = 0, end; begin < h->count; begin = end) {
        end = h->count;
        if (!fill_ring(h, begin))
            return false;
    }
    return true;
}

static kiln_result fill_holes(kiln_context *context, const plane *p, size_t bad_count,
                              kiln_error *error)
{
    size_t texels = (size_t)p->width * (size_t)p->height;
    static const char what[] = "the texels that are not a number";
    holes h = {
        .context = context, .plane = p, .list = ki_alloc_raw(context, bad_count, sizeof(size_t))};
    void *state = NULL;
    kiln_result result = h.list ? ki_alloc_zeroed(context, texels, 1, what, &state, error)
                                : ki_fail_memory(context, error, what, bad_count * sizeof(size_t));
    h.state = state;
    if (result == KILN_OK && !fill_all(&h, texels))
        result = ki_fail_cancelled(error, "reading");
    ki_free(h.state);
    ki_free(h.list);
    return result;
}

// --------------------------------------------------------------------------------- negative values

// Sums the light of a row. If `negative` is KILN_NEGATIVE_ZERO, then sets its values below zero to
// 0.
static ki_light weigh_row(const plane *p, int row, kiln_negative negative, float *rgb)
{
    ki_light light = {0};
    ki_add_light(p->shape, p->size, row, p->width, rgb, (double)INFINITY, &light);
    for (int i = 0; i < 3 * p->width && negative == KILN_NEGATIVE_ZERO; i++)
        rgb[i] = rgb[i] < 0 ? 0 : rgb[i];
    return light;
}

// Task of one thread: sums the light of a strip of rows, each by weigh_row.
static void weigh_strip(void *data, int index)
{
    survey *s = data;
    ki_light *sum = &s->light[index];
    *sum = (ki_light){0};
    for (int row = first_row(s, index); row < first_row(s, index + 1); row++) {
        ki_light light = weigh_row(&s->plane, row, s->negative, row_of(s, row));
        sum->above_zero += light.above_zero;
        sum->below_zero += light.below_zero;
    }
}

// ------------------------------------------------------------------------------- the whole picture

static counts add_counts(const survey *s)
{
    counts sum = {0};
    for (int i = 0; i < STRIPS; i++) {
        sum.infinite += s->counts[i].infinite;
        sum.nan += s->counts[i].nan;
        sum.negative += s->counts[i].negative;
        sum.bad += s->counts[i].bad;
    }
    return sum;
}

static kiln_result fail_bad(const char *name, size_t texels, kiln_error *error)
{
    return ki_fail(error, KILN_ERROR_FORMAT,
                   "%s: all of its %zu texels are infinite or not a number", name, texels);
}

// Mends a level or a picture, here called plane. Adds what was replaced to the counts of *report,
// and the plane's light to *light if it has values below zero.
static kiln_result mend_plane(kiln_context *context, const char *name, const plane *p,
                              kiln_negative negative, kiln_load_report *report, ki_light *light,
                              kiln_error *error)
{
    survey s = {.plane = *p, .negative = negative};
    size_t texels = (size_t)p->width * (size_t)p->height;
    if (!ki_parallel_steps(context, NULL, STRIPS, survey_strip, &s))
        return ki_fail_cancelled(error, "reading");
    counts sum = add_counts(&s);
    report->texel_count += texels;
    report->infinite_count += sum.infinite;
    report->nan_count += sum.nan;
    report->negative_count += sum.negative;
    if (sum.bad == texels)
        return fail_bad(name, texels, error);
    kiln_result result = sum.nan ? fill_holes(context, p, sum.nan, error) : KILN_OK;
    if (result != KILN_OK || !sum.negative)
        return result;
    if (!ki_parallel_steps(context, NULL, STRIPS, weigh_strip, &s))
        return ki_fail_cancelled(error, "reading");
    for (int i = 0; i < STRIPS; i++) {
        light->above_zero += s.light[i].above_zero;
        light->below_zero += s.light[i].below_zero;
    }
    return KILN_OK;
}

kiln_result ki_map_mend(kiln_context *context, const char *name, kiln_negative negative,
                        kiln_map *map, kiln_load_report *report, kiln_error *error)
{
    kiln_result result = KILN_OK;
    ki_light light = {0};
    for (int level = 0; level < map->level_count && result == KILN_OK; level++) {
        plane p = {.shape = map->shape, .rgb = map->level[level]};
        p.size = kiln_map_level_size(map, level);
        ki_level_extent(map, level, &p.width, &p.height);
        result = mend_plane(context, name, &p, negative, report, &light, error);
    }
    report->negative = negative;
    report->negative_share = ki_share_below(&light);
    return result;
}

kiln_result ki_image_mend(kiln_context *context, const char *name, kiln_image *image,
                          kiln_load_report *report, kiln_error *error)
{
    plane p = {KILN_SHAPE_AUTO, image->height, image->width, image->height, image->pixels};
    kiln_load_report found = {0};
    ki_light light = {0};
    kiln_result result = mend_plane(context, name, &p, KILN_NEGATIVE_KEEP, &found, &light, error);
    if (report) {
        report->infinite_count += found.infinite_count;
        report->nan_count += found.nan_count;
    }
    return result;
}

// ------------------------------------------------------------------------------- rows that pass by

void ki_row_mend(int size, int row, kiln_negative negative, bool weigh, float *rgb,
                 ki_row_finds *finds)
{
    counts found = {0};
    const plane p = {.shape = KILN_SHAPE_PANORAMA, .size = size, .width = 2 * size};
    survey_row(rgb, p.width, &found);
    *finds = (ki_row_finds){.infinite_count = (int)found.infinite,
                            .nan_count = (int)found.nan,
                            .negative_count = (int)found.negative,
                            .weighed = weigh || found.negative};
    if (!finds->weighed)
        return;
    ki_light light = weigh_row(&p, row, negative, rgb);
    finds->above_zero = light.above_zero;
    finds->below_zero = light.below_zero;
}

kiln_result ki_rows_report(const char *name, int size, kiln_negative negative,
                           const ki_row_finds *finds, kiln_load_report *report, kiln_error *error)
{
    const survey s = {.plane = {.shape = KILN_SHAPE_PANORAMA, .size = size, .height = size}};
    size_t texels = 2 * (size_t)size * (size_t)size, infinite = 0, below = 0;
    ki_light light = {0};
    for (int strip = 0; strip < STRIPS; strip++) {
        ki_light sum = {0};
        for (int row = first_row(&s, strip); row < first_row(&s, strip + 1); row++) {
            infinite += (size_t)finds[row].infinite_count;
            below += (size_t)finds[row].negative_count;
            sum.above_zero += finds[row].above_zero;
            sum.below_zero += finds[row].below_zero;
        }
        light.above_zero += sum.above_zero;
        light.below_zero += sum.below_zero;
    }
    report->texel_count += texels;
    report->infinite_count += infinite;
    report->negative_count += below;
    report->negative = negative;
    report->negative_share = below ? ki_share_below(&light) : 0;
    return infinite == texels ? fail_bad(name, texels, error) : KILN_OK;
}

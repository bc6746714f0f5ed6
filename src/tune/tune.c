#include "tune/tune.h"

#include "image/image.h"
#include "math/math.h"
#include "sphere/sh.h"
#include "tune/tune_level.h"
#include "tune/tune_mix.h"
#include "tune/tune_read.h"

#include <math.h>
#include <string.h>

// A degree whose power is less than this of the mean's is the rounding of a float: it is not sharpened.
static const double rounding = 1e-14;
// Faces up to this size are made for bilinear reads; the coarse ones at 4 x 4 points a texel, else 2 x 2.
enum { MOST_READS = 256, COARSE = 32 };

struct ki_display {
    kiln_context *context;
    ki_shown shown;
    kiln_shape shape;
    int size, smallest, level_count;
    double tolerance;
    bool pinned[KILN_MAX_LEVELS];
    ki_palette palette;
    // Of an execution.
    ki_mixtures mixtures;
    double (*power)[3]; // by degree, without the suns, and then with them
};

static int size_at(const ki_display *d, int level)
{
    return ki_max(d->smallest, d->size >> level);
}

// Texels of a cube's face show degrees up to twice its size; twice that do for points between them.
static int most_degree(int size)
{
    return ki_min(ki_max(4 * size, KI_LEAST_DEGREE), KILN_MAX_DEGREE);
}

static kiln_result analyze_lobes(ki_display *d, kiln_error *error)
{
    kiln_result result = KILN_OK;
    ki_palette *p = &d->palette;
    for (int n = 0; n <= p->count && result == KILN_OK; n++) {
        ki_zonal zonal = {.lobe = kiln_lobe_ggx(p->roughness[n] * p->roughness[n])};
        result = ki_zonal_analyze(d->context, &zonal, d->tolerance, most_degree(d->size),
                                  &p->spectra[n], error);
    }
    return result;
}

kiln_result ki_display_create(kiln_context *context, const kiln_prefilter_def *def,
                              const float roughness[KILN_MAX_LEVELS], const ki_shown *shown,
                              ki_display **display, kiln_error *error)
{
    ki_display *d = *display = ki_alloc(context, 1, sizeof *d);
    if (!d)
        return ki_fail_memory(context, error, "a display", sizeof *d);
    d->context = context;
    d->shown = *shown;
    d->shape = def->shape;
    d->size = def->size;
    d->smallest = ki_max(1, def->smallest);
    d->level_count = def->level_count;
    d->tolerance = def->tolerance;
    ki_palette *p = &d->palette;
    ki_palette_lay(p, shown->level, d->level_count, d->size);
    int last = d->level_count - 1;
    p->roughness[p->count] = (double)roughness[last];
    for (int n = 0; n < p->count; n++) {
        int i = (int)p->level[n];
        p->fitted[i] = true;
        if (p->level[n] > i)
            p->fitted[i + 1] = true;
    }
    d->pinned[0] = !shown->soft;
    d->pinned[last] = d->pinned[last] || shown->keep_last;
    for (int i = 0; i <= last; i++) {
        p->fitted[i] = p->fitted[i] && !d->pinned[i];
        for (int n = 0; n < p->count; n++)
            if (fabs(p->roughness[n] - (double)roughness[i]) <
                fabs(p->roughness[p->nearest[i]] - (double)roughness[i]))
                p->nearest[i] = n;
    }
    kiln_result result = analyze_lobes(d, error);
    if (result != KILN_OK) {
        ki_display_destroy(d);
        *display = NULL;
    }
    return result;
}

void ki_display_destroy(ki_display *d)
{
    if (!d)
        return;
    for (int n = 0; n <= d->palette.count; n++)
        ki_zonal_free(&d->palette.spectra[n]);
    ki_free(d->power);
    ki_free(d);
}

int ki_display_degree(const ki_display *d)
{
    int degree = 0;
    for (int n = 0; n <= d->palette.count; n++)
        degree = ki_max(degree, d->palette.spectra[n].degree);
    return degree;
}

bool ki_display_fits(const ki_display *d, int level)
{
    return d->palette.fitted[level];
}

static kiln_result choose_mixtures(ki_display *d, const kiln_spectrum *spectrum, kiln_error *error)
{
    size_t count = (size_t)spectrum->degree + 1;
    ki_free(d->power);
    d->power = ki_alloc(d->context, 2 * count, sizeof *d->power);
    if (!d->power)
        return ki_fail_memory(d->context, error, "a spectrum's power",
                              2 * count * sizeof *d->power);
    kiln_result result = ki_spectrum_power(spectrum, false, d->power, error);
    if (result == KILN_OK)
        result = ki_spectrum_power(spectrum, true, d->power + count, error);
    if (result == KILN_OK)
        result = ki_palette_mix(d->context, &d->palette, spectrum, (const double(*)[3])d->power,
                                &d->mixtures, error);
    return result;
}

// ----------------------------------------------------------------------------------------- levels

static double power_at(const ki_display *d, int l)
{
    return d->power[l][0] + d->power[l][1] + d->power[l][2];
}

// A level's kernel: its spectrum, cut where the tolerance allows, and its shape.
static kiln_result make_kernel(const ki_display *d, int level, ki_zonal *zonal, ki_mixture *mixture,
                               ki_zonal_spectrum *spectrum, kiln_error *error)
{
    double alphas[KI_MOST_LOBES], weights[KI_MOST_LOBES], integrals[KI_MOST_LOBES];
    int count = 0, degree = ki_display_degree(d);
    *spectrum = (ki_zonal_spectrum){.integral = 1};
    spectrum->k = ki_alloc(d->context, (size_t)degree + 1, sizeof *spectrum->k);
    if (!spectrum->k)
        return ki_fail_memory(d->context, error, "a level's kernel",
                              (size_t)degree * sizeof *spectrum->k);
    for (int n = 0; n <= d->palette.count; n++) {
        double weight = d->mixtures.weights[level][n];
        if (weight == 0)
            continue;
        alphas[count] = d->palette.roughness[n] * d->palette.roughness[n];
        weights[count] = weight;
        integrals[count++] = d->palette.spectra[n].integral;
        for (int l = 0; l <= d->palette.spectra[n].degree; l++)
            spectrum->k[l] += weight * d->palette.spectra[n].k[l];
    }
    double all = 0, left = 0;
    for (int l = 0; l <= degree; l++)
        all += spectrum->k[l] * spectrum->k[l] * power_at(d, l);
    int l = ki_min(degree, most_degree(size_at(d, level)));
    for (; l > ki_min(degree, KI_LEAST_DEGREE); l--) {
        left += spectrum->k[l] * spectrum->k[l] * power_at(d, l);
        if (left > d->tolerance * d->tolerance * all)
            break;
    }
    for (int i = 1; i <= degree; i++)
        if (i > l || power_at(d, i) < rounding * power_at(d, 0))
            spectrum->k[i] = 0;
    spectrum->degree = l;
    ki_mixture_create(mixture, alphas, weights, integrals, count);
    // As narrow as the narrowest lobe that tells.
    double narrowest = 1;
    for (int n = 0; n < count; n++)
        if (fabs(weights[n]) > 0.01)
            narrowest = fmin(narrowest, alphas[n]);
    *zonal = (ki_zonal){.lobe = kiln_lobe_ggx(narrowest), .mixture = mixture};
    return KILN_OK;
}

// What a level should show, at the texels of level `index` of a map of any size.
static kiln_result make_target(ki_display *d, const ki_legendre *legendre,
                               const kiln_spectrum *spectrum, double rotation, int level,
                               const kiln_map *mirror, kiln_map *map, int index,
                               const ki_stage *stage, kiln_error *error)
{
    ki_zonal zonal;
    ki_zonal_spectrum kernel;
    ki_level *plan = NULL;
    ki_mixture *mixture = ki_alloc(d->context, 1, sizeof *mixture);
    if (!mixture)
        return ki_fail_memory(d->context, error, "a level's kernel", sizeof *mixture);
    kiln_result result = make_kernel(d, level, &zonal, mixture, &kernel, error);
    if (result == KILN_OK)
        result = ki_level_create(d->context, legendre, &zonal, &kernel, d->shape,
                                 kiln_map_level_size(map, index), &plan, error);
    if (result == KILN_OK)
        result = ki_level_execute(plan, spectrum, NULL, rotation, map, index, stage, error);
    if (result == KILN_OK)
        ki_add_mirror(d->context, mirror, d->mixtures.weights[level][d->palette.count + 1], map,
                      index);
    ki_level_destroy(plan);
    ki_free(mixture);
    return result;
}

// One beyond the last level is none.
static bool is_read(const ki_display *d, int level)
{
    if (level >= d->level_count || level >= KILN_MAX_LEVELS)
        return false;
    int size = size_at(d, level);
    bool made = d->palette.fitted[level] || (level != 0 && d->pinned[level]);
    return made && d->shape == KILN_SHAPE_CUBE && !d->shown.flat && size <= MOST_READS && size > 1;
}

typedef struct correction {
    kiln_map *goal;
    const kiln_map *map, *target; // of the next level: what it shows, and what it should
    int level;
    double factor;
} correction;

// Task: a row of the goal, less what the next level errs by.
static void correct_row(void *data, int row)
{
    const correction *a = data;
    size_t size = (size_t)a->goal->size;
    for (size_t i = (size_t)row * size; i < ((size_t)row + 1) * size; i++) {
        double direction[3], shown[3], wanted[3];
        kiln_map_direction(a->goal, 0, i, direction);
        ki_cube_read(a->map, a->level, direction, shown);
        ki_cube_read(a->target, 0, direction, wanted);
        for (size_t c = 0; c < 3; c++)
            a->goal->level[0][3 * i + c] -= (float)(a->factor * (shown[c] - wanted[c]));
    }
}

// A level for bilinear reads: its target at points between its texels, where it also makes up for the
// error of the next level, whose target is in `targets`.
static kiln_result make_read(ki_display *d, const ki_legendre *legendre,
                             const kiln_spectrum *spectrum, double rotation, int level,
                             const kiln_map *mirror, kiln_map *map, kiln_map *targets,
                             const ki_stage *stage, kiln_error *error)
{
    int size = size_at(d, level);
    kiln_map *target = &targets[level], goal;
    *target = (kiln_map){
        .shape = KILN_SHAPE_CUBE, .size = size * (size > COARSE ? 2 : 4), .level_count = 1};
    goal = *target;
    kiln_result result = ki_map_allocate(d->context, target, error);
    if (result == KILN_OK)
        result =
            make_target(d, legendre, spectrum, rotation, level, mirror, target, 0, stage, error);
    if (result == KILN_OK)
        result = ki_map_allocate(d->context, &goal, error);
    if (result != KILN_OK)
        return result;
    memcpy(goal.level[0], target->level[0], 3 * kiln_map_texels(target, 0) * sizeof(float));
    if (d->palette.fitted[level] && is_read(d, level + 1)) {
        correction a = {&goal, map, &targets[level + 1], level + 1, d->mixtures.coupling[level]};
        ki_parallel_for(d->context, 6 * goal.size, correct_row, &a);
    }
    result = ki_fit_reads(d->context, &goal, map, level, error);
    kiln_map_free(&goal);
    return result;
}

kiln_result ki_display_execute(ki_display *d, const ki_legendre *legendre,
                               const kiln_spectrum *spectrum, double rotation, kiln_map *map,
                               const ki_stage *stage, kiln_error *error)
{
    kiln_map mirror = {.shape = d->shape, .size = d->size, .level_count = 1};
    while (d->size >> mirror.level_count >= d->smallest && mirror.level_count < d->level_count)
        mirror.level_count++;
    kiln_map targets[KILN_MAX_LEVELS] = {{0}};
    kiln_result result = choose_mixtures(d, spectrum, error);
    if (result == KILN_OK)
        result = ki_map_allocate(d->context, &mirror, error);
    if (result != KILN_OK)
        return result;
    ki_make_mirrors(d->context, map, &mirror);
    // From coarse to fine: a fine level can make up for what a coarse one cannot show.
    for (int i = d->level_count - 1; i >= 0 && result == KILN_OK; i--) {
        if (is_read(d, i)) {
            result =
                make_read(d, legendre, spectrum, rotation, i, &mirror, map, targets, stage, error);
            if (i + 1 < d->level_count)
                kiln_map_free(&targets[i + 1]);
        } else if (d->palette.fitted[i]) {
            result = make_target(d, legendre, spectrum, rotation, i, &mirror, map, i, stage, error);
            if (result == KILN_OK)
                result = ki_clear_negative(d->context, map, i, error);
        }
    }
    for (int i = 0; i < d->level_count; i++)
        kiln_map_free(&targets[i]);
    kiln_map_free(&mirror);
    return result;
}

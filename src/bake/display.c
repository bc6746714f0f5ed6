#include "bake/display.h"

#include "bake/display_level.h"
#include "bake/display_read.h"
#include "bake/prefilter.h"
#include "image/image.h"
#include "math/math.h"
#include "sphere/sh.h"

#include <math.h>
#include <string.h>

// Gauss nodes between two levels, and the least roughness that counts.
enum { NODES = 4, MOST_NODES = NODES * KILN_MAX_LEVELS, MOST_BASIS = MOST_NODES + 2 };
static const double least_roughness = 0.05;
// What a level costs where no roughness shows it: it should be what it is in the exact chain.
static const double prior = 1e-3;
// Level 0 free: the share of the mirror in it, as if so much roughness showed it alone.
static const double mirror_share = 1e-3;
// Weights below this are left out.
static const double least_weight = 1e-5;
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
    bool fitted[KILN_MAX_LEVELS], pinned[KILN_MAX_LEVELS];
    // The basis: an environment seen through GGX at each node, at the last level's roughness, and by a
    // mirror.
    int node_count;
    double roughness[MOST_BASIS], width[MOST_BASIS], level[MOST_BASIS];
    ki_zonal_spectrum spectra[MOST_BASIS];
    int nearest[KILN_MAX_LEVELS]; // node to a level's own roughness
    // Of an execution.
    double weights[KILN_MAX_LEVELS][MOST_BASIS];
    double (*power)[3];               // by degree, without the suns
    double coupling[KILN_MAX_LEVELS]; // A_i,i+1 / A_ii
};

static int size_at(const ki_display *d, int level)
{
    return ki_max(d->smallest, d->size >> level);
}

static double level_at(const ki_display *d, double roughness)
{
    return d->shown.level(roughness, d->level_count, d->size);
}

// Roughness from the least to 1, cut where the shader comes to another pair of levels.
static void lay_nodes(ki_display *d)
{
    static const double x[NODES] = {-0.86113631159405257522, -0.33998104358485626480,
                                    0.33998104358485626480, 0.86113631159405257522};
    static const double w[NODES] = {0.34785484513745385737, 0.65214515486254614263,
                                    0.65214515486254614263, 0.34785484513745385737};
    double from = least_roughness;
    while (from < 1 && d->node_count + NODES <= MOST_NODES) {
        // The largest roughness that is shown by the same two levels, by halving.
        double next = floor(level_at(d, from + 1e-9)) + 1, low = from, high = 1;
        if (level_at(d, 1) <= next)
            low = 1;
        for (int i = 0; i < 60 && low < 1; i++) {
            double middle = 0.5 * (low + high);
            *(level_at(d, middle) <= next ? &low : &high) = middle;
        }
        for (int i = 0; i < NODES && low > from; i++) {
            int n = d->node_count++;
            d->roughness[n] = from + 0.5 * (1 + x[i]) * (low - from);
            d->width[n] = 0.5 * w[i] * (low - from);
            d->level[n] = ki_clamp(level_at(d, d->roughness[n]), 0, d->level_count - 1);
        }
        from = low > from ? low : from + 1e-6;
    }
}

// Texels of a cube's face show degrees up to twice its size; twice that do for points between them.
static int most_degree(int size)
{
    return ki_min(ki_max(4 * size, KI_LEAST_DEGREE), KILN_MAX_DEGREE);
}

static kiln_result analyze_nodes(ki_display *d, kiln_error *error)
{
    kiln_result result = KILN_OK;
    for (int n = 0; n <= d->node_count && result == KILN_OK; n++) {
        ki_zonal zonal = {.lobe = kiln_lobe_ggx(d->roughness[n] * d->roughness[n])};
        result = ki_zonal_analyze(d->context, &zonal, d->tolerance, most_degree(d->size),
                                  &d->spectra[n], error);
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
    lay_nodes(d);
    int last = d->level_count - 1;
    d->roughness[d->node_count] = (double)roughness[last];
    for (int n = 0; n < d->node_count; n++) {
        int i = (int)d->level[n];
        d->fitted[i] = true;
        if (d->level[n] > i)
            d->fitted[i + 1] = true;
    }
    d->pinned[0] = !shown->soft;
    d->pinned[last] = d->pinned[last] || shown->keep_last;
    for (int i = 0; i <= last; i++) {
        d->fitted[i] = d->fitted[i] && !d->pinned[i];
        for (int n = 0; n < d->node_count; n++)
            if (fabs(d->roughness[n] - (double)roughness[i]) <
                fabs(d->roughness[d->nearest[i]] - (double)roughness[i]))
                d->nearest[i] = n;
    }
    kiln_result result = analyze_nodes(d, error);
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
    for (int n = 0; n <= d->node_count; n++)
        ki_zonal_free(&d->spectra[n]);
    ki_free(d->power);
    ki_free(d);
}

int ki_display_degree(const ki_display *d)
{
    int degree = 0;
    for (int n = 0; n <= d->node_count; n++)
        degree = ki_max(degree, d->spectra[n].degree);
    return degree;
}

bool ki_display_fits(const ki_display *d, int level)
{
    return d->fitted[level];
}

// ---------------------------------------------------------------------------------------- weights

// 1 / |T_r|^2 of each node, and last of the mirror.
static kiln_result weigh_nodes(ki_display *d, const kiln_spectrum *spectrum, double *w,
                               kiln_error *error)
{
    int degree = spectrum->degree;
    double(*power)[3] = ki_alloc(d->context, 2 * ((size_t)degree + 1), sizeof *power);
    if (!power)
        return ki_fail_memory(d->context, error, "a spectrum's power",
                              2 * (size_t)degree * sizeof *power);
    ki_free(d->power);
    d->power = power;
    kiln_result result = ki_spectrum_power(spectrum, false, power, error);
    power += degree + 1;
    if (result == KILN_OK)
        result = ki_spectrum_power(spectrum, true, power, error);
    for (int n = 0; n <= d->node_count && result == KILN_OK; n++) {
        const ki_zonal_spectrum *s = &d->spectra[n < d->node_count ? n : 0];
        double sum = 0;
        for (int l = 0; l <= degree && (l <= s->degree || n == d->node_count); l++) {
            double k = n < d->node_count ? s->k[l] : 1;
            sum += k * k * (power[l][0] + power[l][1] + power[l][2]);
        }
        // Relative to the mean radiance, so that no unit overflows; black is as good as white.
        double mean = power[0][0] + power[0][1] + power[0][2];
        w[n] = sum > 0 && mean > 0 ? mean / sum : 1;
    }
    return result;
}

typedef struct equations {
    double diagonal[KILN_MAX_LEVELS], next[KILN_MAX_LEVELS];
    double right[KILN_MAX_LEVELS][MOST_BASIS];
} equations;

static void lay_equations(ki_display *d, const double *w, equations *e)
{
    int last = d->level_count - 1, mirror = d->node_count + 1;
    memset(e, 0, sizeof *e);
    for (int n = 0; n < d->node_count; n++) {
        int i = ki_min((int)d->level[n], last);
        double t = d->level[n] - i, weight = w[n] * d->width[n];
        e->diagonal[i] += weight * (1 - t) * (1 - t);
        e->right[i][n] += weight * (1 - t);
        if (i < last) {
            e->diagonal[i + 1] += weight * t * t;
            e->next[i] += weight * t * (1 - t);
            e->right[i + 1][n] += weight * t;
        }
    }
    for (int i = 0; i <= last; i++) {
        double own = i ? prior * (e->diagonal[i] + e->next[i] + e->next[i - 1])
                       : mirror_share * w[d->node_count];
        e->diagonal[i] += own;
        e->right[i][i ? d->nearest[i] : mirror] += own;
    }
    for (int i = 0; i <= last; i++)
        d->coupling[i] = e->diagonal[i] > 0 ? e->next[i] / e->diagonal[i] : 0;
    // What stays as it is goes to the right.
    for (int i = 0; i <= last; i++) {
        if (d->fitted[i])
            continue;
        int as = i == 0 ? mirror : i == last ? d->node_count : d->nearest[i];
        memset(e->right[i], 0, sizeof e->right[i]);
        e->right[i][as] = e->diagonal[i] = 1;
        if (i > 0)
            e->right[i - 1][as] -= e->next[i - 1];
        if (i < last && d->fitted[i + 1])
            e->right[i + 1][as] -= e->next[i];
        if (i > 0)
            e->next[i - 1] = 0;
        e->next[i] = 0;
    }
}

static void solve_equations(ki_display *d, equations *e)
{
    int last = d->level_count - 1, count = d->node_count + 2;
    for (int i = 0; i < last; i++) {
        double factor = e->next[i] / e->diagonal[i];
        e->diagonal[i + 1] -= factor * e->next[i];
        for (int n = 0; n < count; n++)
            e->right[i + 1][n] -= factor * e->right[i][n];
    }
    for (int i = last; i >= 0; i--) {
        double sum = 0, *to = d->weights[i];
        for (int n = 0; n < count; n++) {
            double after = i < last ? e->next[i] * d->weights[i + 1][n] : 0;
            to[n] = (e->right[i][n] - after) / e->diagonal[i];
            if (fabs(to[n]) < least_weight)
                to[n] = 0;
            sum += to[n];
        }
        for (int n = 0; n < count; n++)
            to[n] /= sum; // white stays white
    }
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
    double alphas[MOST_BASIS], weights[MOST_BASIS], integrals[MOST_BASIS];
    int count = 0, degree = ki_display_degree(d);
    *spectrum = (ki_zonal_spectrum){.integral = 1};
    spectrum->k = ki_alloc(d->context, (size_t)degree + 1, sizeof *spectrum->k);
    if (!spectrum->k)
        return ki_fail_memory(d->context, error, "a level's kernel",
                              (size_t)degree * sizeof *spectrum->k);
    for (int n = 0; n <= d->node_count; n++) {
        double weight = d->weights[level][n];
        if (weight == 0)
            continue;
        alphas[count] = d->roughness[n] * d->roughness[n];
        weights[count] = weight;
        integrals[count++] = d->spectra[n].integral;
        for (int l = 0; l <= d->spectra[n].degree; l++)
            spectrum->k[l] += weight * d->spectra[n].k[l];
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
        ki_add_mirror(d->context, mirror, d->weights[level][d->node_count + 1], map, index);
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
    bool made = d->fitted[level] || (level != 0 && d->pinned[level]);
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
    if (d->fitted[level] && is_read(d, level + 1)) {
        correction a = {&goal, map, &targets[level + 1], level + 1, d->coupling[level]};
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
    double w[MOST_BASIS];
    equations e;
    kiln_map mirror = {.shape = d->shape, .size = d->size, .level_count = 1};
    while (d->size >> mirror.level_count >= d->smallest && mirror.level_count < d->level_count)
        mirror.level_count++;
    kiln_map targets[KILN_MAX_LEVELS] = {{0}};
    kiln_result result = weigh_nodes(d, spectrum, w, error);
    if (result == KILN_OK)
        result = ki_map_allocate(d->context, &mirror, error);
    if (result != KILN_OK)
        return result;
    lay_equations(d, w, &e);
    solve_equations(d, &e);
    ki_make_mirrors(d->context, map, &mirror);
    // From coarse to fine: a fine level can make up for what a coarse one cannot show.
    for (int i = d->level_count - 1; i >= 0 && result == KILN_OK; i--) {
        if (is_read(d, i)) {
            result =
                make_read(d, legendre, spectrum, rotation, i, &mirror, map, targets, stage, error);
            if (i + 1 < d->level_count)
                kiln_map_free(&targets[i + 1]);
        } else if (d->fitted[i]) {
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

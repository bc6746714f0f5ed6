// Makes the tuned levels of tune.h. In: the spectrum of an environment, and how an engine reads
// levels. Out: the texels of the tuned levels. Method: tune_mix.c finds the mixture of lobes of
// each level. A large level is evaluated from its mixture at its texels. For a cube's level with
// faces of at most MOST_READS texels, the mixture is evaluated on a finer grid instead, and
// tune_read.c finds the texels whose bilinear interpolation comes nearest to the values on this
// grid. docs/theory/tuning.md derives the method.
#include "tune/tune.h"

#include "image/image.h"
#include "math/math.h"
#include "sphere/points.h"
#include "sphere/sh.h"
#include "tune/tune_faces.h"
#include "tune/tune_level.h"
#include "tune/tune_mix.h"
#include "tune/tune_read.h"

#include <math.h>
#include <string.h>

// Spherical harmonics of degrees with less than this share of the power of degree 0 are dropped.
// They are the rounding errors of floats, which a mixture with negative weights would amplify.
static const double rounding = 1e-14;
// MOST_READS: greatest size of a cube level's faces, in texels, for which ki_solve_texels chooses
// the texels such that bilinear reads of the level show the least error. COARSE: greatest size of
// faces that are compared with their target at 4 x 4 points per texel; larger faces are compared at
// 2 x 2 points.
enum { MOST_READS = 256, COARSE = 32 };

struct ki_tune {
    ki_reading reading;
    ki_tilt tilt;
    kiln_shape shape;
    int size, smallest, level_count;
    double tolerance;
    bool pinned[KILN_MAX_LEVELS];
    int lobe_degree; // the largest degree of a node's lobe
    int degree;      // to which the finest tuned level is computed at most
    ki_nodes nodes;
};

// The data of one call of ki_tune_execute: the environment, and the mixtures and levels that are
// computed for it.
typedef struct run {
    kiln_context *context;
    const ki_tune *tune;
    const ki_legendre *legendre;
    const kiln_spectrum *spectrum;
    double rotation;
    // every level is computed to its highest degree, see ki_tune_execute
    bool rehearses;
    ki_mixtures mixtures;
    // power of each degree of the norms and channel: [degree + 1] without the suns, then [degree +
    // 1] with the suns
    double (*power)[3];
    // the unfiltered environment: level 0 of `map`, and its means over ever larger texels
    // (ki_make_mirrors)
    kiln_map mirror;
    kiln_map *map; // map whose tuned levels are written
    // For each level whose texels ki_solve_texels computes, the radiance that bilinear reads of the
    // level should show; empty for other levels.
    kiln_map targets[KILN_MAX_LEVELS];
} run;

static int size_at(const ki_tune *t, int level)
{
    return ki_max(t->smallest, t->size >> level);
}

// The degree of harmonics to which a level with faces of `size` texels is computed. The texels of
// such a face show degrees up to twice its size; points between texels are computed to twice that
// degree.
static int most_degree(int size)
{
    return ki_min(ki_max(4 * size, KI_LEAST_DEGREE), KILN_MAX_DEGREE);
}

static kiln_result analyze_lobes(kiln_context *context, ki_tune *t, kiln_error *error)
{
    kiln_result result = KILN_OK;
    ki_nodes *nodes = &t->nodes;
    for (int n = 0; n <= nodes->count && result == KILN_OK; n++) {
        ki_zonal zonal = {.lobe = kiln_lobe_ggx(nodes->roughness[n] * nodes->roughness[n])};
        result = ki_zonal_analyze(context, &zonal, t->tolerance, most_degree(t->size),
                                  &nodes->spectra[n], error);
        t->lobe_degree = ki_max(t->lobe_degree, nodes->spectra[n].degree);
    }
    int finest = 0;
    while (finest < t->level_count - 1 && !nodes->tuned[finest])
        finest++;
    t->degree = ki_min(t->lobe_degree, most_degree(size_at(t, finest)));
    return result;
}

kiln_result ki_tune_create(kiln_context *context, const kiln_prefilter_def *def,
                           const ki_tilt *tilt, const float roughness[KILN_MAX_LEVELS],
                           const ki_reading *reading, ki_tune **tune, kiln_error *error)
{
    ki_tune *t = *tune = ki_alloc(context, 1, sizeof *t);
    if (!t)
        return ki_fail_memory(context, error, "a tuning", sizeof *t);
    t->reading = *reading;
    t->tilt = *tilt;
    t->shape = def->shape;
    t->size = def->size;
    t->smallest = ki_max(1, def->smallest);
    t->level_count = def->level_count;
    t->tolerance = def->tolerance;
    ki_nodes *nodes = &t->nodes;
    ki_nodes_place(nodes, reading->level, t->level_count, t->size);
    int last = t->level_count - 1;
    nodes->roughness[nodes->count] = (double)roughness[last];
    for (int n = 0; n < nodes->count; n++) {
        int i = (int)nodes->level[n];
        nodes->tuned[i] = true;
        if (nodes->level[n] > i)
            nodes->tuned[i + 1] = true;
    }
    t->pinned[0] = !reading->soft;
    t->pinned[last] = t->pinned[last] || reading->keep_last;
    for (int i = 0; i <= last; i++) {
        nodes->tuned[i] = nodes->tuned[i] && !t->pinned[i];
        for (int n = 0; n < nodes->count; n++)
            if (fabs(nodes->roughness[n] - (double)roughness[i]) <
                fabs(nodes->roughness[nodes->nearest[i]] - (double)roughness[i]))
                nodes->nearest[i] = n;
    }
    kiln_result result = analyze_lobes(context, t, error);
    if (result != KILN_OK) {
        ki_tune_destroy(t);
        *tune = NULL;
    }
    return result;
}

void ki_tune_destroy(ki_tune *t)
{
    if (!t)
        return;
    for (int n = 0; n <= t->nodes.count; n++)
        ki_zonal_free(&t->nodes.spectra[n]);
    ki_free(t);
}

int ki_tune_degree(const ki_tune *t)
{
    return t->degree;
}

bool ki_tune_makes(const ki_tune *t, int level)
{
    return t->nodes.tuned[level];
}

// Continues the power without suns beyond the degree `known` of the spectrum, up to which no level
// is computed, but to which the norms of the narrowest lobes and of the mirror reach. Panoramas
// have nearly the same power at all high degrees, as uncorrelated texels have, so that the mean of
// the last TAIL degrees stands for each further one.
static void continue_power(int known, int degree, double (*calm)[3], double (*all)[3])
{
    enum { TAIL = 64 };
    for (int c = 0; c < 3 && known >= TAIL; c++) {
        double mean = 0;
        for (int l = known - TAIL + 1; l <= known; l++)
            mean += calm[l][c] / TAIL;
        for (int l = known + 1; l <= degree; l++) {
            calm[l][c] += mean;
            all[l][c] += mean;
        }
    }
}

static kiln_result choose_mixtures(run *r, kiln_error *error)
{
    int degree = ki_max(r->tune->lobe_degree, r->spectrum->degree);
    size_t count = (size_t)degree + 1;
    r->power = ki_alloc(r->context, 2 * count, sizeof *r->power);
    if (!r->power)
        return ki_fail_memory(r->context, error, "a spectrum's power",
                              2 * count * sizeof *r->power);
    kiln_result result = ki_spectrum_power(r->spectrum, degree, r->power, r->power + count, error);
    if (result == KILN_OK)
        continue_power(r->spectrum->degree, degree, r->power, r->power + count);
    if (result == KILN_OK)
        result = ki_mixtures_find(r->context, &r->tune->nodes, r->spectrum,
                                  (const double(*)[3])r->power, degree, &r->mixtures, error);
    return result;
}

// ------------------------------------------------------------------------------------------ levels

static double power_at(const run *r, int l)
{
    return r->power[l][0] + r->power[l][1] + r->power[l][2];
}

// Makes the filter kernel of a tuned level from its mixture of lobes: the mixture as a function of
// the angle, and its spectrum, cut off at the degree beyond which the error is below the tolerance.
static kiln_result make_kernel(const run *r, int level, ki_zonal *zonal, ki_mixture *mixture,
                               ki_zonal_spectrum *spectrum, kiln_error *error)
{
    const ki_tune *t = r->tune;
    double alphas[KI_MOST_LOBES], weights[KI_MOST_LOBES], integrals[KI_MOST_LOBES];
    int count = 0, degree = ki_tune_degree(t);
    *spectrum = (ki_zonal_spectrum){.integral = 1};
    spectrum->k = ki_alloc(r->context, (size_t)degree + 1, sizeof *spectrum->k);
    if (!spectrum->k)
        return ki_fail_memory(r->context, error, "a level's kernel",
                              (size_t)degree * sizeof *spectrum->k);
    for (int n = 0; n <= t->nodes.count; n++) {
        double weight = r->mixtures.weights[level][n];
        if (weight == 0)
            continue;
        alphas[count] = t->nodes.roughness[n] * t->nodes.roughness[n];
        weights[count] = weight;
        integrals[count++] = t->nodes.spectra[n].integral;
        for (int l = 0; l <= t->nodes.spectra[n].degree && l <= degree; l++)
            spectrum->k[l] += weight * t->nodes.spectra[n].k[l];
    }
    double all = 0, left = 0;
    for (int l = 0; l <= degree; l++)
        all += spectrum->k[l] * spectrum->k[l] * power_at(r, l);
    int l = ki_min(degree, most_degree(size_at(t, level)));
    for (; l > ki_min(degree, KI_LEAST_DEGREE); l--) {
        left += spectrum->k[l] * spectrum->k[l] * power_at(r, l);
        if (r->rehearses || left > t->tolerance * t->tolerance * all)
            break;
    }
    for (int i = 1; i <= degree; i++)
        if (i > l || power_at(r, i) < rounding * power_at(r, 0))
            spectrum->k[i] = 0;
    spectrum->degree = l;
    ki_mixture_create(mixture, alphas, weights, integrals, count);
    // The width of a level's kernel is taken from the narrowest lobe of its mixture whose weight is
    // above 0.01 in absolute value.
    double narrowest = 1;
    for (int n = 0; n < count; n++)
        if (fabs(weights[n]) > 0.01)
            narrowest = fmin(narrowest, alphas[n]);
    *zonal = (ki_zonal){.lobe = kiln_lobe_ggx(narrowest), .mixture = mixture};
    return KILN_OK;
}

// Evaluates the environment filtered by the mixture of `level`, at the texels of level `index` of
// `map`, whose size may differ from that of the level.
static kiln_result make_target(const run *r, int level, kiln_map *map, int index, kiln_error *error)
{
    ki_zonal zonal;
    ki_zonal_spectrum kernel;
    ki_level *plan = NULL;
    ki_level_workspace workspace = {0};
    ki_mixture *mixture = ki_alloc(r->context, 1, sizeof *mixture);
    if (!mixture)
        return ki_fail_memory(r->context, error, "a level's kernel", sizeof *mixture);
    kiln_result result = make_kernel(r, level, &zonal, mixture, &kernel, error);
    if (result == KILN_OK)
        result = ki_level_create(r->context, r->legendre, &zonal, &kernel, r->tune->shape,
                                 kiln_map_level_size(map, index), &r->tune->tilt, &plan, error);
    if (result == KILN_OK)
        result = ki_level_reserve(r->context, plan, &workspace, error);
    if (result == KILN_OK)
        result = ki_level_execute(plan, &workspace, r->spectrum, NULL, r->rotation, map, index,
                                  NULL, error);
    if (result == KILN_OK)
        ki_add_mirror(r->context, &r->mirror, r->mixtures.weights[level][r->tune->nodes.count + 1],
                      map, index);
    ki_level_workspace_free(&workspace);
    ki_level_destroy(plan);
    ki_free(mixture);
    return result;
}

// Returns true if ki_solve_texels computes the texels of `level`, for the least error of bilinear
// reads. `level` may be one beyond the last level, for which the function returns false.
static bool is_read(const ki_tune *t, int level)
{
    if (level >= t->level_count || level >= KILN_MAX_LEVELS)
        return false;
    int size = size_at(t, level);
    bool made = t->nodes.tuned[level] || (level != 0 && t->pinned[level]);
    return made && t->shape == KILN_SHAPE_CUBE && !t->reading.flat && size <= MOST_READS &&
           size > 1;
}

// A cube that is read at the points of the goal: its texels as planes, and where the points lie.
typedef struct read_cube {
    ki_faces faces;
    double *planes;
    ki_face_tap *taps; // [goal's size]
} read_cube;

static kiln_result open_cube(kiln_context *context, const kiln_map *map, int level, int edge,
                             read_cube *cube, kiln_error *error)
{
    kiln_result result =
        ki_faces_create(context, kiln_map_level_size(map, level), &cube->faces, error);
    if (result != KILN_OK)
        return result;
    size_t count = ki_faces_count(&cube->faces);
    cube->planes = ki_alloc(context, count, sizeof *cube->planes);
    cube->taps = ki_alloc_raw(context, (size_t)edge, sizeof *cube->taps);
    if (!cube->planes || !cube->taps)
        return ki_fail_memory(context, error, "a level's error", count * sizeof *cube->planes);
    ki_face_taps_set(&cube->faces, edge, cube->taps);
    ki_faces_load(&cube->faces, map->level[level], cube->planes);
    return KILN_OK;
}

static void close_cube(read_cube *cube)
{
    ki_faces_destroy(&cube->faces);
    ki_free(cube->planes);
    ki_free(cube->taps);
}

typedef struct correction {
    kiln_map *goal;
    // the texels of the next coarser level, and the radiance that they should show
    read_cube shown, wanted;
    double factor;
    double *lines; // [KI_PLANES][room]
    size_t room;   // doubles of the longest row that is read
} correction;

// Task of one thread: subtracts from a channel of a face of the goal the error of the next coarser
// level, times `factor`.
static void correct_plane(void *data, int plane)
{
    correction *a = data;
    int edge = a->goal->size;
    size_t row = 3 * (size_t)edge;
    float *to = a->goal->level[0] + row * (size_t)edge * (size_t)(plane / 3) + plane % 3;
    double *line = a->lines + a->room * (size_t)plane;
    read_cube *const cubes[2] = {&a->shown, &a->wanted};
    for (int y = 0; y < edge; y++, to += row)
        for (int i = 0; i < 2; i++)
            ki_faces_read_row(&cubes[i]->faces,
                              ki_faces_plane(&cubes[i]->faces, cubes[i]->planes, plane), edge,
                              cubes[i]->taps, y, i ? a->factor : -a->factor, line, to);
}

// Subtracts from the goal of a level the error of the next coarser level, for which the finer level
// makes up.
static kiln_result correct_goal(run *r, int level, kiln_map *goal, kiln_error *error)
{
    correction a = {.goal = goal, .factor = r->mixtures.coupling[level]};
    kiln_result result = open_cube(r->context, r->map, level + 1, goal->size, &a.shown, error);
    if (result == KILN_OK)
        result = open_cube(r->context, &r->targets[level + 1], 0, goal->size, &a.wanted, error);
    if (result == KILN_OK) {
        a.room = (size_t)ki_max(a.shown.faces.width, a.wanted.faces.width);
        a.lines = ki_alloc_raw(r->context, KI_PLANES * a.room, sizeof *a.lines);
        if (!a.lines)
            result = ki_fail_memory(r->context, error, "a level's error",
                                    KI_PLANES * a.room * sizeof *a.lines);
    }
    if (result == KILN_OK)
        ki_parallel_for(r->context, KI_PLANES, correct_plane, &a);
    ki_free(a.lines);
    close_cube(&a.shown);
    close_cube(&a.wanted);
    return result;
}

// Makes a level whose texels ki_solve_texels computes, such that bilinear reads of the level come
// nearest to a goal. The goal is the environment filtered by the level's mixture, on a finer grid,
// corrected to make up for the error that the next, coarser level already has. r->targets[level]
// keeps the uncorrected goal for the next finer level.
static kiln_result make_read(run *r, int level, kiln_error *error)
{
    const ki_tune *t = r->tune;
    int size = size_at(t, level);
    kiln_map *target = &r->targets[level], goal;
    *target = (kiln_map){
        .shape = KILN_SHAPE_CUBE, .size = size * (size > COARSE ? 2 : 4), .level_count = 1};
    goal = *target;
    kiln_result result = ki_map_allocate(r->context, target, error);
    if (result == KILN_OK)
        result = make_target(r, level, target, 0, error);
    if (result == KILN_OK)
        result = ki_map_allocate(r->context, &goal, error);
    if (result != KILN_OK)
        return result;
    memcpy(goal.level[0], target->level[0], 3 * kiln_map_texels(target, 0) * sizeof(float));
    if (t->nodes.tuned[level] && is_read(t, level + 1))
        result = correct_goal(r, level, &goal, error);
    if (result == KILN_OK)
        result = ki_solve_texels(r->context, &goal, r->map, level, error);
    kiln_map_free(&goal);
    return result;
}

static kiln_result make_levels(run *r, kiln_error *error)
{
    const ki_tune *t = r->tune;
    r->mirror = (kiln_map){.shape = t->shape, .size = t->size, .level_count = 1};
    while (t->size >> r->mirror.level_count >= t->smallest &&
           r->mirror.level_count < t->level_count)
        r->mirror.level_count++;
    kiln_result result = ki_map_allocate(r->context, &r->mirror, error);
    if (result != KILN_OK)
        return result;
    ki_make_mirrors(r->context, r->map, &r->mirror);
    // Levels are made from coarse to fine, because a fine level can make up for the error of the
    // next coarser one.
    for (int i = t->level_count - 1; i >= 0 && result == KILN_OK; i--) {
        if (is_read(t, i)) {
            result = make_read(r, i, error);
            if (i + 1 < t->level_count)
                kiln_map_free(&r->targets[i + 1]);
        } else if (t->nodes.tuned[i]) {
            result = make_target(r, i, r->map, i, error);
            if (result == KILN_OK)
                result = ki_clear_negative(r->context, r->map, i, error);
        }
    }
    return result;
}

kiln_result ki_tune_execute(const ki_tune *tune, const ki_legendre *legendre,
                            const kiln_spectrum *spectrum, double rotation, bool rehearses,
                            kiln_map *map, kiln_error *error)
{
    run r = {.context = spectrum->context,
             .tune = tune,
             .legendre = legendre,
             .spectrum = spectrum,
             .rotation = rotation,
             .rehearses = rehearses,
             .map = map};
    kiln_result result = choose_mixtures(&r, error);
    if (result == KILN_OK)
        result = make_levels(&r, error);
    for (int i = 0; i < tune->level_count; i++)
        kiln_map_free(&r.targets[i]);
    kiln_map_free(&r.mirror);
    ki_free(r.power);
    return result;
}

size_t ki_tune_suns_size(const ki_tune *t, int source_size, size_t count)
{
    double narrowest = 1;
    for (int n = 0; n <= t->nodes.count; n++)
        narrowest = fmin(narrowest, t->nodes.roughness[n] * t->nodes.roughness[n]);
    const ki_zonal zonal = {.lobe = kiln_lobe_ggx(narrowest)};
    return ki_points_size(&zonal, source_size, count) + ki_block_size(count, 6 * sizeof(double)) +
           ki_suns_power_size(count);
}

// Fits tables of KILN_TABLE_LOBES. In: a complete kiln_table_def. Out: for each roughness and n.v
// the leans, levels and weights of the taps and the six coefficients of bands 0 to 2, laid out as
// docs/tables.md says. Method: a row of medium roughness is fitted first, from n.v = 1 on, then the
// rows above and below follow; each texel starts from its neighbours, so that the table is smooth.
// Sweeps over the texels of a checkerboard's two colours then pull each texel to the mean of its
// neighbours. Texels of one step depend on earlier steps only, whatever the number of threads.
#include "table/lobes.h"

#include "math/math.h"
#include "table/table_axis.h"

#include <math.h>
#include <stdlib.h>

// Strength of the pull of neighbouring texels. With 0.02 and three sweeps the error halfway between
// texels is at most a tenth above the error at texels, as RMS over the table.
static const double pull_strength = 0.02;
enum { SWEEPS = 3 };

typedef struct fill_job {
    kiln_table *table;
    const kiln_table_def *def;
    ki_lobes_chain chain;
    ki_lobes_target *target; // [height][width], as the two arrays below
    ki_lobes_taps *taps;
    double *covariance;    // room for the targets' tables
    ki_lobes_nodes *nodes; // one for each thread
    int step, colour;
    int first[2]; // column and row of the texel that is fitted first
} fill_job;

// ------------------------------------------------------------------------------------------ checks

// Greatest number of texels along a side. Memory grows with width, height and levels.
enum { MOST = 64 };

static kiln_result check_model(const kiln_table_def *def, kiln_error *error)
{
    if (def->model.d != KILN_D_GGX)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "a table of lobes needs the distribution GGX, but d is %d",
                       (int)def->model.d);
    if (def->flip)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "flip is true, a table of lobes begins with roughness 0");
    if (def->axis != KILN_AXIS_LINEAR)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "axis of the table is %d, it must be %d for a table of lobes",
                       (int)def->axis, KILN_AXIS_LINEAR);
    return KILN_OK;
}

// Checks the numbers of taps, levels and texels, and sets the default of the depth, which is one more
// than the number of taps.
static kiln_result check_counts(kiln_table_def *def, kiln_error *error)
{
    if (def->tap_count < 1 || def->tap_count > KILN_MAX_TAPS)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "tap_count is %d, it must be 1 to %d, or 0",
                       def->tap_count, KILN_MAX_TAPS);
    if (def->level_count < 2 || def->level_count > KILN_MAX_LEVELS)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "level_count is %d, it must be 2 to %d, or 0",
                       def->level_count, KILN_MAX_LEVELS);
    if (def->width < 2 || def->width > MOST || def->height < 2 || def->height > MOST)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the table is %d x %d, both must be 2 to %d for a table of lobes",
                       def->width, def->height, MOST);
    def->depth = def->depth ? def->depth : def->tap_count + 1;
    if (def->depth != def->tap_count + 1)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "depth of the table is %d, a table of lobes with %d taps has %d slices",
                       def->depth, def->tap_count, def->tap_count + 1);
    return KILN_OK;
}

static kiln_result check_roughness(const kiln_table_def *def, kiln_error *error)
{
    for (int i = 0; i < def->level_count; i++) {
        double r = (double)def->level_roughness[i];
        if (!(r >= 0) || r > 1 || (i > 0 && !(r > (double)def->level_roughness[i - 1])))
            return ki_fail(error, KILN_ERROR_ARGUMENT,
                           "roughness of level %d is %g, it must be 0 to 1 and increase", i, r);
    }
    return KILN_OK;
}

kiln_result ki_lobes_complete(kiln_table_def *def, kiln_error *error)
{
    def->tap_count = def->tap_count ? def->tap_count : 1;
    def->level_count = def->level_count ? def->level_count : 7;
    def->width = def->width ? def->width : 32;
    def->height = def->height ? def->height : 32;
    def->corners = true;
    def->path_count = 0;
    kiln_result result = check_model(def, error);
    if (!result)
        result = check_counts(def, error);
    bool even = !result;
    for (int i = 0; i < def->level_count && even; i++)
        even = def->level_roughness[i] == 0;
    for (int i = 0; i < def->level_count && even; i++)
        def->level_roughness[i] = (float)i / (float)(def->level_count - 1);
    return result ? result : check_roughness(def, error);
}

// ----------------------------------------------------------------------------------------- targets

static void make_target(void *data, int worker, int index)
{
    fill_job *job = data;
    double nov, roughness, third;
    kiln_table_texel(job->table, index % job->def->width, index / job->def->width, 0, &nov,
                     &roughness, &third);
    ki_lobes_target *target = job->target + index;
    target->covariance =
        job->covariance + (size_t)index * KI_LOBES_ANGLES * (size_t)job->def->level_count;
    ki_lobes_target_make(&job->chain, &job->def->model, roughness, nov, job->nodes + worker,
                         target);
}

// ---------------------------------------------------------------------------------- first solution

static void sort_taps(ki_lobes_taps *t)
{
    for (int i = 1; i < t->count; i++)
        for (int j = i; j > 0 && t->angle[j - 1] > t->angle[j]; j--) {
            double a = t->angle[j], l = t->level[j], w = t->weight[j];
            t->angle[j] = t->angle[j - 1], t->level[j] = t->level[j - 1];
            t->weight[j] = t->weight[j - 1];
            t->angle[j - 1] = a, t->level[j - 1] = l, t->weight[j - 1] = w;
        }
}

// The best of several searches, which begin with taps spread evenly around the lobe's dominant
// direction of Lagarde and de Rousiers 2014.
static void search_freely(const fill_job *job, const ki_lobes_target *target, ki_lobes_taps *taps)
{
    double alpha = target->roughness * target->roughness, least = HUGE_VAL;
    double dominant = ki_lobes_dominant(target->roughness, target->mirror);
    double level = ki_lobes_level(&job->chain, target->roughness);
    for (int trial = 0; trial < 5; trial++) {
        ki_lobes_taps t = {.count = job->def->tap_count};
        double spread = ki_clamp(alpha * (trial + 1) * 0.3, 1e-4, 2);
        for (int i = 0; i < t.count; i++) {
            t.angle[i] = dominant + spread * (i - 0.5 * (t.count - 1));
            t.level[i] = level - 0.4 * (trial % 3);
        }
        double error = ki_lobes_search(&job->chain, target, NULL, &t);
        if (error < least) {
            least = error;
            *taps = t;
        }
    }
    sort_taps(taps);
}

// Sets *pull to the mean of the solutions of `count` texels.
static void mean_of(const fill_job *job, const int *texel, int count, ki_lobes_pull *pull)
{
    *pull = (ki_lobes_pull){.strength = pull_strength};
    for (int n = 0; n < count; n++) {
        const ki_lobes_taps *t = job->taps + texel[n];
        for (int i = 0; i < t->count; i++) {
            pull->lean[i] += (job->target[texel[n]].mirror - t->angle[i]) / count;
            pull->level[i] += t->level[i] / count;
            pull->weight[i] += t->weight[i] / count;
        }
    }
}

// Taps at the leans and levels of a pull.
static ki_lobes_taps taps_at(const ki_lobes_pull *pull, const ki_lobes_target *target, int count)
{
    ki_lobes_taps t = {.count = count};
    for (int i = 0; i < count; i++) {
        t.angle[i] = target->mirror - pull->lean[i];
        t.level[i] = pull->level[i];
    }
    return t;
}

// Fits a texel from its neighbours in the direction of the first texel, which are fitted.
static void fit_first(fill_job *job, int x, int y)
{
    int width = job->def->width, index = y * width + x, near[2], count = 0;
    const ki_lobes_target *target = job->target + index;
    if (x != job->first[0])
        near[count++] = index + (x > job->first[0] ? -1 : 1);
    if (y != job->first[1])
        near[count++] = index + (y > job->first[1] ? -width : width);
    if (!count) {
        search_freely(job, target, job->taps + index);
        return;
    }
    ki_lobes_pull pull;
    mean_of(job, near, count, &pull);
    job->taps[index] = taps_at(&pull, target, job->def->tap_count);
    ki_lobes_search(&job->chain, target, &pull, job->taps + index);
}

// Task of one thread: fits the texels of row y that are job->step steps away from the first texel.
// Such texels do not depend on each other.
static void march(void *data, int y)
{
    fill_job *job = data;
    int across = job->step - abs(y - job->first[1]);
    if (across >= 0 && job->first[0] + across < job->def->width)
        fit_first(job, job->first[0] + across, y);
    if (across > 0 && job->first[0] - across >= 0)
        fit_first(job, job->first[0] - across, y);
}

// ------------------------------------------------------------------------------------------ sweeps

static int neighbours(const kiln_table_def *def, int x, int y, int near[4])
{
    int index = y * def->width + x, count = 0;
    if (x > 0)
        near[count++] = index - 1;
    if (x + 1 < def->width)
        near[count++] = index + 1;
    if (y > 0)
        near[count++] = index - def->width;
    if (y + 1 < def->height)
        near[count++] = index + def->width;
    return count;
}

// Fits a texel again, from its own solution, from each neighbour's and from their mean.
static void smooth(fill_job *job, int x, int y)
{
    int index = y * job->def->width + x, near[4], taps = job->def->tap_count;
    int count = neighbours(job->def, x, y, near);
    const ki_lobes_target *target = job->target + index;
    ki_lobes_pull mean, one;
    mean_of(job, near, count, &mean);
    ki_lobes_taps best = {0};
    double least = HUGE_VAL;
    for (int n = -2; n < count; n++) {
        ki_lobes_taps t = job->taps[index];
        if (n >= 0)
            mean_of(job, near + n, 1, &one);
        if (n >= -1)
            t = taps_at(n < 0 ? &mean : &one, target, taps);
        double error = ki_lobes_search(&job->chain, target, &mean, &t);
        if (error < least) {
            least = error;
            best = t;
        }
    }
    job->taps[index] = best;
}

static void sweep(void *data, int y)
{
    fill_job *job = data;
    for (int x = (y + job->colour) & 1; x < job->def->width; x += 2)
        smooth(job, x, y);
}

// ------------------------------------------------------------------------------------------ texels

// Writes a texel's numbers: the spare fourth numbers of the taps' slices and then the last slice
// hold the six coefficients.
static void write_texel(const fill_job *job, int index)
{
    const ki_lobes_target *target = job->target + index;
    ki_lobes_taps t = job->taps[index];
    size_t slice = (size_t)job->def->width * (size_t)job->def->height * 4;
    float *to = job->table->image.pixels + (size_t)index * 4;
    // The coefficients complement the taps as they are after rounding to floats.
    for (int i = 0; i < t.count; i++, to += slice) {
        to[0] = (float)(target->mirror - t.angle[i]);
        to[1] = (float)t.level[i];
        to[2] = (float)t.weight[i];
        t.angle[i] = target->mirror - (double)to[0];
        t.level[i] = (double)to[1];
        t.weight[i] = (double)to[2];
    }
    ki_lobes_bands rest = ki_lobes_rest(&job->chain, target, &t);
    to = job->table->image.pixels + (size_t)index * 4;
    for (int i = 0; i < t.count; i++)
        to[3 + (size_t)i * slice] = (float)rest.c[i];
    to += (size_t)t.count * slice;
    for (int i = 0; i < 4; i++)
        to[i] = t.count + i < 6 ? (float)rest.c[t.count + i] : 0;
}

// --------------------------------------------------------------------------------------------- fit

static kiln_result reserve(kiln_context *context, fill_job *job, kiln_error *error)
{
    size_t texels = (size_t)job->def->width * (size_t)job->def->height;
    size_t numbers = texels * KI_LOBES_ANGLES * (size_t)job->def->level_count;
    job->target = ki_alloc_raw(context, texels, sizeof *job->target);
    job->taps = ki_alloc_raw(context, texels, sizeof *job->taps);
    job->covariance = ki_alloc_raw(context, numbers, sizeof *job->covariance);
    job->nodes = ki_alloc_raw(context, (size_t)ki_context_threads(context), sizeof *job->nodes);
    if (!job->target || !job->taps || !job->covariance || !job->nodes)
        return ki_fail_memory(context, error, "a table of lobes",
                              numbers * sizeof *job->covariance);
    return KILN_OK;
}

static kiln_result fit(kiln_context *context, fill_job *job, kiln_error *error)
{
    const kiln_table_def *def = job->def;
    if (!ki_progress(context, "table", 0))
        return ki_fail_cancelled(error, "table");
    if (!ki_parallel_workers(context, def->width * def->height, make_target, job))
        return ki_fail_cancelled(error, "table");
    int steps = def->width + def->height;
    double total = steps + 2.0 * SWEEPS * def->height * 0.3;
    for (job->step = 0; job->step < steps; job->step++) {
        if (!ki_progress(context, "table", job->step / total))
            return ki_fail_cancelled(error, "table");
        ki_parallel_for(context, def->height, march, job);
    }
    for (int i = 0; i < 2 * SWEEPS; i++) {
        job->colour = i & 1;
        if (!ki_progress(context, "table", (steps + i * def->height * 0.3) / total))
            return ki_fail_cancelled(error, "table");
        ki_parallel_for(context, def->height, sweep, job);
    }
    return KILN_OK;
}

kiln_result ki_lobes_fill(kiln_context *context, kiln_table *table, kiln_error *error)
{
    const kiln_table_def *def = &table->def;
    fill_job job = {.table = table, .def = def, .first = {def->width / 3, def->height / 2}};
    kiln_result result = ki_lobes_chain_create(context, def, 3, &job.chain, error);
    if (!result)
        result = reserve(context, &job, error);
    if (!result)
        result = fit(context, &job, error);
    for (int i = 0; i < def->width * def->height && !result; i++)
        write_texel(&job, i);
    ki_free(job.nodes);
    ki_free(job.covariance);
    ki_free(job.taps);
    ki_free(job.target);
    ki_lobes_chain_free(&job.chain);
    return result;
}

// The expected error of lookups. In: a table of KILN_TABLE_LOBES, n.v and roughness. Out: the
// expected relative error, under the light for which tables are fitted, of the table's taps and
// coefficients and of the split sum's two lookups of one level. Method: the fit's own covariances
// for degrees 3 and up, and the lobes' moments for degrees 1 and 2.
#include "table/lobes.h"

#include "math/math.h"

#include <math.h>

typedef struct error_job {
    const kiln_table *table;
    const double *nov, *roughness;
    kiln_lobes_error *errors;
    ki_lobes_chain chain;
    ki_lobes_nodes *nodes; // one for each thread
    double *covariance;    // room for one target for each thread
} error_job;

// Reads what a table holds at n.v and roughness.
static void read_table(const kiln_table *table, double nov, double roughness, ki_lobes_taps *taps,
                       ki_lobes_bands *bands)
{
    double values[4 * (KILN_MAX_TAPS + 1)] = {0}, list[KILN_MAX_TAPS + 4];
    int count = table->def.tap_count;
    kiln_table_lookup(table, nov, roughness, 0, values);
    taps->count = count;
    for (int i = 0; i < count; i++) {
        const double *tap = values + 4 * (size_t)i;
        taps->angle[i] = ki_acos(nov) - tap[0];
        taps->level[i] = ki_clamp(tap[1], 0, table->def.level_count - 1);
        taps->weight[i] = tap[2];
        list[i] = tap[3];
    }
    for (int i = 0; i < 4; i++)
        list[count + i] = values[4 * count + i];
    for (int i = 0; i < 5; i++)
        bands->c[i] = list[i];
    bands->c[5] = 1;
    for (int i = 0; i < count; i++)
        bands->c[5] -= taps->weight[i];
}

// Relative error of taps and coefficients, where `norm` is the target's own mean square.
static double relative(const error_job *job, const ki_lobes_target *target, double norm,
                       const ki_lobes_taps *taps, const ki_lobes_bands *bands)
{
    ki_lobes_bands rest = ki_lobes_rest(&job->chain, target, taps);
    for (int i = 0; i < 6; i++)
        rest.c[i] -= bands->c[i];
    double square =
        norm + ki_lobes_taps_error(&job->chain, target, taps) + ki_lobes_bands_square(&rest);
    double whole = norm + ki_lobes_bands_square(&target->bands);
    return square > 0 ? sqrt(square / whole) : 0;
}

static void judge(void *data, int worker, int index)
{
    error_job *job = data;
    double nov = ki_clamp(job->nov[index], 0, 1), r = ki_clamp(job->roughness[index], 0, 1);
    ki_lobes_nodes *nodes = job->nodes + worker;
    ki_lobes_target target = {.covariance = job->covariance + (size_t)worker * KI_LOBES_ANGLES *
                                                                  (size_t)job->chain.level_count};
    ki_lobes_target_make(&job->chain, &job->table->def.model, r, nov, nodes, &target);
    double norm = ki_lobes_target_norm(&job->chain, r, nodes);
    kiln_lobes_error *e = job->errors + index;
    ki_lobes_bands bands = {0};
    ki_lobes_taps t = {.count = 1,
                       .angle = {target.mirror},
                       .level = {ki_lobes_level(&job->chain, r)},
                       .weight = {1}};
    e->straight = relative(job, &target, norm, &t, &bands);
    t.angle[0] = ki_lobes_dominant(r, target.mirror);
    e->bent = relative(job, &target, norm, &t, &bands);
    read_table(job->table, nov, r, &t, &bands);
    e->table = relative(job, &target, norm, &t, &bands);
}

// Fails unless the table is one of lobes, and sets the numbers of its definition that are 0 to
// their defaults.
static kiln_result complete(kiln_table *table, kiln_error *error)
{
    if (table->def.kind != KILN_TABLE_LOBES || !table->image.pixels)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the table's kind is %d, expected errors are those of kind %d",
                       (int)table->def.kind, KILN_TABLE_LOBES);
    return ki_lobes_complete(&table->def, error);
}

kiln_result kiln_lobes_errors(kiln_context *context, const kiln_table *table, const double *nov,
                              const double *roughness, int count, kiln_lobes_error *errors,
                              kiln_error *error)
{
    for (int i = 0; i < count; i++)
        errors[i] = (kiln_lobes_error){0};
    kiln_table whole = *table;
    kiln_result result = complete(&whole, error);
    if (result)
        return result;
    error_job job = {.table = &whole, .nov = nov, .roughness = roughness, .errors = errors};
    size_t threads = (size_t)ki_context_threads(context);
    size_t room = KI_LOBES_ANGLES * (size_t)whole.def.level_count * sizeof *job.covariance;
    result = ki_lobes_chain_create(context, &whole.def, 3, &job.chain, error);
    job.nodes = ki_alloc_raw(context, threads, sizeof *job.nodes);
    job.covariance = ki_alloc_raw(context, threads, room);
    if (!result && (!job.nodes || !job.covariance))
        result = ki_fail_memory(context, error, "expected errors of lookups", threads * room);
    if (!result && !ki_parallel_workers(context, count, judge, &job))
        result = ki_fail_cancelled(error, "table");
    for (int i = 0; i < count && result; i++)
        errors[i] = (kiln_lobes_error){0};
    ki_free(job.covariance);
    ki_free(job.nodes);
    ki_lobes_chain_free(&job.chain);
    return result;
}

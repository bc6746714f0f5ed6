// The points at which closed forms are fitted and measured. In: a kind of integral, a model and an
// axis. Out: points with exact values of the fitted function, and the errors of a form at these
// points. The nodes of a fit are a Chebyshev grid in the arguments x and y of the form's
// polynomials. Errors are measured on regular grids and at random points in (n.v, roughness) and in
// (sqrt t, roughness). t is the function of n.v and roughness that docs/theory/fits.md introduces.
#include "brdf/brdf.h"
#include "brdf/energy.h"
#include "brdf/sheen.h"
#include "math/math.h"
#include "table/fit.h"
#include "table/table_axis.h"

#include <math.h>

// Returns the exact value of a target function of closed forms at this roughness and nov.
static double target_value(const kiln_fit_def *def, ki_fit_target target, double roughness,
                           double nov)
{
    double ab[2];
    switch (target) {
    case KI_FIT_E:
        return ki_energy(&def->model, roughness, nov);
    case KI_FIT_E_AVERAGE:
        return ki_energy_average(&def->model, roughness);
    case KI_FIT_SHEEN:
        return kiln_sheen_albedo(KILN_SHEEN_ASHIKHMIN, roughness, nov);
    default:
        ki_energy_split(&def->model, roughness, nov, ab);
        return ab[1] - (ab[0] + ab[1]) * ki_schlick_fresnel(nov);
    }
}

int ki_fit_targets(kiln_fit_kind kind, ki_fit_target target[2])
{
    target[0] = kind == KILN_FIT_E_AVERAGE ? KI_FIT_E_AVERAGE
                : kind == KILN_FIT_SHEEN   ? KI_FIT_SHEEN
                                           : KI_FIT_E;
    target[1] = KI_FIT_REST;
    return kind == KILN_FIT_DFG ? 2 : 1;
}

// ----------------------------------------------------------------------------------------- filling

enum { CHUNK = 64 };

typedef struct fill_job {
    const kiln_fit_def *def;
    ki_fit_target target;
    const ki_fit_points *points;
} fill_job;

static void fill_chunk(void *data, int index)
{
    const fill_job *job = data;
    const ki_fit_points *points = job->points;
    int end = ki_min(points->count, (index + 1) * CHUNK);
    for (int i = index * CHUNK; i < end; i++)
        points->value[i] =
            target_value(job->def, job->target, points->roughness[i], points->nov[i]);
}

static kiln_result fill(kiln_context *context, const kiln_fit_def *def, ki_fit_target target,
                        const ki_fit_points *points, kiln_error *error)
{
    fill_job job = {def, target, points};
    bool whole =
        ki_parallel_steps(context, NULL, (points->count + CHUNK - 1) / CHUNK, fill_chunk, &job);
    return whole ? KILN_OK : ki_fail_cancelled(error, "fit");
}

static kiln_result allocate(kiln_context *context, int count, ki_fit_points *points,
                            kiln_error *error)
{
    size_t n = (size_t)count;
    double *values = ki_alloc(context, 5 * n, sizeof *values);
    *points = (ki_fit_points){0};
    if (!values)
        return ki_fail_memory(context, error, "fit", 5 * n * sizeof *values);
    *points = (ki_fit_points){.count = count,
                              .x = values,
                              .y = values + count,
                              .nov = values + 2 * n,
                              .roughness = values + 3 * n,
                              .value = values + 4 * n};
    return KILN_OK;
}

void ki_fit_points_free(ki_fit_points *points)
{
    ki_free(points->x);
    *points = (ki_fit_points){0};
}

// Returns the n.v at which the polynomials P and Q of one part of a closed form have the argument x
// in [-1, 1], at this roughness. `axis` says which function of n.v and roughness x is.
static double nov_of(const kiln_fit_def *def, kiln_fit_axis axis, double roughness, double x)
{
    double u = ki_clamp((1 + x) / 2, 0, 1);
    kiln_table_def grazing = {.axis = KILN_AXIS_GRAZING, .model = def->model};
    switch (axis) {
    case KILN_FIT_AXIS_T:
        return ki_axis_to_nov(&grazing, roughness, sqrt(u));
    case KILN_FIT_AXIS_SQRT_T:
        return ki_axis_to_nov(&grazing, roughness, u);
    case KILN_FIT_AXIS_SQRT_NOV:
        return u * u;
    default:
        return u;
    }
}

// Returns the roughness, from def->roughness_min to 1, at which the polynomials P and Q of one part
// of a closed form have the argument y in [-1, 1].
static double roughness_of(const kiln_fit_def *def, double y)
{
    return ki_clamp(def->roughness_min + (1 - def->roughness_min) * (1 + y) / 2, def->roughness_min,
                    1);
}

// Returns point i of the `count` Chebyshev points of the second kind on [-1, 1], in rising order:
// the extrema of a Chebyshev polynomial and the ends of the interval.
static double node(int i, int count)
{
    return count > 1 ? -ki_cos(KI_PI * i / (count - 1)) : 0;
}

kiln_result ki_fit_nodes(kiln_context *context, const kiln_fit_def *def, ki_fit_target target,
                         kiln_fit_axis axis, ki_fit_points *points, kiln_error *error)
{
    int columns = axis == KILN_FIT_AXIS_NONE ? 1 : KI_FIT_GRID, rows = KI_FIT_GRID;
    if (columns == 1)
        rows = 4 * KI_FIT_GRID;
    kiln_result result = allocate(context, rows * columns, points, error);
    if (result)
        return result;
    for (int i = 0; i < points->count; i++) {
        points->x[i] = node(i % columns, columns);
        points->y[i] = node(i / columns, rows);
        // At roughness 0 every argument x < 1 stands for n.v = 0. The node takes the value at a
        // small roughness, which is nearly the limit.
        points->roughness[i] = roughness_of(def, points->y[i]);
        if (points->roughness[i] < KI_GRAZING_MIN)
            points->roughness[i] = KI_GRAZING_MIN;
        points->nov[i] = nov_of(def, axis, points->roughness[i], points->x[i]);
    }
    return fill(context, def, target, points, error);
}

// ---------------------------------------------------------------------------------------- checking

static double uniform(uint64_t *state)
{
    // Knuth's linear congruential generator for MMIX
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return ((double)(*state >> 32) + 0.5) / 4294967296.0;
}

// Errors are measured at four sets of as many points: regular grids over (n.v, roughness) and over
// (sqrt t, roughness), where t is the argument of KILN_FIT_AXIS_T, and uniform random points over
// (n.v, roughness) and over (sqrt t, roughness). n.v and roughness are rounded to floats, because a
// form receives floats.
kiln_result ki_fit_checks(kiln_context *context, const kiln_fit_def *def, ki_fit_target target,
                          ki_fit_points *points, kiln_error *error)
{
    enum { SIDE = 101, LINE = 1001 };
    // E_avg is a function of roughness alone, and needs no grid
    bool line = target == KI_FIT_E_AVERAGE;
    int columns = line ? 1 : SIDE, rows = line ? LINE : SIDE;
    kiln_result result = allocate(context, 4 * columns * rows, points, error);
    if (result)
        return result;
    uint64_t seed = 1;
    for (int i = 0; i < points->count; i++) {
        int k = i / 4, x = k % columns, y = k / columns;
        bool random = i & 1;
        double u = random ? uniform(&seed) : (double)x / ki_max(columns - 1, 1);
        double v = random ? uniform(&seed) : (double)y / (rows - 1);
        double roughness = (double)(float)roughness_of(def, 2 * v - 1);
        kiln_fit_axis axis = i & 2 ? KILN_FIT_AXIS_SQRT_T : KILN_FIT_AXIS_NOV;
        points->roughness[i] = roughness;
        points->nov[i] = (double)(float)nov_of(def, axis, roughness, 2 * u - 1);
    }
    return fill(context, def, target, points, error);
}

double ki_fit_measure_part(const kiln_fit_def *def, const kiln_fit_part *part,
                           const ki_fit_points *points)
{
    double largest = 0;
    for (int i = 0; i < points->count; i++) {
        float nov = (float)points->nov[i], roughness = (float)points->roughness[i];
        double e = fabs((double)ki_fit_evaluate_part(def, part, nov, roughness) - points->value[i]);
        largest = e > largest ? e : largest;
    }
    return largest;
}

void ki_fit_measure(kiln_fit *fit, const ki_fit_points points[2])
{
    double sum = 0, largest = 0;
    int channels = fit->part_count > 1 ? 2 : 1;
    for (int i = 0; i < points->count; i++) {
        double nov = points->nov[i], exact[2] = {points->value[i], 0};
        if (channels == 2) {
            exact[1] = exact[0] * ki_schlick_fresnel(nov) + points[1].value[i];
            exact[0] -= exact[1];
        }
        float values[2] = {0};
        kiln_fit_evaluate(fit, (float)nov, (float)points->roughness[i], values);
        for (int k = 0; k < channels; k++) {
            double e = fabs((double)values[k] - exact[k]);
            largest = e > largest ? e : largest;
            sum += e * e;
        }
    }
    fit->max_error = largest;
    fit->rms_error = sqrt(sum / (channels * points->count));
}

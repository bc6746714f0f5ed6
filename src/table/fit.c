// Searches a closed form with few coefficients for an integral of the reflection model, and
// evaluates it. In: the kind of integral, the model and the wanted error. Out: polynomials P or
// quotients P / Q in x, a function of n.v and roughness, and y, the roughness scaled to [-1, 1].
// The search tries P and Q with more and more coefficients, and takes the first form whose measured
// error is small enough. fit_points.c computes exact values and errors, fit_solve.c the
// coefficients. docs/theory/fits.md describes the method.
#include "table/fit.h"

#include "table/table_axis.h"

#include <math.h>

// ------------------------------------------------------------------------------------------ checks

// Replaces zeros in the definition `def` of a fit by default values, and checks every field.
static kiln_result complete(kiln_fit_def *def, kiln_error *error)
{
    if ((unsigned)def->kind > KILN_FIT_SHEEN)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "the kind of the fit is %d, it must be 0 to %d",
                       (int)def->kind, KILN_FIT_SHEEN);
    if ((unsigned)def->form > KILN_FIT_RATIONAL)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "the form of the fit is %d, it must be 0 to %d",
                       (int)def->form, KILN_FIT_RATIONAL);
    if ((unsigned)def->model.d > KILN_D_BECKMANN || (unsigned)def->model.g > KILN_G_SCHLICK_TEXT)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the model has d %d and g %d, which must be 0 to %d and 0 to %d",
                       (int)def->model.d, (int)def->model.g, KILN_D_BECKMANN, KILN_G_SCHLICK_TEXT);
    def->error = def->error != 0 ? def->error : 1e-3;
    if (!(def->error >= 1e-6 && def->error <= 0.5))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the error of the fit is %g, it must be 1e-06 to 0.5", def->error);
    if (!(def->roughness_min >= 0 && def->roughness_min <= 0.9))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "roughness_min is %g, it must be 0 to 0.9",
                       def->roughness_min);
    if (def->kind == KILN_FIT_SHEEN && def->roughness_min < 0.1)
        def->roughness_min = 0.1;
    def->roughness_min = (double)(float)def->roughness_min;
    def->max_coefficients = def->max_coefficients ? def->max_coefficients : KILN_MAX_FIT;
    if (def->max_coefficients < 1 || def->max_coefficients > KILN_MAX_FIT)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "max_coefficients is %d, it must be 1 to %d",
                       def->max_coefficients, KILN_MAX_FIT);
    return KILN_OK;
}

// ------------------------------------------------------------------------------------------ search

// A closed form that the search tries, P or P / Q: P has x_count * y_count coefficients, and Q has
// as many.
typedef struct candidate {
    kiln_fit_axis axis;
    bool rational;
    int x_count, y_count, coefficients;
} candidate;

enum { AXES = 2, MAX_CANDIDATES = 2 * AXES * KILN_MAX_FIT_TERMS * KILN_MAX_FIT_TERMS };

// Sets axes[] to the functions of n.v (and roughness) that are tried as the argument x of
// polynomials for a target function, and returns their number.
static int axes_of(ki_fit_target target, kiln_fit_axis axes[AXES])
{
    switch (target) {
    case KI_FIT_E_AVERAGE:
        axes[0] = KILN_FIT_AXIS_NONE;
        return 1;
    case KI_FIT_E:
    case KI_FIT_REST:
        axes[0] = KILN_FIT_AXIS_T;
        axes[1] = KILN_FIT_AXIS_SQRT_T;
        return 2;
    default:
        axes[0] = KILN_FIT_AXIS_NOV;
        axes[1] = KILN_FIT_AXIS_SQRT_NOV;
        return 2;
    }
}

// Lists every form P or P / Q that `def` allows for a target function, sorted by the number of
// coefficients. Returns the number of forms.
static int list_candidates(const kiln_fit_def *def, ki_fit_target target, candidate *list)
{
    kiln_fit_axis axes[AXES];
    int axis_count = axes_of(target, axes), count = 0;
    for (int k = 0; k < axis_count * 2; k++) {
        bool rational = k % 2;
        if (def->form && rational != (def->form == KILN_FIT_RATIONAL))
            continue;
        for (int y = 1; y <= KILN_MAX_FIT_TERMS; y++)
            for (int x = 1; x <= KILN_MAX_FIT_TERMS; x++) {
                int coefficients = rational ? 2 * x * y - 1 : x * y;
                if (coefficients > def->max_coefficients || (rational && coefficients == 1) ||
                    (axes[k / 2] == KILN_FIT_AXIS_NONE && x > 1))
                    continue;
                candidate c = {axes[k / 2], rational, x, y, coefficients};
                int at = count++;
                for (; at > 0 && list[at - 1].coefficients > coefficients; at--)
                    list[at] = list[at - 1];
                list[at] = c;
            }
    }
    return count;
}

// State of the search for one part of a fit, a P or P / Q. nodes[i] are the points to which the
// part is fitted if its argument x is the i-th axis that axes_of gives. The part's error is
// measured at `checks`.
typedef struct search {
    ki_fit_points nodes[AXES], checks;
    double *scratch;
    candidate list[MAX_CANDIDATES];
} search;

// Fits one form to the target function. A fit by least squares is cheap and comes first. If its
// error is below `hopeful` times `wanted`, the form is fitted again with ROUNDS rounds of
// reweighting, which lower the greatest error. Sets *reached to the greatest error at the points
// s->checks, or to infinity if the form is given up earlier. Returns true if *reached is at most
// `wanted`.
static bool try_candidate(search *s, const kiln_fit *fit, const candidate *c, double wanted,
                          kiln_fit_part *part, double *reached)
{
    enum { ROUNDS = 40 };
    static const double hopeful = 4;
    const ki_fit_points *nodes =
        &s->nodes[c->axis == KILN_FIT_AXIS_T || c->axis == KILN_FIT_AXIS_NOV ? 0 : 1];
    if (c->axis == KILN_FIT_AXIS_NONE)
        nodes = &s->nodes[0];
    *part = (kiln_fit_part){
        .axis = c->axis, .rational = c->rational, .x_count = c->x_count, .y_count = c->y_count};
    *reached = HUGE_VAL;
    if (!(ki_fit_solve(nodes, 0, wanted, s->scratch, part) < hopeful * wanted))
        return false;
    (void)ki_fit_solve(nodes, ROUNDS, wanted, s->scratch, part);
    if (!ki_fit_positive(part))
        return false;
    *reached = ki_fit_measure_part(&fit->def, part, &s->checks);
    return *reached <= wanted;
}

// Prepares the search of one part: allocates the scratch memory, and the points for fits and for
// measuring errors.
static kiln_result begin(kiln_context *context, const kiln_fit *fit, ki_fit_target target,
                         search *s, kiln_error *error)
{
    kiln_fit_axis axes[AXES];
    int axis_count = axes_of(target, axes);
    size_t count = (size_t)(KI_FIT_GRID * KI_FIT_GRID) * (2 * KILN_MAX_FIT + 4) +
                   (size_t)KILN_MAX_FIT * (KILN_MAX_FIT + 1);
    s->scratch = ki_alloc_raw(context, count, sizeof *s->scratch);
    if (!s->scratch)
        return ki_fail_memory(context, error, "fit", count * sizeof *s->scratch);
    kiln_result result = KILN_OK;
    for (int i = 0; i < axis_count && !result; i++)
        result = ki_fit_nodes(context, &fit->def, target, axes[i], &s->nodes[i], error);
    if (!result)
        result = ki_fit_checks(context, &fit->def, target, &s->checks, error);
    return result;
}

// Finds the form P or P / Q with the fewest coefficients whose error from the target function is at
// most `wanted`. Sets *part to the fit of that form and *reached to the error of the fit.
static kiln_result find_part(kiln_context *context, const kiln_fit *fit, ki_fit_target target,
                             double wanted, search *s, kiln_fit_part *part, double *reached,
                             kiln_error *error)
{
    double best = HUGE_VAL;
    int best_count = 0;
    kiln_result result = begin(context, fit, target, s, error);
    if (result)
        return result;
    int count = list_candidates(&fit->def, target, s->list);
    for (int i = 0; i < count; i++) {
        if (try_candidate(s, fit, &s->list[i], wanted, part, reached))
            return KILN_OK;
        if (*reached < best) {
            best = *reached;
            best_count = s->list[i].coefficients;
        }
        if (!ki_progress(context, "fit", (double)i / count))
            return ki_fail_cancelled(error, "fit");
    }
    if (!best_count)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "no function with up to %d coefficients comes near an error of %g, allow a "
                       "larger error",
                       fit->def.max_coefficients, wanted);
    return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                   "no function with up to %d coefficients has an error of %g or less; the best "
                   "function has an error of %.3g with %d coefficients",
                   fit->def.max_coefficients, wanted, best, best_count);
}

// Searches a closed form for the integral that fit->def describes, and sets the other fields of
// `fit`. Fails with KILN_ERROR_UNSUPPORTED if no form has the wanted error.
static kiln_result make_fit(kiln_context *context, kiln_fit *fit, kiln_error *error)
{
    ki_fit_target target[2];
    fit->part_count = ki_fit_targets(fit->def.kind, target);
    search *s = ki_alloc(context, 2, sizeof *s);
    if (!s)
        return ki_fail_memory(context, error, "fit", 2 * sizeof *s);
    kiln_result result = KILN_OK;
    // the wanted error minus the errors of the fit's parts that have been found
    double left = fit->def.error;
    for (int k = 0; k < fit->part_count && !result; k++) {
        kiln_fit_part *part = &fit->part[k];
        double wanted = k < fit->part_count - 1 ? left / 2 : left, reached = 0;
        result = find_part(context, fit, target[k], wanted, &s[k], part, &reached, error);
        left -= reached;
        fit->coefficient_count +=
            part->x_count * part->y_count * (part->rational ? 2 : 1) - part->rational;
    }
    if (!result)
        ki_fit_measure(fit, (ki_fit_points[2]){s[0].checks, s[1].checks});
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < AXES; i++)
            ki_fit_points_free(&s[k].nodes[i]);
        ki_fit_points_free(&s[k].checks);
        ki_free(s[k].scratch);
    }
    ki_free(s);
    return result;
}

kiln_result kiln_fit_create(kiln_context *context, const kiln_fit_def *def, kiln_fit *fit,
                            kiln_error *error)
{
    *fit = (kiln_fit){.def = def ? *def : (kiln_fit_def){0}};
    kiln_result result = complete(&fit->def, error);
    if (!result)
        result = make_fit(context, fit, error);
    if (result)
        *fit = (kiln_fit){0};
    return result;
}

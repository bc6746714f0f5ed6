// Closed forms of the reflection model's integrals: rational functions fitted toward the least
// largest error. docs/theory/fits.md.
#ifndef KI_FIT_H
#define KI_FIT_H

#include "base/base.h"

#include <kiln/brdf.h>

/// Fills the defaults in and checks every number.
kiln_result ki_fit_complete(kiln_fit_def *def, kiln_error *error);
/// The search, def being complete.
kiln_result ki_fit_make(kiln_context *context, kiln_fit *fit, kiln_error *error);
/// In floats, operation by operation as the written code.
void ki_fit_evaluate(const kiln_fit *fit, float nov, float roughness, float *values);
float ki_fit_evaluate_part(const kiln_fit_def *def, const kiln_fit_part *part, float nov,
                           float roughness);

// ---------------------------------------------------------------------------- inside the search

/// What a part approximates.
typedef enum ki_fit_target {
    KI_FIT_E,
    KI_FIT_E_AVERAGE,
    KI_FIT_REST, ///< B - E (1 - n.v)^5, which is there at grazing views only
    KI_FIT_SHEEN
} ki_fit_target;

/// Parts of a kind, which are as many as its values: 1 or 2.
int ki_fit_targets(kiln_fit_kind kind, ki_fit_target target[2]);

/// Values of a target, at the nodes of the fit, a Chebyshev grid, or where it is checked.
typedef struct ki_fit_points {
    int count;
    double *x, *y; ///< in [-1, 1], of the nodes only
    double *nov, *roughness;
    double *value;
} ki_fit_points;

enum { KI_FIT_GRID = 40 };

kiln_result ki_fit_nodes(kiln_context *context, const kiln_fit_def *def, ki_fit_target target,
                         kiln_fit_axis axis, ki_fit_points *points, kiln_error *error);
kiln_result ki_fit_checks(kiln_context *context, const kiln_fit_def *def, ki_fit_target target,
                          ki_fit_points *points, kiln_error *error);
void ki_fit_points_free(ki_fit_points *points);

/// Largest difference of a part from the points' values.
double ki_fit_measure_part(const kiln_fit_def *def, const kiln_fit_part *part,
                           const ki_fit_points *points);
/// Largest and RMS error of the whole form, from the points' values of its targets.
void ki_fit_measure(kiln_fit *fit, const ki_fit_points points[2]);

/// Fits a part of given axis, form and counts to the nodes, toward the least largest error where
/// `rounds` > 0 and `wanted` seems within reach. `scratch` holds (2 * nodes + KILN_MAX_FIT) *
/// KILN_MAX_FIT + 4 * nodes numbers and KILN_MAX_FIT more. The largest error
/// at the nodes, or infinity where nothing usable comes out.
double ki_fit_solve(const ki_fit_points *nodes, int rounds, double wanted, double *scratch,
                    kiln_fit_part *part);
/// Whether q exceeds 1/100 on the whole square: proven by the mean value theorem on boxes that are
/// halved until each is.
bool ki_fit_positive(const kiln_fit_part *part);

#endif

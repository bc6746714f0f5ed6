// Closed forms of the reflection model's integrals: polynomials and rational functions of n.v and
// roughness, fitted to have a small greatest error. A form (kiln_fit) has one or two parts
// (kiln_fit_part), each one polynomial P or one quotient P / Q. docs/theory/fits.md describes the
// search.
#ifndef KI_FIT_H
#define KI_FIT_H

#include "base/base.h"

#include <kiln/brdf.h>

/// Returns the value of one part, P or P / Q, of a closed form at (nov, roughness). Computes in
/// floats, as kiln_fit_evaluate does.
float ki_fit_evaluate_part(const kiln_fit_def *def, const kiln_fit_part *part, float nov,
                           float roughness);

// ---------------------------------------------------------------------------- inside the search

/// The function that one part of a form (a polynomial P or a quotient P / Q) approximates.
typedef enum ki_fit_target {
    KI_FIT_E,
    KI_FIT_E_AVERAGE,
    /// B - E (1 - n.v)^5 with the albedo E and B of the split sum, which is near 0 except at
    /// grazing views
    KI_FIT_REST,
    KI_FIT_SHEEN
} ki_fit_target;

/// Sets target[] to the functions that the parts of a closed form of this kind approximate. Returns
/// their number, 1 or 2.
int ki_fit_targets(kiln_fit_kind kind, ki_fit_target target[2]);

/// Points (n.v, roughness) and the exact values of a target function there: either the nodes to
/// which one part of a closed form (a polynomial P or a quotient P / Q) is fitted, or the points at
/// which the errors of that part are measured.
typedef struct ki_fit_points {
    int count;
    double *x, *y; ///< arguments x and y of P and Q in [-1, 1]; set at nodes only
    double *nov, *roughness;
    double *value;
} ki_fit_points;

/// Number of points along each side of the grid of nodes to which a closed form is fitted.
enum { KI_FIT_GRID = 40 };

/// Allocates the nodes to which one part of a closed form (a polynomial P or a quotient P / Q) is
/// fitted, and computes the target function's exact values there. The nodes are a Chebyshev grid in
/// the arguments x and y of P and Q, both in [-1, 1]. `axis` says which function of n.v and
/// roughness x is; with KILN_FIT_AXIS_NONE the nodes vary in y alone. y is linear in the roughness:
/// -1 at def->roughness_min, 1 at roughness 1.
kiln_result ki_fit_nodes(kiln_context *context, const kiln_fit_def *def, ki_fit_target target,
                         kiln_fit_axis axis, ki_fit_points *points, kiln_error *error);
/// Allocates the points at which the errors of one part of a closed form (a polynomial P or a
/// quotient P / Q) are measured, and computes the target function's exact values there.
kiln_result ki_fit_checks(kiln_context *context, const kiln_fit_def *def, ki_fit_target target,
                          ki_fit_points *points, kiln_error *error);
void ki_fit_points_free(ki_fit_points *points);

/// Returns the greatest absolute difference between the values of one part of a closed form (a
/// polynomial P or a quotient P / Q) and the exact values at `points`.
double ki_fit_measure_part(const kiln_fit_def *def, const kiln_fit_part *part,
                           const ki_fit_points *points);
/// Sets the greatest and the RMS error of a closed form. points[k] has the exact values of the
/// function that part k of the form approximates.
void ki_fit_measure(kiln_fit *fit, const ki_fit_points points[2]);

/// Computes the coefficients of one part of a closed form (a polynomial P or a quotient P / Q) so
/// that the part approximates the values at the nodes. The part's axis, form and numbers of
/// coefficients are set by the caller. With rounds = 0 the fit is by least squares. Each further
/// round reweights the nodes to lower the greatest error; rounds stop early if the error `wanted`
/// is out of reach. `scratch` has room for (2 * nodes->count + KILN_MAX_FIT) * KILN_MAX_FIT + 4 *
/// nodes->count + KILN_MAX_FIT doubles. Returns the greatest error at the nodes, or infinity if no
/// round could be solved.
double ki_fit_solve(const ki_fit_points *nodes, int rounds, double wanted, double *scratch,
                    kiln_fit_part *part);
/// Returns true if the denominator Q of the part is proven to exceed 1/100 for all x and y in [-1,
/// 1], so that the part has no pole. The proof applies the mean value theorem to boxes, and divides
/// a box until the theorem suffices.
bool ki_fit_positive(const kiln_fit_part *part);

#endif

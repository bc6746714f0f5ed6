// The recurrence of the associated Legendre functions, and the latitude rings on which the
// functions are evaluated.
#ifndef KI_LEGENDRE_H
#define KI_LEGENDRE_H

#include "base/base.h"

/// Coefficients of the recurrence for all orders m up to a degree. P_lm, orthonormal over the
/// sphere and without the Condon-Shortley sign, is scale_lm q_lm with
///     q_lm = 2 x q_{l-1,m} - f_lm q_{l-2,m},   q_mm = sin^m theta,   x = cos theta.
///
/// Only the functions with even l - m are computed. Two steps of the recurrence make one:
///     q_{l+2} = (4 x^2 - f_{l+1} - f_{l+2}) q_l - f_l f_{l+1} q_{l-2}.
/// A sum of the functions with odd l - m is 2 x times a sum of those with even l - m, which has other
/// coefficients (ki_legendre_join_odd). That takes four operations for every two degrees in place of
/// six, and each step waits for the one before half as often.
typedef struct ki_legendre {
    int degree;
    // Entry l - m of the row of order m is f_{l+1} + f_{l+2} if l - m is even, and f_{l-1} f_l if it
    // is odd: two entries for every step.
    double *steps;
    double *scale;
} ki_legendre;

/// Number of unused entries after the last degree in each order's row of coefficients. The kernels
/// handle several degrees at once, and may read these entries beyond the last degree.
enum { KI_LEGENDRE_PADDING = 8 };

/// Fills the rows f and scale of order m: degrees m to `degree`, and the padding. *start, which
/// receives the scale of degree m, holds that of the order m - 1 before, unless m is 0.
void ki_legendre_order(int degree, int m, double *start, double *f, double *scale);
/// Fills the row `steps` of order m from the row f, as ki_legendre has it.
void ki_legendre_steps(int degree, int m, const double *f, double *steps);
bool ki_legendre_create(kiln_context *context, int degree, ki_legendre *legendre);
void ki_legendre_destroy(ki_legendre *legendre);

/// Replaces the coefficients b_l of the functions q_l with odd l - m by coefficients d_l, so that
///     sum_l b_l q_l = 2 x sum_l d_l q_{l-1}   over the l <= degree with odd l - m.
/// `row` holds six numbers for every degree from m on. Those with even l - m stay as they are.
void ki_legendre_join_odd(int degree, int m, double *row);
/// The transpose of ki_legendre_join_odd: replaces the sums of 2 x q_{l-1} times some data by the sums
/// of q_l times the same data, for the l <= degree with odd l - m.
void ki_legendre_part_odd(int degree, int m, double *row);
/// Returns the index in `steps` and `scale` at which the row of order m begins. The row holds the
/// degrees l = m .. degree and eight entries of padding.
size_t ki_legendre_row(const ki_legendre *legendre, int m);

/// Pairs of latitude rings that are mirror images at the equator, in vectors of eight lanes: lane j
/// of vector g holds pair 8 g + j.
typedef struct ki_rings {
    int pair_count, vector_count, degree;
    double *twice_cos; // 2 cos theta of the northern latitude ring of each pair, [vector][lane]
    double *start;     // sin^m theta of the rings for each order m, [m][vector][lane]
    // The first vector of rings that contributes to each order m, [degree + 1]. P_lm is negligible
    // on the rings of the vectors before, which are nearer to the poles.
    int *first;
    // Number of functions with even l - m at the beginning of each order m that are negligible on all
    // rings of a vector, rounded down to an even number, [m][vector].
    int *skip;
} ki_rings;

/// Creates pairs of latitude rings at the given increasing theta, each at most pi / 2. The last
/// pair is repeated until the number of vectors is even. Returns false when memory runs out.
bool ki_rings_create(kiln_context *context, const double *theta, int pair_count, int degree,
                     ki_rings *rings);

/// By how much the number of rings of a grid exceeds the degree, in eighths of the degree. It
/// decides how well the harmonics of the highest degrees are interpolated between the rings. At a
/// quarter, a half and the whole of degree 412, the interpolation errs by 1e-4, 2e-3 and a half of
/// the wave with few rings, and by 1e-5, 3e-4 and a twelfth with many.
typedef enum ki_ring_excess {
    /// for the synthesis of a filtered spectrum, whose highest degrees the lobe has made small
    KI_FEW_RINGS = 1,
    KI_MANY_RINGS = 4, ///< for the analysis of a panorama, whose degrees are all large
} ki_ring_excess;

/// Creates pairs of latitude rings at equal steps: the northern ring of pair k lies at
/// theta = (k + 1/2) pi / (2 pair_count) from the pole. Returns false when memory runs out.
bool ki_rings_create_grid(kiln_context *context, int degree, ki_ring_excess excess,
                          ki_rings *rings);
void ki_rings_destroy(ki_rings *rings);

/// Returns the index of the row of order m in an array of spherical-harmonic coefficients a_lm. The
/// row holds l = m .. degree, six doubles for each degree (real and imaginary part of r, g, b), and
/// is padded to an even number of degrees.
size_t ki_coefficient_row(int degree, int m);
/// Returns the number of doubles in an array of spherical-harmonic coefficients a_lm up to
/// `degree`.
size_t ki_coefficient_count(int degree);

#endif

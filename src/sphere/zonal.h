// The spectra of lobes.
#ifndef KI_ZONAL_H
#define KI_ZONAL_H

#include "sphere/mixture.h"

/// A lobe, whole or without its centre: the weight is multiplied by a smooth step that is 0 below
/// `inner` and 1 above `outer` radians. Both 0: the whole lobe.
typedef struct ki_zonal {
    kiln_lobe lobe;
    const ki_mixture
        *mixture; ///< or NULL: this is the weight, and the lobe's width the narrowest's
    double inner, outer;
} ki_zonal;

/// The weight at 1 - cos theta, see ki_lobe_weight.
double ki_zonal_weight(const ki_zonal *zonal, double one_minus_cos);
/// The step alone.
double ki_zonal_step(const ki_zonal *zonal, double one_minus_cos);

typedef struct ki_zonal_spectrum {
    double integral; // of the whole lobe's weight over the sphere
    int degree;      // where the rest is below the tolerance, or the limit
    double rest;     // relative L2 norm of what lies beyond `degree`
    double *k;       // [limit + 1], k_l / integral of the whole lobe; 0 beyond `degree`
} ki_zonal_spectrum;

/// Degrees that cost next to nothing: all of them are used.
enum { KI_LEAST_DEGREE = 80 };

/// k_l = 2 pi integral of weight(theta) P_l(cos theta) d cos theta up to the degree beyond which
/// less than `tolerance` of the L2 norm is left (the error, relative to the result, for a single
/// bright point), at most `limit`, at least
/// KI_LEAST_DEGREE where `limit` allows.
kiln_result ki_zonal_analyze(kiln_context *context, const ki_zonal *zonal, double tolerance,
                             int limit, ki_zonal_spectrum *spectrum, kiln_error *error);
void ki_zonal_free(ki_zonal_spectrum *spectrum);

/// What a level leaves out by stopping at a degree, as part of the L2 norm for a lone bright point.
/// Bright points are kept out of the spectrum (spectrum.h), so the error of a real environment is a
/// small fraction of it.
extern const double ki_lobe_tolerance;

/// A lobe's spectrum, up to a degree that its width suggests; the whole lobe's. Where KILN_MAX_DEGREE
/// does not suffice and `split` is true, the part of the lobe around its centre is left out.
kiln_result ki_lobe_spectrum(kiln_context *context, const kiln_lobe *lobe, double tolerance,
                             bool split, ki_zonal *zonal, ki_zonal_spectrum *spectrum,
                             kiln_error *error);

#endif

// The Legendre coefficients of lobes.
#ifndef KI_ZONAL_H
#define KI_ZONAL_H

#include "sphere/mixture.h"

/// A lobe, whole or with its centre left out: the weight is multiplied by a smooth step that is 0
/// below `inner` and 1 above `outer` (radians). If both are 0, the lobe is whole.
typedef struct ki_zonal {
    kiln_lobe lobe;
    /// NULL, or a mixture of lobes whose weight is used in place of the weight of `lobe`. `lobe` is
    /// then the narrowest lobe of the mixture.
    const ki_mixture *mixture;
    double inner, outer;
} ki_zonal;

/// Returns the weight of the lobe times the step that leaves out the lobe's centre, at 1 - cos
/// theta. See ki_lobe_weight.
double ki_zonal_weight(const ki_zonal *zonal, double one_minus_cos);
/// Returns the value at 1 - cos theta of the step that leaves out the lobe's centre.
double ki_zonal_step(const ki_zonal *zonal, double one_minus_cos);

typedef struct ki_zonal_spectrum {
    // integral over the sphere of the weight of the whole lobe, whose centre is not left out
    double integral;
    // Degree at which the coefficients are cut off: the degree at which the tolerance is met, or
    // the greatest allowed degree.
    int degree;
    double
        truncation; // L2 norm of the coefficients above `degree`, relative to the L2 norm of the lobe
    // Legendre coefficients k_l / integral, [limit + 1]; 0 beyond `degree`.
    double *k;
} ki_zonal_spectrum;

/// Degrees that cost next to nothing: no lobe's spectrum is cut off below this degree.
enum { KI_LEAST_DEGREE = 80 };

/// Computes k_l = 2 pi integral of weight(theta) P_l(cos theta) d cos theta up to the degree above
/// which the coefficients have less than `tolerance` of the L2 norm. That share is the relative
/// error for a single bright point. The degree is at most `limit`, and at least KI_LEAST_DEGREE
/// where `limit` allows.
kiln_result ki_zonal_analyze(kiln_context *context, const ki_zonal *zonal, double tolerance,
                             int limit, ki_zonal_spectrum *spectrum, kiln_error *error);
void ki_zonal_free(ki_zonal_spectrum *spectrum);

/// Default tolerance: the share of the L2 norm, for a lone bright point, that a level loses when
/// its harmonics are cut off. Bright texels are kept out of the spectrum (spectrum.h), so the error
/// of a real environment is a small fraction of the tolerance.
extern const double ki_lobe_tolerance;

/// Computes the spectrum of a lobe up to a degree that its width suggests. If KILN_MAX_DEGREE is
/// too low for the tolerance and `split` is true, the centre of the lobe is left out of the
/// spectrum and *zonal says so.
kiln_result ki_lobe_spectrum(kiln_context *context, const kiln_lobe *lobe, double tolerance,
                             bool split, ki_zonal *zonal, ki_zonal_spectrum *spectrum,
                             kiln_error *error);

#endif

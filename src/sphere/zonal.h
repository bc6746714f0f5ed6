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

/// Returns the weight of the lobe (ki_lobe_weight) times the step that leaves out the lobe's
/// centre, at the angle theta from the lobe's axis.
double ki_zonal_weight(const ki_zonal *zonal, double one_minus_cos);
/// Returns the step that leaves out the lobe's centre, from 0 to 1, at the angle theta from the
/// lobe's axis.
double ki_zonal_step(const ki_zonal *zonal, double one_minus_cos);

typedef struct ki_zonal_spectrum {
    // integral over the sphere of the weight of the whole lobe, even if its centre is left out of
    // `k`
    double integral;
    // Degree at which the coefficients are cut off: the degree at which the tolerance is met, or
    // the greatest allowed degree.
    int degree;
    double
        // L2 norm of the coefficients above `degree`, relative to the L2 norm of the lobe.
        truncation;
    // Legendre coefficients k_l divided by `integral`, for l = 0 up to the greatest allowed degree;
    // 0 beyond `degree`.
    double *k;
} ki_zonal_spectrum;

/// No lobe's spectrum is cut off below this degree, because the degrees up to it cost next to
/// nothing.
enum { KI_LEAST_DEGREE = 80 };

/// Computes the Legendre coefficients k_l = 2 pi integral of weight(theta) P_l(cos theta) d cos
/// theta of a lobe, up to the degree above which the coefficients have less than `tolerance` of the
/// lobe's L2 norm. That share is the relative error for a single bright point. The degree is at
/// most `limit`, and at least KI_LEAST_DEGREE where `limit` allows.
kiln_result ki_zonal_analyze(kiln_context *context, const ki_zonal *zonal, double tolerance,
                             int limit, ki_zonal_spectrum *spectrum, kiln_error *error);
void ki_zonal_free(ki_zonal_spectrum *spectrum);

/// Default tolerance of a lobe's spectrum: the share of the lobe's L2 norm that may lie in the
/// degrees that are cut off. It is the relative error of a level for a lone bright point. Bright
/// texels are kept out of the spectrum (spectrum.h), so the error of a real environment is a small
/// fraction of the tolerance.
extern const double ki_lobe_tolerance;

/// Computes the spectrum of a lobe up to a degree that its width suggests. If KILN_MAX_DEGREE is
/// too low for the tolerance and `split` is true, the centre of the lobe is left out of the
/// spectrum and *zonal says so.
kiln_result ki_lobe_spectrum(kiln_context *context, const kiln_lobe *lobe, double tolerance,
                             bool split, ki_zonal *zonal, ki_zonal_spectrum *spectrum,
                             kiln_error *error);

#endif

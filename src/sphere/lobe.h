// Zonal kernels and their spectra.
#ifndef KI_LOBE_H
#define KI_LOBE_H

#include "base/base.h"

/// The lobe's weight, up to its scale. `one_minus_cos` is 1 - cos theta in [0, 2], which the caller
/// knows better than cos theta itself where theta is small.
double ki_lobe_weight(const kiln_lobe *lobe, double one_minus_cos);
/// The same from cos theta in [-1, 1].
double ki_lobe_evaluate(const kiln_lobe *lobe, double cos_theta);
/// Fails with a sentence where the lobe's numbers are out of range.
kiln_result ki_lobe_check(const kiln_lobe *lobe, kiln_error *error);
/// The angle in radians over which the lobe changes most, in (0, pi].
double ki_lobe_width(const kiln_lobe *lobe);

#endif

// Zonal kernels: the weights of lobes, their checks and their widths.
#ifndef KI_LOBE_H
#define KI_LOBE_H

#include "base/base.h"

/// Returns the lobe's weight, up to a constant factor, at the angle theta from its axis.
/// `one_minus_cos` is 1 - cos theta in [0, 2]: for small theta the caller knows that difference
/// with more digits than cos theta itself.
double ki_lobe_weight(const kiln_lobe *lobe, double one_minus_cos);
/// Returns the lobe's weight at the angle theta from its axis, up to the same constant factor as
/// ki_lobe_weight. cos theta is in [-1, 1].
double ki_lobe_evaluate(const kiln_lobe *lobe, double cos_theta);
/// Fails with an error message if the parameter of the lobe is out of its range.
kiln_result ki_lobe_check(const kiln_lobe *lobe, kiln_error *error);
/// Returns the angle in radians, in (0, pi], over which the lobe changes most.
double ki_lobe_width(const kiln_lobe *lobe);

#endif

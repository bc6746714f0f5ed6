// Interpolation with eight weights ("taps") between the points of a regular grid. The analysis of a
// panorama uses the transposed operation to distribute rows onto latitude rings.
#ifndef KI_GRID_H
#define KI_GRID_H

#include "sphere/kernels.h"

/// Computes the eight weights for fractions 0 .. 1 of the way between two grid points that are
/// `step` radians apart. Weight i belongs to the point i - 3 steps from the left one. The weights
/// are least-squares optimal for functions whose squared amplitude at angular frequency l is
/// density[l], l = 0 .. degree. They sum to 1, so that constants are reproduced. Writes
/// KI_TAP_TABLE doubles to `taps`.
void ki_taps_design(double step, const double *density, int degree, double *taps);

/// Sets `density` for ki_taps_design to a model of a filtered environment: the environment's power
/// falls like 1 / l^2, as that of photographs does, and the lobe is the narrowest GGX lobe that
/// `degree` can represent.
void ki_model_density(int degree, double *density);

/// Interpolates the eight weights at a fraction in [0, 1] from the table that ki_taps_design wrote.
void ki_taps_at(const double *taps, double fraction, double weights[KI_TAPS]);

#endif

// Interpolation with eight weights ("taps") between the points of a regular grid. The analysis of a
// panorama uses the transposed operation to distribute rows onto latitude rings.
#ifndef KI_GRID_H
#define KI_GRID_H

#include "sphere/kernels.h"

/// Computes the weights that interpolate between two neighbouring grid points, `step` radians
/// apart. The table has eight weights for each fraction n / KI_TAP_STEPS of the way from the left
/// point to the right one, n = 0 .. KI_TAP_STEPS. Weight i belongs to the grid point i - 3 steps to
/// the right of the left point. The weights are least-squares optimal for functions whose squared
/// amplitude at angular frequency l is density[l], l = 0 .. degree. They sum to 1, so that
/// constants are reproduced. Writes KI_TAP_TABLE doubles to `taps`.
void ki_taps_design(double step, const double *density, int degree, double *taps);

/// Sets density[l] for ki_taps_design, l = 0 .. degree, to the power at degree l of a typical
/// filtered environment: the power of the unfiltered environment times the squared Legendre
/// coefficient of the lobe. The squared coefficients a_lm of the environment are taken to fall like
/// 1 / l^2, as those of photographs do, and the lobe to be the narrowest GGX lobe that `degree` can
/// represent.
void ki_model_density(int degree, double *density);

/// Interpolates the eight weights for a position between two grid points, at a fraction in [0, 1]
/// of the way, linearly between two entries of the table that ki_taps_design wrote.
void ki_taps_at(const double *taps, double fraction, double weights[KI_TAPS]);

#endif

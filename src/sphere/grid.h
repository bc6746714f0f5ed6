// Interpolation on a grid of equal steps, and its transpose.
#ifndef KI_GRID_H
#define KI_GRID_H

#include "sphere/kernels.h"

/// Eight taps for fractions 0 .. 1 between two points of a grid with `step` radians between points:
/// tap i weighs the point i - 3 steps from the left one. Least squares for functions whose squared
/// amplitude at angular frequency l is density[l], l = 0 .. degree; they sum to 1, so that a constant
/// stays one. Writes KI_TAP_TABLE doubles.
void ki_taps_design(double step, const double *density, int degree, double *taps);

/// A density for environments whose power falls like 1 / l^2, as real ones do, about to be filtered
/// by a lobe that just fits into the degree.
void ki_model_density(int degree, double *density);

/// The taps at a fraction in [0, 1], from the table.
void ki_taps_at(const double *taps, double fraction, double weights[KI_TAPS]);

#endif

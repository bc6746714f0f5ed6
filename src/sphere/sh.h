// The first bands of spherical harmonics, in the basis of kiln_sh.
#ifndef KI_SH_H
#define KI_SH_H

#include "image/image.h"
#include "sphere/spectrum.h"

/// Computes the 25 basis functions of kiln_sh in a unit direction.
void ki_sh_basis(const double direction[3], double y[KILN_MAX_BANDS * KILN_MAX_BANDS]);
/// Fails unless the arguments are in the ranges that kiln_spectrum_sh states.
kiln_result ki_sh_check_bands(int bands, double window, double rotation, kiln_error *error);
/// Computes the coefficients of the spectrum's radiance in the first `bands` bands of kiln_sh,
/// after a turn by `tilt`, which may be NULL, and then by `rotation` degrees about +Y.
kiln_result ki_sh_project(const kiln_spectrum *spectrum, int bands, const ki_tilt *tilt,
                          double rotation, kiln_sh *sh, kiln_error *error);

#endif

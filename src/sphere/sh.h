// The first bands, as engines want them.
#ifndef KI_SH_H
#define KI_SH_H

#include "sphere/spectrum.h"

/// The 25 basis functions in a unit direction; see kiln_sh.
void ki_sh_basis(const double direction[3], double y[KILN_MAX_BANDS * KILN_MAX_BANDS]);
/// Fails unless the numbers are in the ranges that kiln_spectrum_sh states.
kiln_result ki_sh_check_bands(int bands, double window, double rotation, kiln_error *error);
/// The first bands of the radiance, in the world's directions.
kiln_result ki_sh_project(const kiln_spectrum *spectrum, int bands, double rotation, kiln_sh *sh,
                          kiln_error *error);

/// Sum over m of |a_lm|^2 by channel, degrees 0 to the spectrum's: of the suns too, or without them.
kiln_result ki_spectrum_power(const kiln_spectrum *spectrum, bool suns, double (*power)[3],
                              kiln_error *error);

#endif

// Spherical harmonics as Filament's cmgen writes them: the nine factors of 1, y, z, x, xy, yz, 3z^2
// - 1, zx and x^2 - y^2, whose sum is irradiance / pi.
#ifndef KI_FILAMENT_SH_H
#define KI_FILAMENT_SH_H

#include "base/bytes.h"

/// Computes Filament's nine factors of red, green and blue from three bands of radiance.
void ki_filament_sh_factors(const kiln_sh *sh, double factors[9][3]);
/// Writes Filament's nine factors, computed from three bands of radiance. `lines` true: one line
/// for each factor with its name, as in Filament's sh.txt; false: the numbers alone, as in KTX
/// files.
void ki_filament_sh_write(ki_writer *writer, const kiln_sh *sh, bool lines);
/// Stores Filament's nine factors in `info` as harmonics of radiance.
void ki_filament_sh_store(double factors[9][3], kiln_file_info *info);
/// Reads Filament's nine factors from text that ends in NUL, with or without their names, and
/// stores them in `info` as harmonics of radiance. Returns false if the text has another form.
bool ki_filament_sh_read(const char *text, kiln_file_info *info);

#endif

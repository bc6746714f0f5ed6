// Spherical harmonics as Filament's cmgen writes them: nine factors to 1, y, z, x, xy, yz, 3z^2 - 1, zx
// and x^2 - y^2, whose sum is irradiance / pi.
#ifndef KI_FILAMENT_SH_H
#define KI_FILAMENT_SH_H

#include "base/bytes.h"

/// From three bands of radiance. `lines`: as in sh.txt, with the names of the factors; else numbers alone,
/// as in KTX.
void ki_filament_sh_write(ki_writer *writer, const kiln_sh *sh, bool lines);
/// Takes either text, which ends in NUL, as radiance; false where it is none.
bool ki_filament_sh_read(const char *text, kiln_file_info *info);

#endif

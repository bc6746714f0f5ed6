// Spherical harmonics as CesiumJS takes them: a JSON array of nine arrays of red, green and blue.
#ifndef KI_CESIUM_SH_H
#define KI_CESIUM_SH_H

#include "base/bytes.h"

/// Writes the nine coefficients for sphericalHarmonicCoefficients, computed from three bands of
/// radiance. They are Filament's factors (filament_sh.h).
void ki_cesium_sh_write(ki_writer *writer, const kiln_sh *sh);
/// Returns whether bytes begin like a JSON array of arrays.
bool ki_cesium_sh_begins(const uint8_t *bytes, size_t size);
/// Describes the file as harmonics of radiance. Fails unless the file holds nine coefficients.
kiln_result ki_cesium_sh_describe(kiln_context *context, const uint8_t *bytes, size_t size,
                                  const char *name, kiln_file_info *info, kiln_error *error);

#endif

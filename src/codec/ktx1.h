// KTX version 1 files: written in the form that Filament reads, and read in the usual forms.
#ifndef KI_KTX1_H
#define KI_KTX1_H

#include "codec/codec.h"

/// Appends a KTX 1 file with a cube as RGBA16F or B10G11R11 and the name of the engine that reads
/// the file. `sh`, radiance in spherical harmonics, may be NULL and is stored as Filament's nine
/// factors.
kiln_result ki_ktx1_encode(const kiln_map *map, const kiln_sh *sh, const char *engine,
                           kiln_format format, ki_writer *writer, kiln_error *error);
/// Decodes all levels of a cube, or level 0 of a picture. `decoded` may be NULL, `info` must not
/// be.
kiln_result ki_ktx1_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                           const char *name, ki_decoded *decoded, kiln_file_info *info,
                           kiln_error *error);

#endif

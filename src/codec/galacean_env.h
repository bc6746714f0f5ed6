// Galacean Engine's .env files.
#ifndef KI_GALACEAN_ENV_H
#define KI_GALACEAN_ENV_H

#include "codec/codec.h"

/// The largest radiance of a texel, which is stored as four bytes: 5 a c, with a and c in [0, 1].
enum { KI_GALACEAN_MAX = 5 };

/// Appends a .env file with a cube, which has all levels down to a single texel, and the first
/// three bands of its radiance in spherical harmonics.
kiln_result ki_galacean_env_encode(const kiln_map *map, const kiln_sh *sh, ki_writer *writer,
                                   kiln_error *error);
/// Returns whether bytes have exactly the length of a .env file of the size that they state.
bool ki_galacean_env_begins(const uint8_t *bytes, size_t size);
kiln_result ki_galacean_env_describe(kiln_context *context, const uint8_t *bytes, size_t size,
                                     const char *name, kiln_file_info *info, kiln_error *error);
/// Decodes all levels of a file that ki_galacean_env_begins accepts, in the axes of the file.
kiln_result ki_galacean_env_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                                   kiln_map *map, kiln_error *error);

#endif

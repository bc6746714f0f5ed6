// Babylon.js' .env files.
#ifndef KI_ENV_H
#define KI_ENV_H

#include "codec/codec.h"

/// Returns the roughness of a level of a cube. Babylon.js reads level log2(size (r^2 + 0.0005))
/// lod_scale at roughness r, with `size` the texels along an edge of level 0.
double ki_env_roughness(int level, double lod_scale, int size);
/// Appends a .env file with a cube, which has all levels down to a single texel, and the first
/// three bands of its radiance in spherical harmonics.
kiln_result ki_env_encode(const kiln_map *map, double lod_scale, const kiln_sh *sh,
                          ki_writer *writer, kiln_error *error);
kiln_result ki_env_describe(kiln_context *context, const uint8_t *bytes, size_t size,
                            const char *name, kiln_file_info *info, kiln_error *error);

/// Returns whether bytes begin like an .env file of Babylon.js.
bool ki_env_begins(const uint8_t *bytes, size_t size);
/// Decodes all levels of an .env file whose images are PNG files, in the axes of the file.
kiln_result ki_env_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, kiln_map *map, kiln_error *error);

#endif

// glTF with a light of EXT_lights_image_based.
#ifndef KI_GLTF_H
#define KI_GLTF_H

#include "codec/codec.h"

/// A cube whose level k of n holds roughness k / (n - 1), as binary glTF with a scene that has nothing
/// but this light, and the first three bands of radiance.
kiln_result ki_gltf_encode(const kiln_map *map, const kiln_sh *sh, ki_writer *writer,
                           kiln_error *error);
/// The first light of such a file.
kiln_result ki_gltf_describe(const uint8_t *bytes, size_t size, const char *name,
                             kiln_file_info *info, kiln_error *error);

#endif

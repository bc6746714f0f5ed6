// glTF with a light of EXT_lights_image_based.
#ifndef KI_GLTF_H
#define KI_GLTF_H

#include "codec/codec.h"

/// A cube whose level k of n holds roughness k / (n - 1), as binary glTF with a scene that has nothing
/// but this light. `irradiance` is in the order of kiln_sh, in the signs of the file.
kiln_result ki_gltf_encode(const kiln_map *map, double irradiance[9][3], ki_writer *writer,
                           kiln_error *error);

#endif

// Binary glTF with a light of the extension EXT_lights_image_based.
#ifndef KI_GLTF_H
#define KI_GLTF_H

#include "codec/codec.h"

/// Appends a binary glTF file whose scene has nothing but light: a cube whose level k of n has
/// roughness k / (n - 1), the first three bands of radiance, and a directional light of the
/// extension KHR_lights_punctual for each of `lights`, which may be NULL.
kiln_result ki_gltf_encode(const kiln_map *map, const kiln_sh *sh, const kiln_lights *lights,
                           ki_writer *writer, kiln_error *error);
/// Describes the first light of a binary glTF file.
kiln_result ki_gltf_describe(kiln_context *context, const uint8_t *bytes, size_t size,
                             const char *name, kiln_file_info *info, kiln_error *error);
/// Decodes all levels of the first light of a binary glTF file whose images are PNG files in the
/// buffer of the file, in the axes of the file, times the intensity of the light. A light that is
/// rotated is not supported.
kiln_result ki_gltf_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                           const char *name, kiln_map *map, kiln_error *error);

#endif

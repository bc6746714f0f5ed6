// Binary glTF with the extension EXT_lights_image_based. Level k of n has roughness k / (n - 1),
// with sizes from 256 texels down to 16. The faces have the order and orientation of the
// extension's figure, which are those of OpenGL and kiln. The axes of glTF are kiln's axes. Lights
// that were taken out of the environment become directional lights of KHR_lights_punctual.
#include "engine/engine.h"

#include "codec/gltf.h"
#include "codec/rgbx.h"

static kiln_result write_files(ki_export *to, kiln_error *error)
{
    ki_writer bytes = {.context = to->context};
    kiln_result result = ki_gltf_encode(to->map, to->sh, to->lights, &bytes, error);
    if (result == KILN_OK)
        result = ki_export_add(to, to->path, &bytes, error);
    ki_writer_free(&bytes);
    return result;
}

const ki_recipe ki_gltf = {
    .about = {.name = "gltf",
              .title = "glTF with EXT_lights_image_based",
              .files = "NAME.glb",
              .ending = "glb",
              .mapping = "r = k / (n - 1)",
              .size = 256,
              .level_count = 5,
              .limit = KI_RGBD_MAX,
              .proof = "pixels of Babylon.js 9.34.0, which is told that texels are linear"},
    .axes = {{0, 1, 2}, {1, 1, 1}},
    .size_min = 32,
    .size_max = 2048,
    .last_size = 16,
    .level_count_min = 2,
    .roughness = ki_even_roughness,
    .level = ki_even_level,
    .write = write_files,
};

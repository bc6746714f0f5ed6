// Binary glTF with the extension EXT_lights_image_based: level k of n holds r = k / (n - 1), 256 texels
// down to 16, and faces lie as in the extension's figure, which is OpenGL's and kiln's own order, in
// glTF's axes, which are kiln's too. It says "spherical harmonics coefficients for irradiance": here
// radiance times pi, 2 pi / 3 and pi / 4 by band. It leaves their signs open; these are Sloan's (Stupid
// Spherical Harmonics Tricks 2008, appendix A2), which Babylon.js, the first to load it, reads.
#include "engine/engine.h"

#include "codec/gltf.h"
#include "codec/rgbx.h"
#include "math/math.h"

static kiln_result write_files(ki_export *to, kiln_error *error)
{
    static const double cosine[9] = {1,     -2.0 / 3, 2.0 / 3, -2.0 / 3, 0.25,
                                     -0.25, 0.25,     -0.25,   0.25};
    ki_writer bytes = {.context = to->context};
    double irradiance[9][3];
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            irradiance[i][c] = KI_PI * cosine[i] * to->sh->c[i][c];
    kiln_result result = ki_gltf_encode(to->map, irradiance, &bytes, error);
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
              .proof = "pixels of Babylon.js 9.34.0, told that they are linear"},
    .axes = {{0, 1, 2}, {1, 1, 1}},
    .size_min = 32,
    .size_max = 2048,
    .last_size = 16,
    .level_count_min = 2,
    .roughness = ki_even_roughness,
    .level = ki_even_level,
    .write = write_files,
};

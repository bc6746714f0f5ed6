// three.js from r187 on: a cube whose level l of 0 to M has the roughness that
// PMREMGenerator.lodToRoughness gives, r = 1 - sqrt(1 - l / M); the shader inverts this formula.
// three.js takes diffuse light from the last level, which therefore must not be so coarse that its
// texels are visible.
//
// three.js' panoramas have +X in the centre and +Z to the right of the centre.
#include "engine/engine.h"

#include "codec/codec.h"
#include "image/pack.h"

static kiln_result write_files(ki_export *to, kiln_error *error)
{
    ki_writer bytes = {.context = to->context};
    kiln_save_def def = {
        .format = to->format, .zstd = ki_export_zstd(to), .sh = to->sh, .lobe = "ggx"};
    kiln_result result = ki_ktx2_encode(to->map, &def, &bytes, error);
    if (result == KILN_OK)
        result = ki_export_add(to, to->path, &bytes, error);
    ki_writer_free(&bytes);
    return result;
}

const ki_recipe ki_three = {
    .about =
        {.name = "three",
         .title = "three.js from r187 on",
         .files = "NAME.ktx2",
         .ending = "ktx2",
         .mapping = "r = 1 - sqrt(1 - k / (n - 1))",
         .tune = true,
         .size = 256,
         .level_count = 6,
         .limit = KI_RGB9E5_MAX,
         .formats = {KILN_FORMAT_RGB9E5, KILN_FORMAT_RGBA16F, KILN_FORMAT_UASTC},
         .format_reason =
             "rgb9e5: in rgba16f the file is twice as large and the picture errs as much; in uastc "
             "the file is 22 % as large and the picture errs up to 1.13 times as much",
         .proof = "pixels of three.js 0.187.0"},
    .axes = {{2, 1, 0}, {1, 1, -1}},
    .size_min = 16,
    .size_max = 4096,
    .last_size = 8,
    .level_count_min = 2,
    .roughness = ki_quadratic_roughness,
    .level = ki_quadratic_level,
    .keeps_last = true,
    .write = write_files,
};

// CesiumJS: NAME.ktx2, a cube of halves whose level k of n has roughness k / (n - 1), for
// ImageBasedLighting.specularEnvironmentMaps, and NAME_sh.json, the nine coefficients for
// sphericalHarmonicCoefficients. CesiumJS reads no compressed file and no other texels.
//
// CesiumJS samples the cube in the direction (east, up, south) of the model's place, so that the
// panorama's centre is in the north, with the east to its right.
#include "engine/engine.h"

#include "codec/cesium_sh.h"
#include "codec/codec.h"
#include "image/pack.h"

static kiln_result add(ki_export *to, const char *ending, const ki_writer *bytes, kiln_error *error)
{
    ki_writer name = {.context = to->context};
    ki_write_text(&name, "%s%s", to->path, ending);
    ki_write_u8(&name, 0);
    kiln_result result = name.failed ? ki_fail_memory(to->context, error, to->path, name.size)
                                     : ki_export_add(to, (const char *)name.bytes, bytes, error);
    ki_writer_free(&name);
    return result;
}

static kiln_result write_files(ki_export *to, kiln_error *error)
{
    ki_writer bytes = {.context = to->context};
    kiln_save_def def = {.format = to->format, .sh = to->sh, .lobe = "ggx"};
    kiln_result result = ki_ktx2_encode(to->map, &def, &bytes, error);
    if (result == KILN_OK)
        result = add(to, ".ktx2", &bytes, error);
    if (result == KILN_OK) {
        bytes.size = 0;
        ki_cesium_sh_write(&bytes, to->sh);
        result = add(to, "_sh.json", &bytes, error);
    }
    ki_writer_free(&bytes);
    return result;
}

const ki_recipe ki_cesium = {
    .about = {.name = "cesium",
              .title = "CesiumJS",
              .files = "NAME.ktx2 and NAME_sh.json",
              .ending = "",
              .mapping = "r = k / (n - 1)",
              .size = 256,
              .level_count = 7,
              .limit = KI_HALF_MAX,
              .formats = {KILN_FORMAT_RGBA16F},
              .proof = "pixels of CesiumJS 1.145.0"},
    .axes = {{0, 1, 2}, {1, 1, 1}},
    .size_min = 32,
    .size_max = 4096,
    .last_size = 4,
    .level_count_min = 2,
    .roughness = ki_even_roughness,
    .level = ki_even_level,
    .write = write_files,
};

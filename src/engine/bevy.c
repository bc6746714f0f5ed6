// Bevy's EnvironmentMapLight: NAME_specular.ktx2, whose level k of n has roughness k / (n - 1), and
// NAME_diffuse.ktx2, irradiance / pi. The GGX lobe of roughness 1 is the cosine lobe, so the
// diffuse cube is a copy of the last specular level. The default format is rgb9e5, as in Bevy's own
// files.
//
// Bevy's world is right-handed with -Z ahead, as kiln's; its shader samples cubes in the direction
// (x, y, -z).
#include "engine/engine.h"

#include "codec/codec.h"
#include "image/image.h"
#include "image/pack.h"

static kiln_result add(ki_export *to, const kiln_map *map, const char *lobe, const char *ending,
                       kiln_error *error)
{
    ki_writer bytes = {.context = to->context}, name = bytes;
    kiln_save_def def = {.format = to->format, .lobe = lobe};
    ki_write_text(&name, "%s%s", to->path, ending);
    ki_write_u8(&name, 0);
    kiln_result result = name.failed ? ki_fail_memory(to->context, error, to->path, name.size)
                                     : ki_ktx2_encode(map, &def, &bytes, error);
    if (result == KILN_OK)
        result = ki_export_add(to, (const char *)name.bytes, &bytes, error);
    ki_writer_free(&bytes);
    ki_writer_free(&name);
    return result;
}

static kiln_result write_files(ki_export *to, kiln_error *error)
{
    int last = to->map->level_count - 1;
    kiln_map diffuse = {.shape = KILN_SHAPE_CUBE,
                        .size = kiln_map_level_size(to->map, last),
                        .level_count = 1,
                        .level = {to->map->level[last]},
                        .roughness = {1}};
    kiln_result result = add(to, to->map, "ggx", "_specular.ktx2", error);
    return result == KILN_OK ? add(to, &diffuse, "lambert", "_diffuse.ktx2", error) : result;
}

const ki_recipe ki_bevy = {
    .about =
        {.name = "bevy",
         .title = "Bevy",
         .files = "NAME_specular.ktx2 and NAME_diffuse.ktx2",
         .ending = "",
         .mapping = "r = k / (n - 1)",
         .size = 256,
         .level_count = 5,
         .limit = KI_RGB9E5_MAX,
         .formats = {KILN_FORMAT_RGB9E5, KILN_FORMAT_RGBA16F, KILN_FORMAT_BC6H},
         .format_reason =
             "rgb9e5: in rgba16f the files are twice as large and the picture errs as much; in "
             "bc6h the files are a quarter as large and the picture errs as much, but most "
             "phones cannot show bc6h",
         .proof = "source of Bevy 0.19.1"},
    .axes = {{0, 1, 2}, {1, 1, -1}},
    .size_min = 32,
    .size_max = 4096,
    .last_size = 16,
    .level_count_min = 2,
    .roughness = ki_even_roughness,
    .level = ki_even_level,
    .write = write_files,
};

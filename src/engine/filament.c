// Filament, with the files of cmgen --deploy: NAME_ibl.ktx, NAME_skybox.ktx and sh.txt. Level l of
// 0 to M has roughness 1 - sqrt(1 - l / M); sizes go from 256 texels down to 16. Texels are halves,
// or floats of 11, 11 and 10 bits as in cmgen. Diffuse light comes from the harmonics, which are
// also stored in the .ktx file; if an application does not pass the harmonics, Filament takes
// diffuse light from the last level.
//
// Filament's panoramas have +Z in the centre and -X to the right of the centre.
#include "engine/engine.h"

#include "codec/filament_sh.h"
#include "codec/ktx1.h"
#include "image/pack.h"

#include <string.h>

// Writes the path of one of Filament's files to `w`: PATH followed by `ending`, for example
// "_ibl.ktx", or sh.txt in the folder of PATH if `ending` is NULL.
static void write_name(ki_writer *w, const char *path, const char *ending)
{
    const char *slash = strrchr(path, '/');
    w->size = 0;
    if (ending)
        ki_write_text(w, "%s%s", path, ending);
    else
        ki_write_text(w, "%.*ssh.txt", slash ? (int)(slash + 1 - path) : 0, path);
    ki_write_u8(w, 0);
}

static kiln_result add(ki_export *to, const char *ending, ki_writer *bytes, ki_writer *name,
                       kiln_error *error)
{
    write_name(name, to->path, ending);
    if (name->failed)
        return ki_fail_memory(to->context, error, to->path, name->size);
    kiln_result result = ki_export_add(to, (const char *)name->bytes, bytes, error);
    bytes->size = 0;
    return result;
}

static kiln_result write_files(ki_export *to, kiln_error *error)
{
    ki_writer bytes = {.context = to->context}, name = bytes;
    kiln_map sky = *to->map;
    sky.level_count = 1;
    kiln_result result = ki_ktx1_encode(to->map, to->sh, "filament", to->format, &bytes, error);
    if (result == KILN_OK)
        result = add(to, "_ibl.ktx", &bytes, &name, error);
    if (result == KILN_OK)
        result = ki_ktx1_encode(&sky, NULL, "filament", to->format, &bytes, error);
    if (result == KILN_OK)
        result = add(to, "_skybox.ktx", &bytes, &name, error);
    if (result == KILN_OK) {
        ki_filament_sh_write(&bytes, to->sh, true);
        result = add(to, NULL, &bytes, &name, error);
    }
    ki_writer_free(&bytes);
    ki_writer_free(&name);
    return result;
}

const ki_recipe ki_filament = {
    .about = {.name = "filament",
              .title = "Filament",
              .files = "NAME_ibl.ktx, NAME_skybox.ktx and sh.txt",
              .ending = "",
              .mapping = "r = 1 - sqrt(1 - k / (n - 1))",
              .tune = true,
              .size = 256,
              .level_count = 5,
              .limit = KI_B10G11R11_MAX,
              .formats = {KILN_FORMAT_B10G11R11, KILN_FORMAT_RGBA16F},
              .format_reason = "b10g11r11: in rgba16f the files are twice as large and the picture "
                               "errs as much",
              .proof = "pixels of Filament's web build 1.53.4"},
    .axes = {{0, 1, 2}, {-1, 1, -1}},
    .size_min = 32,
    .size_max = 4096,
    .last_size = 16,
    .level_count_min = 2,
    .roughness = ki_quadratic_roughness,
    .level = ki_quadratic_level,
    .keeps_last = true,
    .write = write_files,
};

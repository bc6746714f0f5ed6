// Filament, as cmgen --deploy writes: NAME_ibl.ktx, NAME_skybox.ktx and sh.txt. Level l of 0 to M holds
// r = 1 - sqrt(1 - l / M), 256 texels down to 16, as halves or, as cmgen has it, in 11, 11 and 10 bits. Diffuse light comes from the harmonics, which also stand
// in the .ktx, or where an application leaves them out from the last level.
//
// Its panoramas have +Z in the centre and -X to the right of it.
#include "engine/engine.h"

#include "codec/decimal.h"
#include "codec/ktx1.h"
#include "image/pack.h"
#include "math/math.h"

#include <math.h>
#include <string.h>

// Irradiance / pi: factors to 1, y, z, x, xy, yz, 3z^2 - 1, zx, x^2 - y^2.
static void make_factors(const kiln_sh *sh, double factors[9][3])
{
    static const double cosine[9] = {1, 2.0 / 3, 2.0 / 3, 2.0 / 3, 0.25, 0.25, 0.25, 0.25, 0.25};
    static const double basis[9] = {1, 3, 3, 3, 15, 15, 1.25, 15, 3.75};
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            factors[i][c] = sh->c[i][c] * cosine[i] * sqrt(basis[i] / (4 * KI_PI));
}

static void write_sh(ki_writer *w, double factors[9][3], bool lines)
{
    static const char *const names[9] = {"L00",  "L1-1", "L10", "L11", "L2-2",
                                         "L2-1", "L20",  "L21", "L22"};
    for (int i = 0; i < 9; i++) {
        ki_write_text(w, lines ? "(" : "");
        for (int c = 0; c < 3; c++) {
            ki_write_text(w, "%s", !c ? "" : lines ? ", " : " ");
            ki_write_number(w, factors[i][c]);
        }
        if (lines)
            ki_write_text(w, "); // %s, irradiance, pre-scaled base", names[i]);
        ki_write_text(w, "\n");
    }
}

// PATH_ibl.ktx, PATH_skybox.ktx and sh.txt in the same folder.
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
    ki_writer bytes = {.context = to->context}, text = bytes, name = bytes;
    double factors[9][3];
    make_factors(to->sh, factors);
    write_sh(&text, factors, false);
    ki_write_u8(&text, 0);
    kiln_result result = KILN_OK;
    if (text.failed)
        result = ki_fail_memory(to->context, error, "harmonics", text.size);
    if (result == KILN_OK)
        result = ki_ktx1_encode(to->map, 0, to->map->level_count, to->format, "sh",
                                (const char *)text.bytes, &bytes, error);
    if (result == KILN_OK)
        result = add(to, "_ibl.ktx", &bytes, &name, error);
    if (result == KILN_OK)
        result = ki_ktx1_encode(to->map, 0, 1, to->format, NULL, NULL, &bytes, error);
    if (result == KILN_OK)
        result = add(to, "_skybox.ktx", &bytes, &name, error);
    if (result == KILN_OK) {
        write_sh(&bytes, factors, true);
        result = add(to, NULL, &bytes, &name, error);
    }
    ki_writer_free(&bytes);
    ki_writer_free(&text);
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
              .limit = KI_HALF_MAX,
              .formats = {KILN_FORMAT_RGBA16F, KILN_FORMAT_B10G11R11},
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

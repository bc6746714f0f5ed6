// Writes spherical harmonics as text: JSON, one line for each coefficient, or a C array.
#include "codec/sh_text.h"

#include "base/file.h"
#include "codec/decimal.h"
#include "codec/formats.h"

#include <string.h>

kiln_result ki_sh_check(const kiln_sh *sh, kiln_error *error)
{
    if (sh && (sh->bands < 1 || sh->bands > KILN_MAX_BANDS))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "bands is %d, it must be 1 to %d", sh->bands,
                       KILN_MAX_BANDS);
    return KILN_OK;
}

static const char *const basis[KILN_MAX_BANDS * KILN_MAX_BANDS] = {
    "Y0,0",  "Y1,-1", "Y1,0",  "Y1,1", "Y2,-2", "Y2,-1", "Y2,0", "Y2,1",  "Y2,2",
    "Y3,-3", "Y3,-2", "Y3,-1", "Y3,0", "Y3,1",  "Y3,2",  "Y3,3", "Y4,-4", "Y4,-3",
    "Y4,-2", "Y4,-1", "Y4,0",  "Y4,1", "Y4,2",  "Y4,3",  "Y4,4"};

static void write_row(ki_writer *w, const double c[3], const char *between)
{
    for (int k = 0; k < 3; k++) {
        ki_write_text(w, "%s", k ? between : "");
        ki_write_number(w, c[k]);
    }
}

static void write_json(ki_writer *w, const kiln_sh *sh)
{
    ki_write_text(w, "{\n  \"bands\": %d,\n  \"irradiance\": %s,\n  \"window\": ", sh->bands,
                  sh->irradiance ? "true" : "false");
    ki_write_number(w, sh->window);
    ki_write_text(w, ",\n  \"basis\": \"real orthonormal, no Condon-Shortley sign, l(l+1)+m\",\n"
                     "  \"coefficients\": [\n");
    int count = sh->bands * sh->bands;
    for (int i = 0; i < count; i++) {
        ki_write_text(w, "    [");
        write_row(w, sh->c[i], ", ");
        ki_write_text(w, "]%s\n", i < count - 1 ? "," : "");
    }
    ki_write_text(w, "  ]\n}\n");
}

static void write_lines(ki_writer *w, const kiln_sh *sh)
{
    for (int i = 0; i < sh->bands * sh->bands; i++) {
        write_row(w, sh->c[i], " ");
        ki_write_text(w, " ; %s\n", basis[i]);
    }
}

static void write_array(ki_writer *w, const kiln_sh *sh)
{
    int count = sh->bands * sh->bands;
    ki_write_text(w,
                  "// Spherical harmonics of %s, %d bands, red green blue: real, orthonormal, no\n"
                  "// Condon-Shortley sign, in the order l(l+1)+m.",
                  sh->irradiance ? "irradiance" : "radiance", sh->bands);
    if (sh->window > 0) {
        ki_write_text(w, " Hanning window of width ");
        ki_write_number(w, sh->window);
        ki_write_text(w, ".");
    }
    ki_write_text(w, "\nstatic const double kiln_sh_coefficients[%d][3] = {\n", count);
    for (int i = 0; i < count; i++) {
        ki_write_text(w, "    {");
        write_row(w, sh->c[i], ", ");
        ki_write_text(w, "}, // %s\n", basis[i]);
    }
    ki_write_text(w, "};\n");
}

kiln_result ki_sh_write(ki_file_set *set, kiln_context *context, const kiln_sh *sh,
                        const char *path, kiln_error *error)
{
    const char *ending = kiln_path_ending(path);
    char list[KI_ENDINGS_TEXT];
    kiln_result result = ki_sh_check(sh, error);
    if (result != KILN_OK)
        return result;
    if (!ki_file_holds(ki_file_format_of_path(path), KI_HOLDS_SH))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: must end in %s", path,
                       ki_list_endings(KI_HOLDS_SH, NULL, list));
    ki_writer bytes = {.context = context};
    if (!strcmp(ending, ".json"))
        write_json(&bytes, sh);
    else if (!strcmp(ending, ".txt"))
        write_lines(&bytes, sh);
    else
        write_array(&bytes, sh);
    if (bytes.failed)
        result = ki_fail_memory(context, error, path, bytes.size);
    else
        result = ki_file_set_add(set, path, bytes.bytes, bytes.size, error);
    ki_writer_free(&bytes);
    return result;
}

typedef struct sh_file {
    kiln_context *context;
    const kiln_sh *sh;
    const char *path;
} sh_file;

static kiln_result add_file(ki_file_set *set, void *data, kiln_error *error)
{
    const sh_file *file = data;
    return ki_sh_write(set, file->context, file->sh, file->path, error);
}

kiln_result kiln_sh_save(kiln_context *context, const kiln_sh *sh, const char *path,
                         kiln_error *error)
{
    sh_file file = {context, sh, path};
    return ki_file_set_make(context, add_file, &file, NULL, error);
}

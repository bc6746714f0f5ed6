// Closed forms as the caller sees them.
#include "table/fit.h"

#include "base/file.h"
#include "table/fit_code.h"
#include "table/table_source.h"

#include <string.h>

kiln_result kiln_fit_create(kiln_context *context, const kiln_fit_def *def, kiln_fit *fit,
                            kiln_error *error)
{
    *fit = (kiln_fit){.def = def ? *def : (kiln_fit_def){0}};
    kiln_result result = ki_fit_complete(&fit->def, error);
    if (!result)
        result = ki_fit_make(context, fit, error);
    if (result)
        *fit = (kiln_fit){0};
    return result;
}

void kiln_fit_evaluate(const kiln_fit *fit, float nov, float roughness, float *values)
{
    ki_fit_evaluate(fit, nov, roughness, values);
}

static bool is_form(const kiln_fit *fit)
{
    if (fit->part_count < 1 || fit->part_count > 2)
        return false;
    for (int k = 0; k < fit->part_count; k++) {
        const kiln_fit_part *part = &fit->part[k];
        if (part->x_count < 1 || part->x_count > KILN_MAX_FIT_TERMS || part->y_count < 1 ||
            part->y_count > KILN_MAX_FIT_TERMS || (unsigned)part->axis > KILN_FIT_AXIS_SQRT_NOV)
            return false;
    }
    return true;
}

kiln_result kiln_fit_save(kiln_context *context, const kiln_fit *fit, const char *name,
                          const char *path, kiln_error *error)
{
    static const char *const names[] = {"kiln_e", "kiln_e_average", "kiln_dfg", "kiln_sheen"};
    if (!is_form(fit))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "the fit has %d parts, it is not made",
                       fit->part_count);
    ki_source_name made;
    kiln_result result =
        ki_source_name_make(path, name ? name : names[fit->def.kind], &made, error);
    if (result != KILN_OK)
        return result;
    bool glsl = ki_ends_with(path, ".glsl");
    if (!glsl && !ki_ends_with(path, ".h"))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: ends in none of .h .glsl", path);
    ki_writer text = {.context = context};
    ki_fit_write_code(fit, made.text, glsl, &text);
    result = text.failed ? ki_fail_memory(context, error, path, text.size)
                         : ki_file_write(context, path, text.bytes, text.size, error);
    ki_writer_free(&text);
    return result;
}

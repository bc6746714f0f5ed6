// The colours of EXR files. In: the attributes chromaticities, adoptedNeutral and whiteLuminance of
// a part. Out: the matrix to Rec. 709, the weights of luminance, and notes. Files without these
// attributes are Rec. 709, as OpenEXR defines it. The matrix is that of image/color.h.
#include "codec/exr.h"
#include "codec/report.h"

#include <float.h>
#include <string.h>

static bool read_floats(const ki_exr_part *part, const char *name, const char *type, int count,
                        double *values)
{
    size_t size = 0;
    const uint8_t *bytes = ki_exr_attribute(part, name, type, &size);
    if (!bytes || size != 4 * (size_t)count)
        return false;
    for (int i = 0; i < count; i++) {
        float value;
        memcpy(&value, bytes + 4 * (size_t)i, sizeof value);
        values[i] = (double)value;
    }
    return true;
}

kiln_result ki_exr_read_color(const ki_exr_part *part, const char *name, ki_exr_color *color,
                              kiln_error *error)
{
    *color = (ki_exr_color){.primaries = ki_rec709};
    double *xy = color->primaries.xy, luminance;
    read_floats(part, "chromaticities", "chromaticities", 8, xy);
    memcpy(color->neutral, xy + 6, sizeof color->neutral);
    read_floats(part, "adoptedNeutral", "v2f", 2, color->neutral);
    if (read_floats(part, "whiteLuminance", "float", 1, &luminance) && luminance > 0 &&
        luminance <= (double)FLT_MAX)
        color->luminance = luminance;
    if (!ki_rec709_from_rgb(&color->primaries, color->neutral, &color->matrix) ||
        !ki_luminance_weights(&color->primaries, color->weights))
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: its chromaticities, red (%.4g, %.4g), green (%.4g, %.4g), blue (%.4g, "
                       "%.4g), white (%.4g, %.4g), neutral (%.4g, %.4g), are no set of primaries",
                       name, xy[0], xy[1], xy[2], xy[3], xy[4], xy[5], xy[6], xy[7],
                       color->neutral[0], color->neutral[1]);
    color->converts = !ki_matrix_is_identity(&color->matrix);
    return KILN_OK;
}

void ki_exr_note_aspect(const ki_exr_part *part, kiln_load_report *report)
{
    double aspect;
    if (read_floats(part, "pixelAspectRatio", "float", 1, &aspect))
        ki_note_pixel_aspect(report, "the attribute pixelAspectRatio", aspect);
}

void ki_exr_note_color(const ki_exr_color *color, ki_exr_kind kind, kiln_load_report *report)
{
    const double *xy = color->primaries.xy, *w = color->weights;
    if (kind == KI_EXR_CHROMA)
        ki_note(report, KILN_NOTE_CONVERSION, false,
                "luminance and chroma became red, green and blue, with the weights %.4f %.4f %.4f",
                w[0], w[1], w[2]);
    if (kind != KI_EXR_GREY && color->converts)
        ki_note(report, KILN_NOTE_CONVERSION, false,
                "colours became Rec. 709: the file's red is (%.4g, %.4g), green (%.4g, %.4g), blue "
                "(%.4g, %.4g), neutral white (%.4g, %.4g), adapted by Bradford",
                xy[0], xy[1], xy[2], xy[3], xy[4], xy[5], color->neutral[0], color->neutral[1]);
    if (color->luminance > 0)
        ki_note(report, KILN_NOTE_ASSUMPTION, false,
                "the file states %.6g cd/m2 for white (1, 1, 1); texels were not multiplied by "
                "this number, since light in kiln has the unit of the file",
                color->luminance);
}

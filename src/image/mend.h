// Replaces values of pictures that are no radiance.
#ifndef KI_MEND_H
#define KI_MEND_H

#include "image/image.h"

/// Replaces in all levels of a map infinite values by 65504, values that are not a number or minus
/// infinity by the mean of the neighbouring texels that have numbers, and minus zero by zero; and
/// does with values below zero what `negative` says. Adds to the counts of *report. Fails if a
/// level has no texel whose values are all finite. `name` appears in error messages. The time is
/// proportional to the number of texels.
kiln_result ki_map_mend(kiln_context *context, const char *name, kiln_negative negative,
                        kiln_map *map, kiln_load_report *report, kiln_error *error);
/// Mends a flat picture of three channels as ki_map_mend mends a map, and keeps its values below
/// zero. Adds the numbers of texels that are infinite or not a number to *report, which may be
/// NULL.
kiln_result ki_image_mend(kiln_context *context, const char *name, kiln_image *image,
                          kiln_load_report *report, kiln_error *error);

#endif

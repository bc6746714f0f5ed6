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

/// What was found in one row of a panorama. {0} is a row that was not read.
typedef struct ki_row_finds {
    /// numbers of texels with an infinite channel, a channel that is not a number, and a channel
    /// below zero
    int infinite_count, nan_count, negative_count;
    bool weighed;                  ///< true: the light of the row is known
    double above_zero, below_zero; ///< light of the values above zero and below zero
} ki_row_finds;

/// Mends one row of a panorama of `size` rows as ki_map_mend mends a map, except that values that
/// are not a number stay. With `weigh`, or if the row has values below zero, sums its light.
void ki_row_mend(int size, int row, kiln_negative negative, bool weigh, float *rgb,
                 ki_row_finds *finds);
/// Adds what was found in all rows of a panorama to *report, as ki_map_mend does. If some row has
/// values below zero, the light of all rows must be known. Fails if no texel has finite values.
kiln_result ki_rows_report(const char *name, int size, kiln_negative negative,
                           const ki_row_finds *finds, kiln_load_report *report, kiln_error *error);
/// Mends a flat picture of three channels as ki_map_mend mends a map, and keeps its values below
/// zero. Adds the numbers of texels that are infinite or not a number to *report, which may be
/// NULL.
kiln_result ki_image_mend(kiln_context *context, const char *name, kiln_image *image,
                          kiln_load_report *report, kiln_error *error);

#endif

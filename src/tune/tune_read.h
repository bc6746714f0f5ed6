// Texels for bilinear reads: what a cube shows between its texels should be nearest to a target too.
#ifndef KI_TUNE_READ_H
#define KI_TUNE_READ_H

#include "base/base.h"

/// Writes level `index` of a cube such that, read bilinearly across faces at the texels of `goal` (a
/// cube of a multiple of its size, one level), it shows the goal's radiance with the least squares over
/// the sphere. Nothing is negative; the mean of what is shown is the goal's.
kiln_result ki_fit_reads(kiln_context *context, const kiln_map *goal, kiln_map *map, int index,
                         kiln_error *error);

#endif

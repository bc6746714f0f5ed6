// Texels of a cube such that bilinear reads between them come nearest to a target.
#ifndef KI_TUNE_READ_H
#define KI_TUNE_READ_H

#include "base/base.h"

/// Writes level `index` of a cube such that, read bilinearly across faces at the texels of `goal` (a
/// cube of a multiple of its size, one level), it shows the goal's radiance with the least squares over
/// the sphere. Nothing is negative; the mean of what is shown is the goal's.
kiln_result ki_solve_texels(kiln_context *context, const kiln_map *goal, kiln_map *map, int index,
                            kiln_error *error);

#endif

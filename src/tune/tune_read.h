// Computes the texels of a cube such that the cube, interpolated bilinearly, comes nearest to a
// finer cube.
#ifndef KI_TUNE_READ_H
#define KI_TUNE_READ_H

#include "base/base.h"

/// Writes level `index` of the cube `map`. `goal` is a cube of one level whose size is a multiple
/// of that level's. At the directions of the goal's texels, the level is read bilinearly, across
/// the edges of faces too. The result minimises the squared difference from the goal's radiance
/// over the sphere, with no texel negative. The mean of the values read is that of the goal.
kiln_result ki_solve_texels(kiln_context *context, const kiln_map *goal, kiln_map *map, int index,
                            kiln_error *error);

#endif

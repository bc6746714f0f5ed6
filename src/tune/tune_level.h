// Two steps that finish the texels of a tuned level: adding the share of the unfiltered environment
// (the mirror) that the level's mixture contains, and removing negative texels.
#ifndef KI_TUNE_LEVEL_H
#define KI_TUNE_LEVEL_H

#include "base/base.h"

/// Fills the allocated map `mirrors`, whose sizes are powers of two: its level 0 is a copy of level
/// 0 of `map`, and each further level has the means of 2 x 2 texels of the level before.
void ki_make_mirrors(kiln_context *context, const kiln_map *map, kiln_map *mirrors);
/// Adds `weight` times the unfiltered environment to `level` of `map`, whose size is a power of
/// two. Reads the level of `mirrors` of the same size, or of the next smaller one.
void ki_add_mirror(kiln_context *context, const kiln_map *mirrors, double weight, kiln_map *map,
                   int level);
/// Sets negative texels of a level to 0, and scales each channel so that its mean over the sphere
/// is what it was before.
kiln_result ki_clear_negative(kiln_context *context, kiln_map *map, int level, kiln_error *error);

#endif

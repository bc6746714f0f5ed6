// The texels of tuned levels: the mirror's part of them, and no negative ones.
#ifndef KI_TUNE_LEVEL_H
#define KI_TUNE_LEVEL_H

#include "base/base.h"

/// Fills `mirrors`, whose sizes are powers of two, with level 0 of a map and its means of 2 x 2.
void ki_make_mirrors(kiln_context *context, const kiln_map *map, kiln_map *mirrors);
/// Adds weight times the mirror to a level of another map, whose size is a power of two.
void ki_add_mirror(kiln_context *context, const kiln_map *mirrors, double weight, kiln_map *map,
                   int level);
/// Sets negative texels to 0 and scales the level so that its mean stays.
kiln_result ki_clear_negative(kiln_context *context, kiln_map *map, int level, kiln_error *error);

#endif

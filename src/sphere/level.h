// Synthesis: a spectrum times a lobe, onto the texels of one level.
#ifndef KI_LEVEL_H
#define KI_LEVEL_H

#include "sphere/spectrum.h"
#include "sphere/zonal.h"

/// All that depends on sizes and the lobe only.
typedef struct ki_level ki_level;

/// A level of `size` in the given shape. `zonal` and its `spectrum`, which the level takes over
/// (also on failure), give the lobe; `legendre` must outlive the level and reach its degree.
kiln_result ki_level_create(kiln_context *context, const ki_legendre *legendre,
                            const ki_zonal *zonal, ki_zonal_spectrum *spectrum, kiln_shape shape,
                            int size, ki_level **level, kiln_error *error);
void ki_level_destroy(ki_level *level);
/// Writes level `index` of `map`. `panorama` is needed where the zonal has an inner radius. `stage` as
/// in ki_parallel_steps.
kiln_result ki_level_execute(ki_level *level, const kiln_spectrum *spectrum,
                             const kiln_map *panorama, double rotation, kiln_map *map, int index,
                             const ki_stage *stage, kiln_error *error);

#endif

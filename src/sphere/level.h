// Synthesis: the product of a spectrum and a lobe is evaluated at the texels of one level of a map.
#ifndef KI_LEVEL_H
#define KI_LEVEL_H

#include "sphere/spectrum.h"
#include "sphere/zonal.h"

/// Everything about a level that depends only on sizes and on the lobe.
typedef struct ki_level ki_level;

/// Prepares a level of `size` in the given shape, filtered by the lobe of `zonal`. The level takes
/// over `spectrum`, the lobe's coefficients, also on failure. `legendre` must outlive the level and
/// reach the degree of `spectrum`.
kiln_result ki_level_create(kiln_context *context, const ki_legendre *legendre,
                            const ki_zonal *zonal, ki_zonal_spectrum *spectrum, kiln_shape shape,
                            int size, ki_level **level, kiln_error *error);
void ki_level_destroy(ki_level *level);
/// Writes level `index` of `map`. `panorama` is needed if the zonal has an outer angle > 0. `stage`
/// is described at ki_parallel_steps.
kiln_result ki_level_execute(ki_level *level, const kiln_spectrum *spectrum,
                             const kiln_map *panorama, double rotation, kiln_map *map, int index,
                             const ki_stage *stage, kiln_error *error);

/// Bytes that an execution takes for `count` suns of a panorama of `source_size` rows, and all.
size_t ki_level_suns_size(const ki_level *level, int source_size, size_t count);

#endif

// Synthesis: the product of a spectrum and a lobe is evaluated at the texels of one level of a map.
#ifndef KI_LEVEL_H
#define KI_LEVEL_H

#include "image/image.h"
#include "sphere/spectrum.h"
#include "sphere/zonal.h"

/// The plan of a filtered level: everything that depends only on sizes and on the lobe. An
/// execution changes nothing in the level, so that any number of threads may execute one level at
/// the same time, each with a workspace of its own.
typedef struct ki_level ki_level;

/// Prepares a level of `size` in the given shape, filtered by the lobe of `zonal`. The level takes
/// over `spectrum`, the lobe's coefficients, also on failure. `legendre` must outlive the level and
/// have at least the degree of `spectrum`. `tilt` turns the environment before the rotation of an
/// execution is applied; NULL for no turn.
kiln_result ki_level_create(kiln_context *context, const ki_legendre *legendre,
                            const ki_zonal *zonal, ki_zonal_spectrum *spectrum, kiln_shape shape,
                            int size, const ki_tilt *tilt, ki_level **level, kiln_error *error);
/// Frees a level. `level` may be NULL.
void ki_level_destroy(ki_level *level);

/// The buffers that executions of levels work on, one level after the other. {0} is an empty
/// workspace. The threads are those of the context that reserved the buffers.
typedef struct ki_level_workspace {
    kiln_context *context;
    ki_buffer coefficients, grid, scratch;
} ki_level_workspace;

/// Makes the workspace large enough for a level, and for all levels of earlier calls.
kiln_result ki_level_reserve(kiln_context *context, const ki_level *level,
                             ki_level_workspace *workspace, kiln_error *error);
void ki_level_workspace_free(ki_level_workspace *workspace);

/// Writes level `index` of `map`, in a workspace that was reserved for the level. `panorama` is
/// needed only if the lobe's centre is left out of its spectrum (`outer` of ki_zonal above 0).
/// `range` is described at ki_parallel_steps. The only memory allocated is that of the suns, see
/// ki_level_suns_size.
kiln_result ki_level_execute(const ki_level *level, const ki_level_workspace *workspace,
                             const kiln_spectrum *spectrum, const kiln_map *panorama,
                             double rotation, kiln_map *map, int index,
                             const ki_progress_range *range, kiln_error *error);

/// Returns whether executions of a level need the panorama.
bool ki_level_needs_panorama(const ki_level *level);

/// Returns the number of bytes that an execution allocates for `count` suns of a panorama of
/// `source_size` rows.
size_t ki_level_suns_size(const ki_level *level, int source_size, size_t count);

#endif

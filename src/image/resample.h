// Resampling of maps by area: every texel of the result is the mean of the source over the texel's
// solid angle, and the source is constant over each of its texels.
#ifndef KI_RESAMPLE_H
#define KI_RESAMPLE_H

#include "image/image.h"

/// Everything about a resampling that depends only on the two shapes and sizes and on the rotation.
/// An execution changes nothing in the plan.
typedef struct ki_resample_plan ki_resample_plan;

/// Prepares a resampling, turned by `rotation` degrees about +Y as in kiln_map_convert, and by
/// `tilt`, which may be NULL, before.
kiln_result ki_resample_plan_create(kiln_context *context, kiln_shape source_shape, int source_size,
                                    kiln_shape shape, int size, const ki_tilt *tilt,
                                    double rotation, ki_resample_plan **plan, kiln_error *error);
/// Makes `buffer` large enough for executions of the plan by the context's threads.
kiln_result ki_resample_reserve(kiln_context *context, const ki_resample_plan *plan,
                                ki_buffer *buffer, kiln_error *error);
/// Resamples one level. `source` and `target` are RGB texels in the plan's shapes and sizes and
/// must not overlap. `buffer` was reserved for the plan and is overwritten. The function allocates
/// nothing. It returns false only if a progress report asks it to stop; `range` is described at
/// ki_parallel_steps.
bool ki_resample_execute(kiln_context *context, const ki_resample_plan *plan, ki_buffer *buffer,
                         const float *source, float *target, const ki_progress_range *range);

// Resampling of a panorama whose rows come from both poles to the equator. A texel of the target
// belongs to the hemisphere in which the middle of its source rows lies. The depth of a row is its
// distance in rows from the pole of that hemisphere: row r has the depth r from the north pole and
// rows - 1 - r from the south pole.

/// Returns whether a plan can be executed by ki_resample_band: from a panorama, without a turn that
/// takes rows to other places than rows.
bool ki_resample_has_bands(const ki_resample_plan *plan);
/// Prepares a plan for executions by ki_resample_band; ki_resample_has_bands must be true for it.
/// Does nothing if the plan is prepared already.
kiln_result ki_resample_plan_bands(kiln_context *context, ki_resample_plan *plan,
                                   kiln_error *error);
/// Returns the greatest number of source rows from which a texel of the target is computed.
int ki_resample_reach(const ki_resample_plan *plan);
/// Computes all texels whose last source row has a depth from `from` to `to` - 1, with the same
/// bits as ki_resample_execute. ki_resample_plan_bands must have prepared the plan. rows[0] holds
/// the rows from the north pole, rows[1] those from the south pole, as many of them up to this
/// depth as ki_resample_reach says. `buffer` was reserved for the plan and keeps its content from
/// the first band to ki_resample_end_bands. Returns false if the caller of the library stops the
/// work.
bool ki_resample_band(kiln_context *context, const ki_resample_plan *plan, ki_buffer *buffer,
                      const ki_rows rows[2], int from, int to, float *target);
/// Completes the target after all bands.
void ki_resample_end_bands(kiln_context *context, const ki_resample_plan *plan, ki_buffer *buffer,
                           float *target);
/// Frees a plan. `plan` may be NULL.
void ki_resample_plan_destroy(ki_resample_plan *plan);

#endif

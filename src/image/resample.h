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
/// Frees a plan. `plan` may be NULL.
void ki_resample_plan_destroy(ki_resample_plan *plan);

#endif

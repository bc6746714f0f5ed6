// Resampling of maps by area: every texel of the result is the mean of the source over the texel's
// solid angle, and the source is constant over each of its texels.
#ifndef KI_RESAMPLE_H
#define KI_RESAMPLE_H

#include "image/image.h"

/// Everything about a resampling that depends only on the two shapes and sizes and on the rotation.
typedef struct ki_resample_plan ki_resample_plan;

/// Prepares a resampling, turned by `rotation` degrees about +Y as in kiln_map_convert. The context
/// must outlive the plan.
kiln_result ki_resample_plan_create(kiln_context *context, kiln_shape source_shape, int source_size,
                                    kiln_shape shape, int size, double rotation,
                                    ki_resample_plan **plan, kiln_error *error);
/// Resamples one level. `source` and `target` are RGB texels in the plan's shapes and sizes and
/// must not overlap. The function allocates nothing. It returns false only if a progress report
/// asks it to stop; `stage` is described at ki_parallel_steps. A plan can run only one execution at
/// a time.
bool ki_resample_execute(ki_resample_plan *plan, const float *source, float *target,
                         const ki_stage *stage);
/// Frees a plan. `plan` may be NULL.
void ki_resample_plan_destroy(ki_resample_plan *plan);

#endif

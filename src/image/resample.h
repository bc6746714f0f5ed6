// Maps by area: every texel of the result is the mean of the source over the texel's true solid
// angle, the source's texels being uniformly bright over theirs.
#ifndef KI_RESAMPLE_H
#define KI_RESAMPLE_H

#include "image/image.h"

/// Everything that depends only on the two shapes and sizes and on the rotation.
typedef struct ki_resample_plan ki_resample_plan;

/// `rotation` in degrees about +Y as in kiln_map_convert. The plan keeps the context.
kiln_result ki_resample_plan_create(kiln_context *context, kiln_shape source_shape, int source_size,
                                    kiln_shape shape, int size, double rotation,
                                    ki_resample_plan **plan, kiln_error *error);
/// `source` and `target` are the RGB texels of one level each, of the plan's shapes and sizes; they
/// must not overlap. Allocates nothing and fails only, with false, where a report of progress asks it
/// to stop; `stage` as in ki_parallel_steps. One execution of a plan at a time.
bool ki_resample_execute(ki_resample_plan *plan, const float *source, float *target,
                         const ki_stage *stage);
/// May be NULL.
void ki_resample_plan_destroy(ki_resample_plan *plan);

#endif

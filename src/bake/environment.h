// Baking of an environment from a source: levels, irradiance and harmonics.
#ifndef KI_ENVIRONMENT_H
#define KI_ENVIRONMENT_H

#include "bake/prefilter.h"

/// The parameters of a plan, with every default filled in.
typedef struct ki_plan_def {
    kiln_shape source_shape;
    int source_size;
    const kiln_prefilter_def *levels; ///< definition of the levels; NULL for the defaults
    const ki_reading *reading;        ///< how an engine reads tuned levels; NULL for exact levels
    bool mirror;
    double exposure;     ///< exposure in stops: the source is multiplied by 2^exposure
    int irradiance_size; ///< size of the irradiance map; 0 for no irradiance
    int sh_bands;        ///< number of bands of harmonics; 0 for no harmonics
} ki_plan_def;

kiln_result ki_plan_create(kiln_context *context, const ki_plan_def *def, kiln_plan **plan,
                           kiln_error *error);

/// Allocates what executions need, so that executions allocate nothing. For tuned levels this takes
/// as long as an execution.
kiln_result ki_plan_reserve(kiln_plan *plan, kiln_error *error);

#endif

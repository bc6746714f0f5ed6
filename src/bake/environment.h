// From a source to what a scene is lit by: levels, irradiance and harmonics.
#ifndef KI_ENVIRONMENT_H
#define KI_ENVIRONMENT_H

#include "bake/prefilter.h"

/// What a plan is made for, with every default filled in.
typedef struct ki_plan_def {
    kiln_shape source_shape;
    int source_size;
    const kiln_prefilter_def *levels; ///< may be NULL for the defaults
    const ki_reading *reading;        ///< how an engine reads tuned levels; NULL for exact ones
    bool mirror;
    double exposure;     ///< stops
    int irradiance_size; ///< 0 for none
    int sh_bands;        ///< 0 for none
} ki_plan_def;

kiln_result ki_plan_create(kiln_context *context, const ki_plan_def *def, kiln_plan **plan,
                           kiln_error *error);

#endif

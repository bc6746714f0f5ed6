// Baking of an environment from a source: levels, irradiance and harmonics.
#ifndef KI_ENVIRONMENT_H
#define KI_ENVIRONMENT_H

#include "bake/prefilter.h"

/// The parameters of a plan. Unlike in kiln_bake_def, 0 never stands for a default number.
typedef struct ki_plan_def {
    kiln_shape source_shape;
    int source_size;
    /// definition of the prefiltered levels; NULL for its default values
    const kiln_prefilter_def *levels;
    /// how an engine reads the levels, for which they are tuned; NULL for exact levels
    const ki_reading *reading;
    bool mirror;
    double exposure;     ///< exposure in stops: the source is multiplied by 2^exposure
    int irradiance_size; ///< size of the irradiance map; 0 for no irradiance
    int sh_bands;        ///< number of bands of harmonics; 0 for no harmonics
    kiln_sun sun;        ///< what becomes of lights
    kiln_lights_def lights;
    double clamp;
    /// true: the plan is executed by ki_plan_execute_rows if ki_plan_takes_rows, and then has no
    /// memory for a changed copy of the source
    bool rows;
} ki_plan_def;

kiln_result ki_plan_create(kiln_context *context, const ki_plan_def *def, kiln_plan **plan,
                           kiln_error *error);

/// Allocates all memory that executions of a plan need, so that executions allocate nothing. For
/// tuned levels the call takes as long as an execution.
kiln_result ki_plan_reserve(kiln_plan *plan, kiln_error *error);

/// Returns whether an environment can be computed while the rows of the source pass by: the plan
/// was made for rows, the source is a panorama whose lights stay, and no level needs the whole
/// panorama.
bool ki_plan_takes_rows(const kiln_plan *plan);
/// Executes a plan as kiln_plan_execute does, with the same bits, and reads the source row by row.
/// Only for plans that satisfy ki_plan_takes_rows.
kiln_result ki_plan_execute_rows(kiln_plan *plan, const kiln_rows *rows,
                                 kiln_environment *environment, kiln_error *error);

#endif

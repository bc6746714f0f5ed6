// The public functions for environments, plans and levels. In: a source and a definition of what is
// baked. Out: an environment, a plan, or the levels of a map. The functions here find the engine
// for whose shader levels are tuned, and pass the description of that shader to src/bake, which
// does the work.
#include "bake/environment.h"
#include "engine/engine.h"
#include "image/image.h"

// Sets *reading to how an engine's shader reads levels (sizes, roughness, interpolation), stored in
// `room`, if the levels are to be tuned for this engine. Sets *reading to NULL for exact levels.
static kiln_result find_reading(const kiln_prefilter_def *def, ki_reading *room,
                                const ki_reading **reading, kiln_error *error)
{
    *reading = NULL;
    if (!def || !def->tune_for)
        return KILN_OK;
    const ki_recipe *recipe = ki_recipe_of(def->tune_for);
    if (!recipe || !recipe->level)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "tune_for must be an engine of kiln_engine_find that reads levels");
    *room = (ki_reading){.level = recipe->level,
                         .keep_last = recipe->keeps_last,
                         .flat = recipe->flat,
                         .soft = def->tune_soft};
    *reading = room;
    return KILN_OK;
}

static bool decides_itself(const kiln_prefilter_def *levels)
{
    return levels->roughness || levels->smallest || levels->lobe != KILN_LOBE_GGX ||
           levels->tune_for || levels->tune_soft;
}

// Sets *levels to what is prefiltered: the caller's own definition, or the engine's levels for the
// caller's size.
static kiln_result find_levels(const kiln_bake_def *def, float roughness[KILN_MAX_LEVELS],
                               kiln_prefilter_def *levels, kiln_error *error)
{
    *levels = def->levels;
    if ((int)def->tune < 0 || def->tune > KILN_TUNE_SOFT || (def->tune && !def->engine))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "tune is %d, it must be 0 to %d, or 0 if engine is NULL", (int)def->tune,
                       (int)KILN_TUNE_SOFT);
    if (!def->engine)
        return KILN_OK;
    if (decides_itself(levels))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the engine decides the lobe, roughness, smallest and tuning of the levels, "
                       "leave these fields 0");
    kiln_prefilter_def wanted;
    kiln_result result = kiln_engine_levels(def->engine, levels->size, levels->level_count,
                                            roughness, &wanted, error);
    if (result != KILN_OK)
        return result;
    levels->size = wanted.size;
    levels->level_count = wanted.level_count;
    levels->smallest = wanted.smallest;
    levels->roughness = wanted.roughness;
    bool tuned = def->tune == KILN_TUNE_AUTO ? def->engine->tune : def->tune != KILN_TUNE_NONE;
    levels->tune_for = tuned ? def->engine : NULL;
    levels->tune_soft = def->tune == KILN_TUNE_SOFT;
    return KILN_OK;
}

static kiln_result create_plan(kiln_context *context, kiln_shape source_shape, int source_size,
                               const kiln_bake_def *def, kiln_plan **plan, kiln_error *error)
{
    static const kiln_bake_def defaults = {0};
    float roughness[KILN_MAX_LEVELS];
    kiln_prefilter_def levels;
    ki_reading room;
    const ki_reading *reading;
    def = def ? def : &defaults;
    *plan = NULL;
    kiln_result result = find_levels(def, roughness, &levels, error);
    if (result == KILN_OK)
        result = find_reading(&levels, &room, &reading, error);
    if (result == KILN_OK && def->irradiance_size < KILN_NO_IRRADIANCE)
        result = ki_fail(error, KILN_ERROR_ARGUMENT, "irradiance_size is %d, it must be %d to %d",
                         def->irradiance_size, KILN_NO_IRRADIANCE, KILN_MAX_SIZE);
    if (result != KILN_OK)
        return result;
    ki_plan_def full = {.source_shape = source_shape,
                        .source_size = source_size,
                        .levels = &levels,
                        .reading = reading,
                        .mirror = def->mirror,
                        .exposure = def->exposure,
                        .irradiance_size = def->irradiance_size ? def->irradiance_size : 64,
                        .sh_bands = def->sh_bands ? def->sh_bands : 3,
                        .sun = def->sun,
                        .lights = def->lights,
                        .clamp = def->clamp};
    if (def->irradiance_size == KILN_NO_IRRADIANCE)
        full.irradiance_size = 0;
    return ki_plan_create(context, &full, plan, error);
}

kiln_result kiln_plan_create(kiln_context *context, kiln_shape source_shape, int source_size,
                             const kiln_bake_def *def, kiln_plan **plan, kiln_error *error)
{
    kiln_result result = create_plan(context, source_shape, source_size, def, plan, error);
    if (result == KILN_OK)
        result = ki_plan_reserve(*plan, error);
    if (result != KILN_OK) {
        kiln_plan_destroy(*plan);
        *plan = NULL;
    }
    return result;
}

// Computes an environment by a plan that is created for one execution and then destroyed.
static kiln_result execute_once(kiln_plan *plan, const kiln_map *source,
                                kiln_environment *environment, kiln_error *error)
{
    kiln_result result = kiln_plan_environment(plan, environment, error);
    if (result == KILN_OK)
        result = kiln_plan_execute(plan, source, environment, error);
    if (result != KILN_OK)
        kiln_environment_free(environment);
    return result;
}

kiln_result kiln_bake(kiln_context *context, const kiln_map *source, const kiln_bake_def *def,
                      kiln_environment *environment, kiln_error *error)
{
    kiln_plan *plan = NULL;
    *environment = (kiln_environment){0};
    kiln_result result = ki_map_check(source, error);
    if (result == KILN_OK)
        result = create_plan(context, source->shape, source->size, def, &plan, error);
    if (result == KILN_OK)
        result = execute_once(plan, source, environment, error);
    kiln_plan_destroy(plan);
    return result;
}

kiln_result kiln_prefilter(kiln_context *context, const kiln_map *source,
                           const kiln_prefilter_def *def, kiln_map *map, kiln_error *error)
{
    kiln_plan *plan = NULL;
    kiln_environment environment = {0};
    ki_plan_def full = {.levels = def};
    ki_reading room;
    *map = (kiln_map){0};
    kiln_result result = ki_map_check(source, error);
    if (result == KILN_OK)
        result = find_reading(def, &room, &full.reading, error);
    full.source_shape = source->shape;
    full.source_size = source->size;
    if (result == KILN_OK)
        result = ki_plan_create(context, &full, &plan, error);
    if (result == KILN_OK)
        result = execute_once(plan, source, &environment, error);
    kiln_plan_destroy(plan);
    *map = environment.levels;
    return result;
}

// The public functions for environments, plans and levels. In: a source and a definition of what is
// baked. Out: an environment, a plan, or the levels of a map. The functions here find the engine
// for whose shader levels are tuned, and pass the description of that shader to src/bake, which
// does the work.
#include "bake/environment.h"
#include "codec/row_file.h"
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

// Creates the plan of a bake, to be executed row by row if `rows` is true.
static kiln_result create_plan(kiln_context *context, kiln_shape source_shape, int source_size,
                               const kiln_bake_def *def, bool rows, kiln_plan **plan,
                               kiln_error *error)
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
                        .clamp = def->clamp,
                        .rows = rows};
    if (def->irradiance_size == KILN_NO_IRRADIANCE)
        full.irradiance_size = 0;
    return ki_plan_create(context, &full, plan, error);
}

kiln_result kiln_plan_create(kiln_context *context, kiln_shape source_shape, int source_size,
                             const kiln_bake_def *def, kiln_plan **plan, kiln_error *error)
{
    kiln_result result = create_plan(context, source_shape, source_size, def, false, plan, error);
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
        result = create_plan(context, source->shape, source->size, def, false, &plan, error);
    if (result == KILN_OK)
        result = execute_once(plan, source, environment, error);
    kiln_plan_destroy(plan);
    return result;
}

// Bakes a panorama whose rows are all read first.
static kiln_result bake_whole(kiln_context *context, const kiln_rows *rows,
                              const kiln_bake_def *def, kiln_environment *environment,
                              kiln_error *error)
{
    kiln_map map = {.shape = KILN_SHAPE_PANORAMA, .size = rows->size, .level_count = 1};
    kiln_result result = ki_map_allocate(context, &map, error);
    if (result == KILN_OK)
        result = rows->read(rows->user, 0, rows->size, map.level[0], error);
    if (result == KILN_OK)
        result = kiln_bake(context, &map, def, environment, error);
    kiln_map_free(&map);
    return result;
}

// Bakes while rows pass by, if the bake needs no more than a few rows at a time, and sets *passes
// to whether this is so.
static kiln_result bake_passing(kiln_context *context, const kiln_rows *rows,
                                const kiln_bake_def *def, bool *passes,
                                kiln_environment *environment, kiln_error *error)
{
    kiln_plan *plan = NULL;
    kiln_result result =
        create_plan(context, KILN_SHAPE_PANORAMA, rows->size, def, true, &plan, error);
    *passes = result == KILN_OK && ki_plan_takes_rows(plan);
    if (*passes)
        result = kiln_plan_environment(plan, environment, error);
    if (*passes && result == KILN_OK)
        result = ki_plan_execute_rows(plan, rows, environment, error);
    if (result != KILN_OK)
        kiln_environment_free(environment);
    kiln_plan_destroy(plan);
    return result;
}

kiln_result kiln_bake_rows(kiln_context *context, const kiln_rows *rows, const kiln_bake_def *def,
                           kiln_environment *environment, kiln_error *error)
{
    bool passes;
    *environment = (kiln_environment){0};
    if (rows->size < 1 || rows->size > KILN_MAX_SIZE / 2 || rows->block < 0)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the panorama has %d rows in blocks of %d, it must have 1 to %d, in blocks "
                       "of 0 or more",
                       rows->size, rows->block, KILN_MAX_SIZE / 2);
    kiln_result result = bake_passing(context, rows, def, &passes, environment, error);
    return passes || result != KILN_OK ? result
                                       : bake_whole(context, rows, def, environment, error);
}

// Loads a file as a whole and bakes it.
static kiln_result bake_loaded(kiln_context *context, const char *path, const kiln_load_def *load,
                               const kiln_bake_def *def, kiln_extent *source,
                               kiln_environment *environment, kiln_error *error)
{
    kiln_map map;
    kiln_result result = kiln_map_load(context, path, load, &map, error);
    *source = (kiln_extent){map.shape, map.size};
    if (result == KILN_OK)
        result = kiln_bake(context, &map, def, environment, error);
    kiln_map_free(&map);
    return result;
}

// Bakes a file while its rows pass by. *done is false if only the whole picture can be baked.
static kiln_result bake_passing_file(kiln_context *context, const char *path,
                                     const kiln_load_def *load, const kiln_bake_def *def,
                                     kiln_extent *source, bool *done, kiln_environment *environment,
                                     kiln_error *error)
{
    ki_row_file *file = NULL;
    kiln_rows rows;
    kiln_result result = ki_row_file_open(context, path, load, &file, &rows, error);
    *done = file || result != KILN_OK;
    if (!file)
        return result;
    *source = (kiln_extent){KILN_SHAPE_PANORAMA, rows.size};
    result = bake_passing(context, &rows, def, done, environment, error);
    *done = *done || result != KILN_OK;
    if (*done && result == KILN_OK)
        result = ki_row_file_finish(file, error);
    if (result != KILN_ERROR_CANCELLED && ki_row_file_needs_whole(file))
        *done = false;
    if (!*done || result != KILN_OK)
        kiln_environment_free(environment);
    ki_row_file_close(file);
    return result;
}

kiln_result kiln_bake_file(kiln_context *context, const char *path, const kiln_load_def *load,
                           const kiln_bake_def *def, kiln_extent *source,
                           kiln_environment *environment, kiln_error *error)
{
    static const kiln_load_def defaults = {0};
    kiln_extent unused = {0};
    bool done;
    load = load ? load : &defaults;
    source = source ? source : &unused;
    *source = (kiln_extent){0};
    *environment = (kiln_environment){0};
    if (load->report)
        *load->report = (kiln_load_report){0};
    if (!ki_progress(context, "reading", 0))
        return ki_fail_cancelled(error, "reading");
    kiln_result result =
        bake_passing_file(context, path, load, def, source, &done, environment, error);
    return done ? result : bake_loaded(context, path, load, def, source, environment, error);
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

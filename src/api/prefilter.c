// The recipe and its plan.
#include "bake/prefilter.h"

#include "bake/plan.h"
#include "engine/engine.h"
#include "image/image.h"

// A plan whose def may name an engine.
static kiln_result create_plan(kiln_context *context, int panorama_size, const kiln_map *source,
                               const kiln_prefilter_def *def, kiln_plan **plan, kiln_error *error)
{
    *plan = NULL;
    if (!def || !def->shown_by)
        return ki_plan_create(context, panorama_size, source, def, NULL, plan, error);
    const ki_recipe *recipe = ki_recipe_of(def->shown_by);
    if (!recipe || !recipe->level)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "shown_by is no engine of kiln's that reads levels");
    ki_shown shown = {.level = recipe->level,
                      .keep_last = recipe->keeps_last,
                      .flat = recipe->flat,
                      .soft = def->soft};
    return ki_plan_create(context, panorama_size, source, def, &shown, plan, error);
}

kiln_result kiln_plan_create(kiln_context *context, int source_size, const kiln_prefilter_def *def,
                             kiln_plan **plan, kiln_error *error)
{
    *plan = NULL;
    if (source_size < 1 || source_size > KILN_MAX_SIZE / 2)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "source_size is %d rows, it must be 1 to %d",
                       source_size, KILN_MAX_SIZE / 2);
    return create_plan(context, source_size, NULL, def, plan, error);
}

void kiln_plan_destroy(kiln_plan *plan)
{
    ki_plan_destroy(plan);
}

kiln_result kiln_plan_map(const kiln_plan *plan, kiln_map *map, kiln_error *error)
{
    *map = (kiln_map){.shape = plan->def.shape,
                      .size = plan->def.size,
                      .level_count = plan->def.level_count,
                      .smallest = plan->def.smallest};
    kiln_result result = ki_map_allocate(plan->context, map, error);
    for (int i = 0; i < map->level_count; i++)
        map->roughness[i] = plan->roughness[i];
    return result;
}

static kiln_result check_and_execute(kiln_plan *plan, const kiln_map *panorama,
                                     const kiln_map *source, kiln_map *map, kiln_error *error)
{
    kiln_result result = ki_map_check(panorama, error);
    if (result != KILN_OK || (result = ki_map_check(map, error)) != KILN_OK)
        return result;
    if (panorama->shape != KILN_SHAPE_PANORAMA || panorama->size != plan->source_size)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the plan is for panoramas of %d rows, this map has shape %d and size %d",
                       plan->source_size, (int)panorama->shape, panorama->size);
    if (map->shape != plan->def.shape || map->size != plan->def.size ||
        map->level_count != plan->def.level_count)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the plan writes shape %d, size %d, %d levels; this map has %d, %d, %d",
                       (int)plan->def.shape, plan->def.size, plan->def.level_count, (int)map->shape,
                       map->size, map->level_count);
    if (map->smallest != plan->def.smallest)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "the plan's smallest is %d, this map's is %d",
                       plan->def.smallest, map->smallest);
    return ki_plan_execute(plan, panorama, source, map, error);
}

kiln_result kiln_plan_execute(kiln_plan *plan, const kiln_map *panorama, kiln_map *map,
                              kiln_error *error)
{
    return check_and_execute(plan, panorama, NULL, map, error);
}

const kiln_spectrum *kiln_plan_spectrum(const kiln_plan *plan)
{
    return plan->spectrum;
}

kiln_result kiln_prefilter(kiln_context *context, const kiln_map *source,
                           const kiln_prefilter_def *def, kiln_map *map, kiln_error *error)
{
    kiln_map made = {0};
    const kiln_map *panorama = source;
    kiln_plan *plan = NULL;
    *map = (kiln_map){0};
    kiln_result result = ki_map_check(source, error);
    if (result == KILN_OK && source->shape == KILN_SHAPE_PANORAMA) {
        result = kiln_plan_create(context, source->size, def, &plan, error);
    } else if (result == KILN_OK) {
        int size = ki_min(2 * source->size, KILN_MAX_SIZE / 2);
        panorama = &made;
        result = kiln_map_convert(context, source, KILN_SHAPE_PANORAMA, size, 0, &made, error);
        if (result == KILN_OK)
            result = create_plan(context, size, source, def, &plan, error);
    }
    if (result == KILN_OK)
        result = kiln_plan_map(plan, map, error);
    if (result == KILN_OK)
        result = check_and_execute(plan, panorama, source, map, error);
    if (result != KILN_OK)
        kiln_map_free(map);
    kiln_plan_destroy(plan);
    kiln_map_free(&made);
    return result;
}

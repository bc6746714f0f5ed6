// The list of engines, and the public functions of engines. In: a cube of prefiltered levels in
// kiln's directions and harmonics of radiance. Out: the files for one engine. Method: the cube and
// the harmonics are turned to the engine's axes (export.c) and passed to the engine's function that
// adds files to a set (`write` of ki_recipe). Also the checks of sizes, levels and formats, and
// kiln_engine_show, which computes what an engine's shader reads.
#include "engine/engine.h"

#include "codec/pixel_format.h"
#include "codec/save.h"
#include "image/image.h"
#include "math/math.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { RECIPES = 15 };
static const ki_recipe *const recipes[RECIPES] = {
    &ki_three,      &ki_three_cubeuv,   &ki_babylon,      &ki_babylon_dds, &ki_filament,
    &ki_playcanvas, &ki_playcanvas_dds, &ki_cesium,       &ki_galacean,    &ki_gltf,
    &ki_bevy,       &ki_unity,          &ki_model_viewer, &ki_godot,       &ki_unreal,
};

const ki_recipe *ki_recipe_at(int index)
{
    return index >= 0 && index < RECIPES ? recipes[index] : NULL;
}

const ki_recipe *ki_recipe_of(const kiln_engine *engine)
{
    for (int i = 0; i < RECIPES; i++)
        if (engine == &recipes[i]->about)
            return recipes[i];
    return NULL;
}

int ki_recipe_levels(const ki_recipe *recipe, int size)
{
    int count = 1;
    int most = recipe->level_count_max ? recipe->level_count_max : KILN_MAX_LEVELS;
    while (size >> count >= recipe->last_size && count < most)
        count++;
    return ki_min(count + recipe->extra_levels, KILN_MAX_LEVELS);
}

const kiln_engine *kiln_engine_at(int index)
{
    const ki_recipe *recipe = ki_recipe_at(index);
    return recipe ? &recipe->about : NULL;
}

const kiln_engine *kiln_engine_find(const char *name)
{
    const kiln_engine *engine = NULL;
    for (int i = 0; (engine = kiln_engine_at(i)) != NULL; i++)
        if (!strcmp(engine->name, name))
            break;
    return engine;
}

static kiln_result check_levels(const ki_recipe *recipe, int size, int level_count,
                                kiln_error *error)
{
    const char *name = recipe->about.name;
    int all = ki_recipe_levels(recipe, size);
    if (size < recipe->size_min || size > recipe->size_max || (size & (size - 1)))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s: size is %d, it must be a power of two from %d to %d", name, size,
                       recipe->size_min, recipe->size_max);
    if (!recipe->level_count_min && level_count != all)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s: level_count is %d, a cube of size %d must have %d levels", name,
                       level_count, size, all);
    int most = 1;
    while (size >> most && most < KILN_MAX_LEVELS)
        most++;
    if (level_count < recipe->level_count_min || level_count > most + recipe->extra_levels)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s: level_count is %d, a cube of size %d may have %d to %d levels", name,
                       level_count, size, recipe->level_count_min, most);
    return KILN_OK;
}

static kiln_result find_recipe(const kiln_engine *engine, const ki_recipe **recipe,
                               kiln_error *error)
{
    *recipe = ki_recipe_of(engine);
    return *recipe ? KILN_OK
                   : ki_fail(error, KILN_ERROR_ARGUMENT,
                             "the engine is unknown, take an engine from kiln_engine_find");
}

kiln_result kiln_engine_levels(const kiln_engine *engine, int size, int level_count,
                               float roughness[KILN_MAX_LEVELS], kiln_prefilter_def *def,
                               kiln_error *error)
{
    *def = (kiln_prefilter_def){0};
    const ki_recipe *recipe;
    kiln_result result = find_recipe(engine, &recipe, error);
    if (result != KILN_OK)
        return result;
    size = size ? size : recipe->about.size;
    level_count = level_count ? level_count : ki_recipe_levels(recipe, size);
    result = check_levels(recipe, size, level_count, error);
    if (result != KILN_OK)
        return result;
    for (int k = 0; k < level_count; k++)
        roughness[k] = (float)recipe->roughness(k, level_count, size);
    *def = (kiln_prefilter_def){.size = size,
                                .level_count = level_count,
                                .smallest = recipe->smallest,
                                .roughness = roughness};
    return KILN_OK;
}

double kiln_engine_level(const kiln_engine *engine, double roughness, int size, int level_count)
{
    const ki_recipe *recipe = ki_recipe_of(engine);
    bool good = recipe && recipe->level && roughness >= 0 && roughness <= 1 && size >= 1 &&
                size <= KILN_MAX_SIZE && level_count >= 1 && level_count <= KILN_MAX_LEVELS;
    return good ? recipe->level(roughness, level_count, size) : -1;
}

kiln_result kiln_engine_format(const kiln_engine *engine, kiln_format *format, kiln_error *error)
{
    const ki_recipe *recipe;
    kiln_result result = find_recipe(engine, &recipe, error);
    if (result != KILN_OK)
        return result;
    const kiln_format *formats = engine->formats;
    char names[64] = "";
    if (*format == KILN_FORMAT_AUTO) {
        *format = formats[0];
        return KILN_OK;
    }
    for (int i = 0; i < 4 && formats[i]; i++) {
        if (*format == formats[i])
            return KILN_OK;
        size_t length = strlen(names);
        snprintf(names + length, sizeof names - length, "%s%s", i ? " or " : "",
                 ki_format_names[formats[i]]);
    }
    if (!names[0])
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s: the engine's files have one format only, leave the format out",
                       engine->name);
    bool known = *format > KILN_FORMAT_AUTO && *format <= KILN_FORMAT_UASTC;
    return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: format is %s, it must be %s", engine->name,
                   known ? ki_format_names[*format] : "unknown", names);
}

// What kiln_engine_show computes: values in `count` directions, read from level `level` of a cube
// and from the next level, which are mixed by `mix` (0: `level` alone).
typedef struct view {
    const kiln_map *map;
    int level;
    double mix;
    const double (*directions)[3];
    double (*values)[3];
    int count;
} view;

enum { VIEW_CHUNK = 1024 };

// Task of one thread: computes the values of one chunk of VIEW_CHUNK directions.
static void show(void *data, int index)
{
    const view *v = data;
    int first = index * VIEW_CHUNK, end = first + ki_min(VIEW_CHUNK, v->count - first);
    for (int i = first; i < end; i++) {
        double next[3];
        ki_cube_read(v->map, v->level, v->directions[i], v->values[i]);
        if (v->mix <= 0)
            continue;
        ki_cube_read(v->map, v->level + 1, v->directions[i], next);
        for (int c = 0; c < 3; c++)
            v->values[i][c] += v->mix * (next[c] - v->values[i][c]);
    }
}

static kiln_result check_directions(const double (*directions)[3], int count, kiln_error *error)
{
    for (int i = 0; i < count; i++) {
        const double *d = directions[i];
        if (!isfinite(d[0]) || !isfinite(d[1]) || !isfinite(d[2]) ||
            (d[0] == 0 && d[1] == 0 && d[2] == 0))
            return ki_fail(error, KILN_ERROR_ARGUMENT,
                           "direction %d is (%g, %g, %g), it must be finite and not 0", i, d[0],
                           d[1], d[2]);
    }
    return KILN_OK;
}

static kiln_result check_show(const ki_recipe *recipe, const kiln_map *map, double roughness,
                              const double (*directions)[3], int count, kiln_error *error)
{
    kiln_result result = ki_map_check(map, error);
    if (result != KILN_OK)
        return result;
    if (!recipe->level || map->shape != KILN_SHAPE_CUBE)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s: only cubes of an engine that reads levels can be shown",
                       recipe->about.name);
    if (!(roughness >= 0 && roughness <= 1))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "roughness is %g, it must be 0 to 1", roughness);
    if (count < 0)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "count is %d, it must not be negative", count);
    return check_directions(directions, count, error);
}

kiln_result kiln_engine_show(kiln_context *context, const kiln_engine *engine, const kiln_map *map,
                             double roughness, const double (*directions)[3], int count,
                             double (*values)[3], kiln_error *error)
{
    const ki_recipe *recipe;
    kiln_result result = find_recipe(engine, &recipe, error);
    if (result == KILN_OK)
        result = check_show(recipe, map, roughness, directions, count, error);
    if (result != KILN_OK) {
        if (count > 0)
            memset(values, 0, (size_t)count * sizeof *values);
        return result;
    }
    double level = recipe->level(roughness, map->level_count, map->size);
    view v = {.map = map, .directions = directions, .values = values, .count = count};
    v.level = (int)ki_clamp(floor(level), 0, map->level_count - 1);
    v.mix = v.level + 1 < map->level_count ? level - v.level : 0;
    ki_parallel_for(context, count / VIEW_CHUNK + (count % VIEW_CHUNK > 0), show, &v);
    return KILN_OK;
}

const char *kiln_engine_ending(const kiln_engine *engine, kiln_format format)
{
    const ki_recipe *recipe = ki_recipe_of(engine);
    bool own = recipe && format == KILN_FORMAT_UASTC && recipe->uastc_ending;
    return !recipe ? NULL : own ? recipe->uastc_ending : recipe->about.ending;
}

// Fails unless a path has the ending of the files of a format that the engine reads.
static kiln_result check_path(const ki_recipe *recipe, kiln_format format, const char *path,
                              kiln_error *error)
{
    const char *ending = kiln_path_ending(path);
    const char *wanted = kiln_engine_ending(&recipe->about, format);
    bool good = path[0] && (!wanted[0] || (ending[0] == '.' && !strcmp(ending + 1, wanted)));
    return good ? KILN_OK
                : ki_fail(error, KILN_ERROR_ARGUMENT, "%s: %s's file must end in .%s", path,
                          recipe->about.name, wanted);
}

static kiln_result check_map(const ki_recipe *recipe, const kiln_map *map, const kiln_sh *sh,
                             kiln_error *error)
{
    kiln_result result = ki_map_check(map, error);
    if (result != KILN_OK)
        return result;
    if (map->shape != KILN_SHAPE_CUBE)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s: the engine reads cubes, but the map has shape %d", recipe->about.name,
                       (int)map->shape);
    if (map->smallest != recipe->smallest)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: the map's smallest must be %d, it is %d",
                       recipe->about.name, recipe->smallest, map->smallest);
    if (!sh || sh->bands < 3 || sh->bands > KILN_MAX_BANDS || sh->irradiance)
        return ki_fail(
            error, KILN_ERROR_ARGUMENT,
            "%s: the engine's files need spherical harmonics of radiance with 3 to %d bands",
            recipe->about.name, KILN_MAX_BANDS);
    return check_levels(recipe, map->size, map->level_count, error);
}

// Turns a cube and harmonics from kiln's axes to the engine's. Allocates the texels of `turned`.
static kiln_result turn(kiln_context *context, const ki_recipe *recipe, const kiln_map *map,
                        const kiln_sh *sh, kiln_map *turned, kiln_sh *turned_sh, kiln_error *error)
{
    *turned = (kiln_map){.shape = KILN_SHAPE_CUBE,
                         .size = map->size,
                         .level_count = map->level_count,
                         .smallest = map->smallest};
    kiln_sh few = *sh;
    few.bands = 3;
    kiln_result result = ki_map_allocate(context, turned, error);
    if (result != KILN_OK)
        return result;
    ki_turn_cube(map, &recipe->axes, turned);
    ki_turn_sh(&few, &recipe->axes, turned_sh);
    return KILN_OK;
}

kiln_result ki_engine_write(ki_file_set *set, kiln_context *context, const kiln_engine *engine,
                            const kiln_map *map, const kiln_sh *sh, const kiln_lights *lights,
                            kiln_format format, const char *path, kiln_save_report *report,
                            kiln_error *error)
{
    const ki_recipe *recipe;
    kiln_result result = find_recipe(engine, &recipe, error);
    if (result != KILN_OK || (result = kiln_engine_format(engine, &format, error)) != KILN_OK ||
        (result = check_path(recipe, format, path, error)) != KILN_OK ||
        (result = check_map(recipe, map, sh, error)) != KILN_OK)
        return result;
    if (!ki_progress(context, "writing", 0))
        return ki_fail_cancelled(error, "writing");
    if (report)
        ki_count_cut(map, format ? kiln_format_limit(format) : engine->limit, report);
    kiln_map turned;
    kiln_sh turned_sh;
    result = turn(context, recipe, map, sh, &turned, &turned_sh, error);
    if (result != KILN_OK)
        return result;
    ki_export to = {.context = context,
                    .map = &turned,
                    .sh = &turned_sh,
                    .lights = lights,
                    .format = format,
                    .path = path,
                    .set = set};
    result = recipe->write(&to, error);
    if (report)
        report->file_count = to.file_count;
    kiln_map_free(&turned);
    return result;
}

typedef struct engine_files {
    kiln_context *context;
    const kiln_engine *engine;
    const kiln_map *map;
    const kiln_sh *sh;
    kiln_format format;
    const char *path;
    kiln_save_report *report;
} engine_files;

static kiln_result add_files(ki_file_set *set, void *data, kiln_error *error)
{
    const engine_files *e = data;
    return ki_engine_write(set, e->context, e->engine, e->map, e->sh, NULL, e->format, e->path,
                           e->report, error);
}

kiln_result kiln_engine_save(kiln_context *context, const kiln_engine *engine, const kiln_map *map,
                             const kiln_sh *sh, kiln_format format, const char *path,
                             kiln_save_report *report, kiln_error *error)
{
    engine_files e = {context, engine, map, sh, format, path, report};
    return ki_save_files(context, add_files, &e, NULL, report, error);
}

kiln_result kiln_engine_encode(kiln_context *context, const kiln_engine *engine,
                               const kiln_map *map, const kiln_sh *sh, kiln_format format,
                               const char *name, kiln_files *files, kiln_save_report *report,
                               kiln_error *error)
{
    engine_files e = {context, engine, map, sh, format, name, report};
    return ki_save_files(context, add_files, &e, files, report, error);
}

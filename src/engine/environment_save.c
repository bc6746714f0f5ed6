// Saves an environment to files or to memory: its levels in the files of kiln or of an engine, its
// irradiance and its harmonics. Either all files appear or none.
#include "codec/lights_text.h"
#include "codec/save.h"
#include "codec/sh_text.h"
#include "engine/engine.h"

#include <string.h>

static const char *const lobe_names[] = {"ggx", "lambert", "charlie", "phong", "custom"};

static kiln_result write_levels(ki_file_set *set, kiln_context *context,
                                const kiln_environment *environment, const char *path,
                                const kiln_environment_save_def *def, kiln_save_report *report,
                                kiln_error *error)
{
    if ((unsigned)environment->lobe > KILN_LOBE_CUSTOM)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "lobe is %d, it must be 0 to %d",
                       (int)environment->lobe, (int)KILN_LOBE_CUSTOM);
    if (environment->lights.count < 0 || environment->lights.count > KILN_MAX_LIGHTS)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "count of lights is %d, it must be 0 to %d",
                       environment->lights.count, KILN_MAX_LIGHTS);
    if (def->engine && def->zstd)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s: no engine's loader reads zstd, leave zstd 0", path);
    if (def->engine)
        return ki_engine_write(set, context, def->engine, &environment->levels, &environment->sh,
                               &environment->lights, def->format, path, report, error);
    const kiln_save_def save = {.format = def->format,
                                .zstd = def->zstd,
                                .sh = environment->sh.bands ? &environment->sh : NULL,
                                .lobe = lobe_names[environment->lobe]};
    return ki_map_write(set, context, &environment->levels, path, &save, report, error);
}

static kiln_result write_irradiance(ki_file_set *set, kiln_context *context,
                                    const kiln_environment *environment,
                                    const kiln_environment_save_def *def, kiln_save_report *report,
                                    kiln_error *error)
{
    bool ktx2 = !strcmp(kiln_path_ending(def->irradiance_path), ".ktx2");
    const kiln_save_def save = {
        .format = def->format, .zstd = ktx2 ? def->zstd : 0, .lobe = lobe_names[KILN_LOBE_LAMBERT]};
    if (!environment->irradiance.size)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s: the environment has no irradiance map to save, bake one or leave "
                       "irradiance_path NULL",
                       def->irradiance_path);
    return ki_map_write(set, context, &environment->irradiance, def->irradiance_path, &save, report,
                        error);
}

typedef struct environment_files {
    kiln_context *context;
    const kiln_environment *environment;
    const char *path;
    const kiln_environment_save_def *def;
    kiln_environment_report report; // what was saved, set by add_files
} environment_files;

static kiln_result add_files(ki_file_set *set, void *data, kiln_error *error)
{
    static const kiln_environment_save_def defaults = {0};
    environment_files *e = data;
    const kiln_environment *environment = e->environment;
    const kiln_environment_save_def *def = e->def ? e->def : &defaults;
    kiln_environment_report *report = &e->report;
    ki_file_set_watch(set, def->watch, def->watch_user);
    kiln_result result =
        write_levels(set, e->context, environment, e->path, def, &report->levels, error);
    if (result == KILN_OK && def->irradiance_path)
        result = write_irradiance(set, e->context, environment, def, &report->irradiance, error);
    if (result == KILN_OK && def->sh_path)
        result =
            ki_sh_write(set, e->context, def->sh ? def->sh : &environment->sh, def->sh_path, error);
    if (result == KILN_OK && def->lights_path)
        result = ki_lights_write(set, e->context, &environment->lights, def->lights_path, error);
    report->file_count = report->levels.file_count + report->irradiance.file_count +
                         (def->sh_path ? 1 : 0) + (def->lights_path ? 1 : 0);
    return result;
}

// Writes an environment to files, or to memory if `files` is not NULL.
static kiln_result write_environment(environment_files *e, kiln_files *files,
                                     kiln_environment_report *report, kiln_error *error)
{
    kiln_result result = ki_file_set_make(e->context, add_files, e, files, error);
    if (report)
        *report = result == KILN_OK ? e->report : (kiln_environment_report){0};
    return result;
}

kiln_result kiln_environment_save(kiln_context *context, const kiln_environment *environment,
                                  const char *path, const kiln_environment_save_def *def,
                                  kiln_environment_report *report, kiln_error *error)
{
    environment_files e = {context, environment, path, def, {0}};
    return write_environment(&e, NULL, report, error);
}

kiln_result kiln_environment_encode(kiln_context *context, const kiln_environment *environment,
                                    const char *name, const kiln_environment_save_def *def,
                                    kiln_files *files, kiln_environment_report *report,
                                    kiln_error *error)
{
    environment_files e = {context, environment, name, def, {0}};
    return write_environment(&e, files, report, error);
}

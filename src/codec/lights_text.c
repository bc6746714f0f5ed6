// Writes lights as JSON.
#include "codec/lights_text.h"

#include "base/bytes.h"
#include "codec/decimal.h"

#include <string.h>

static void write_vector(ki_writer *w, const char *key, const double v[3])
{
    ki_write_text(w, "      \"%s\": [", key);
    for (int k = 0; k < 3; k++) {
        ki_write_text(w, "%s", k ? ", " : "");
        ki_write_number(w, v[k]);
    }
    ki_write_text(w, "],\n");
}

static void write_light(ki_writer *w, const kiln_light *light, bool last)
{
    ki_write_text(w, "    {\n");
    write_vector(w, "direction", light->direction);
    write_vector(w, "irradiance", light->irradiance);
    ki_write_text(w, "      \"angular_radius\": ");
    ki_write_number(w, light->angular_radius);
    ki_write_text(w, ",\n      \"share\": ");
    ki_write_number(w, light->share);
    ki_write_text(w, ",\n      \"texels\": %zu\n    }%s\n", light->texel_count, last ? "" : ",");
}

kiln_result ki_lights_write(ki_file_set *set, kiln_context *context, const kiln_lights *lights,
                            const char *path, kiln_error *error)
{
    if (strcmp(kiln_path_ending(path), ".json") != 0)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: a file of lights must end in .json", path);
    if (lights->count < 0 || lights->count > KILN_MAX_LIGHTS)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "%s: count of lights is %d, it must be 0 to %d",
                       path, lights->count, KILN_MAX_LIGHTS);
    kiln_result result;
    ki_writer w = {.context = context};
    ki_write_text(&w, "{\n  \"lights\": [%s", lights->count ? "\n" : "");
    for (int i = 0; i < lights->count; i++)
        write_light(&w, &lights->light[i], i == lights->count - 1);
    ki_write_text(&w, "%s]\n}\n", lights->count ? "  " : "");
    if (w.failed)
        result = ki_fail_memory(context, error, path, w.size);
    else
        result = ki_file_set_add(set, path, w.bytes, w.size, error);
    ki_writer_free(&w);
    return result;
}

typedef struct lights_file {
    kiln_context *context;
    const kiln_lights *lights;
    const char *path;
} lights_file;

static kiln_result add_file(ki_file_set *set, void *data, kiln_error *error)
{
    const lights_file *file = data;
    return ki_lights_write(set, file->context, file->lights, file->path, error);
}

kiln_result kiln_lights_save(kiln_context *context, const kiln_lights *lights, const char *path,
                             kiln_error *error)
{
    lights_file file = {context, lights, path};
    return ki_file_set_make(context, add_file, &file, NULL, error);
}

// The web page's baker (baker.h), compiled to WebAssembly. In: a file's bytes or the sky's
// parameters. Out: baked levels and harmonics in memory, files in emscripten's file system, and
// reference pictures. libkiln and the viewer's bake and reference do the work, on one thread.
//
#include "baker.h"

#include "reference.h"
#include "viewer.h"

#include <emscripten.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct baker {
    kiln_context *context;
    kiln_error error;
    kiln_map source;
    kiln_load_report report; // what was found in the source picture
    kiln_note note;          // the sentence that was returned last
    kiln_environment baked, scenery;
    kiln_lights taken; // lights that were taken out of the source
    double light[7];   // the light that baker_light returned last
    kiln_image truth;
    double truth_noise;
};

EM_JS(void, tell, (const char *stage, double fraction), {
    if (Module["progress"])
        Module["progress"](UTF8ToString(stage), fraction);
})

static bool progress(void *user, const char *stage, double fraction)
{
    (void)user;
    tell(stage, fraction);
    return true;
}

// Memory limit of the library. WebAssembly memory ends at 2 GiB; what the library leaves holds
// files.
#define MEMORY ((size_t)1800 << 20)

baker *baker_create(void)
{
    baker *b = calloc(1, sizeof *b);
    kiln_context_def def = {.thread_count = 1, .memory_limit = MEMORY, .progress = progress};
    if (b && kiln_context_create(&def, &b->context, &b->error)) {
        free(b);
        return NULL;
    }
    return b;
}

const char *baker_message(const baker *b)
{
    return b->error.message;
}

const char *baker_cpu(const baker *b)
{
    return kiln_context_cpu(b->context);
}

static bool take_source(baker *b, kiln_result result, kiln_map *map, const kiln_load_report *report)
{
    if (result)
        return false;
    kiln_map_free(&b->source);
    b->source = *map;
    b->report = *report;
    b->taken = (kiln_lights){.count = 0};
    return true;
}

bool baker_open(baker *b, const void *bytes, size_t size, const char *name)
{
    kiln_map map;
    kiln_load_report report;
    const kiln_load_def def = {.report = &report};
    return take_source(b, kiln_map_decode(b->context, bytes, size, name, &def, &map, &b->error),
                       &map, &report);
}

bool baker_sky(baker *b, int size, double elevation, double azimuth, double turbidity)
{
    kiln_sky_def def = {.size = size,
                        .elevation = elevation != 0 ? elevation : KILN_ZERO,
                        .azimuth = azimuth,
                        .turbidity = turbidity};
    kiln_map map;
    const kiln_load_report none = {0};
    return take_source(b, kiln_sky(b->context, &def, &map, &b->error), &map, &none);
}

int baker_source_shape(const baker *b)
{
    return (int)b->source.shape;
}

int baker_source_size(const baker *b)
{
    return b->source.size;
}

const float *baker_source_texels(const baker *b)
{
    return b->source.level[0];
}

bool baker_bake(baker *b, int size, int levels, double rotation, double exposure, bool extract)
{
    kiln_bake_def def = {.levels = {.size = size, .level_count = levels, .rotation = rotation},
                         .exposure = exposure,
                         .sun = extract ? KILN_SUN_EXTRACT : KILN_SUN_KEEP};
    kiln_environment made;
    if (!b->source.size || kiln_bake(b->context, &b->source, &def, &made, &b->error))
        return false;
    kiln_environment_free(&b->baked);
    b->baked = made;
    return true;
}

bool baker_extract(baker *b)
{
    return !kiln_lights_extract(b->context, &b->source, NULL, &b->taken, &b->error);
}

int baker_light_count(const baker *b)
{
    return b->taken.count;
}

const double *baker_light(baker *b, int index)
{
    const kiln_light *light = &b->taken.light[index];
    memcpy(b->light, light->direction, sizeof light->direction);
    memcpy(b->light + 3, light->irradiance, sizeof light->irradiance);
    b->light[6] = light->angular_radius;
    return b->light;
}

const char *baker_light_words(baker *b)
{
    const kiln_light *light = &b->taken.light[0];
    if (b->taken.count)
        snprintf(b->note.text, sizeof b->note.text,
                 "a light of radius %.3g degrees with %.3g %% of the light shines in place of its "
                 "texels",
                 light->angular_radius, 100 * light->share);
    else
        snprintf(b->note.text, sizeof b->note.text,
                 "no compact light was found, and nothing was taken out");
    return b->note.text;
}

const char *baker_note(baker *b, int index)
{
    int count = 0;
    while (kiln_load_report_note(&b->report, count, &b->note)) {
        if (count == index)
            return b->note.text;
        count++;
    }
    return index == count && kiln_cut_note(&b->report, &b->baked.levels_cut, &b->note)
               ? b->note.text
               : NULL;
}

int baker_level_count(const baker *b)
{
    return b->baked.levels.level_count;
}

int baker_level_size(const baker *b, int level)
{
    return kiln_map_level_size(&b->baked.levels, level);
}

double baker_roughness(const baker *b, int level)
{
    return (double)b->baked.levels.roughness[level];
}

const float *baker_texels(const baker *b, int level)
{
    return b->baked.levels.level[level];
}

const double *baker_harmonics(const baker *b)
{
    return &b->baked.sh.c[0][0];
}

bool baker_scenery(baker *b, int size, int samples)
{
    kiln_environment_free(&b->scenery);
    return !view_bake(b->context, &b->source, size, samples, &b->scenery, &b->error);
}

int baker_scenery_levels(const baker *b)
{
    return b->scenery.levels.level_count;
}

int baker_scenery_size(const baker *b, int level)
{
    return level < 0 ? b->scenery.irradiance.size : kiln_map_level_size(&b->scenery.levels, level);
}

double baker_scenery_roughness(const baker *b, int level)
{
    return (double)b->scenery.levels.roughness[level];
}

const float *baker_scenery_texels(const baker *b, int level)
{
    return level < 0 ? b->scenery.irradiance.level[0] : b->scenery.levels.level[level];
}

const double *baker_scenery_harmonics(const baker *b)
{
    return &b->scenery.sh.c[0][0];
}

bool baker_table(baker *b, const char *path, int kind)
{
    static const kiln_table_kind kinds[] = {KILN_TABLE_E, KILN_TABLE_E_AVERAGE, KILN_TABLE_DFG};
    kiln_table_def def = {.kind = kinds[kind < 0 || kind > 2 ? 0 : kind]};
    kiln_table table;
    bool good = !kiln_table_create(b->context, &def, &table, &b->error) &&
                !kiln_table_save(b->context, &table, path, NULL, &b->error);
    kiln_table_free(&table);
    return good;
}

bool baker_truth(baker *b, const double *numbers, int width, int height, double noise, bool alone)
{
    view_options options = view_from_numbers(numbers);
    view_reference_def def = {.noise = noise,
                              .alone = alone,
                              .lights = &b->taken,
                              .thread_count = 1,
                              .progress = progress};
    view_reference_report report = {0};
    kiln_image_free(&b->truth);
    bool good = !view_reference(b->context, &options, &b->source, width, height, &def, &b->truth,
                                &report, &b->error);
    b->truth_noise = report.noise;
    return good;
}

const float *baker_truth_texels(const baker *b)
{
    return b->truth.pixels;
}

double baker_truth_noise(const baker *b)
{
    return b->truth_noise;
}

bool baker_save_irradiance(baker *b, const char *path, int format)
{
    kiln_save_def def = {.format = (kiln_format)format, .lobe = "lambert"};
    return !kiln_map_save(b->context, &b->baked.irradiance, path, &def, NULL, &b->error);
}

bool baker_save_lights(baker *b, const char *path)
{
    return !kiln_lights_save(b->context, &b->baked.lights, path, &b->error);
}

bool baker_save(baker *b, const char *path, int format)
{
    const char *dot = strrchr(path, '.');
    bool texture = dot && (!strcmp(dot, ".ktx2") || !strcmp(dot, ".dds"));
    kiln_save_def def = {.format = (kiln_format)format, .sh = &b->baked.sh, .lobe = "ggx"};
    return !(texture ? kiln_map_save(b->context, &b->baked.levels, path, &def, NULL, &b->error)
                     : kiln_sh_save(b->context, &b->baked.sh, path, &b->error));
}

// The web page's baker (baker.h), compiled to WebAssembly. In: a file's bytes or the sky's
// parameters. Out: baked levels and harmonics in memory, files in emscripten's file system, and
// reference pictures. libkiln and the viewer's bake and reference do the work, on one thread.
//
#include "baker.h"

#include "reference.h"
#include "turn.h"
#include "viewer.h"

#include <emscripten.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct baker {
    kiln_context *context;
    kiln_error error;
    kiln_map source;
    kiln_load_report report; // what was found in the source picture
    kiln_note note;          // the sentence that was returned last
    kiln_bake_def def;       // the options of baker_options
    kiln_environment baked, scenery;
    kiln_lights taken; // lights that were taken out of the source
    double light[7];   // the light that baker_light returned last
    kiln_files files;  // files of the last baker_engine_files
    kiln_environment_report written;
    double histogram[BAKER_STOPS];
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

const float *baker_source_texels(const baker *b)
{
    return b->source.level[0];
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

void baker_options(baker *b, double yaw, double pitch, double roll, double exposure, int sun,
                   int light_count, double clamp)
{
    b->def = (kiln_bake_def){
        .levels = {.rotation = yaw, .pitch = pitch, .roll = roll},
        .exposure = exposure,
        .sun = (kiln_sun)sun,
        .lights = {.count = light_count},
        .clamp = clamp,
    };
}

void baker_place(baker *b, int up, bool mirror)
{
    b->def.levels.up = (kiln_up)up;
    b->def.mirror = mirror;
}

bool baker_bake(baker *b, int size, int levels)
{
    kiln_bake_def def = b->def;
    kiln_environment made;
    def.levels.size = size;
    def.levels.level_count = levels;
    if (!b->source.size || kiln_bake(b->context, &b->source, &def, &made, &b->error))
        return false;
    kiln_environment_free(&b->baked);
    b->baked = made;
    return true;
}

// Mirrors and turns the source as the options say, except about the vertical axis.
static bool turn_source(baker *b)
{
    const kiln_prefilter_def *levels = &b->def.levels;
    kiln_map turned;
    if (b->def.mirror)
        kiln_map_mirror(&b->source);
    if (levels->pitch == 0 && levels->roll == 0 && levels->up == KILN_UP_Y)
        return true;
    if (turn_map(b->context, &b->source, levels->pitch, levels->roll, levels->up, &turned,
                 &b->error))
        return false;
    kiln_map_free(&b->source);
    b->source = turned;
    return true;
}

bool baker_sun(baker *b)
{
    const kiln_bake_def *def = &b->def;
    if (!turn_source(b))
        return false;
    if (def->sun == KILN_SUN_EXTRACT)
        return !kiln_lights_extract(b->context, &b->source, &def->lights, &b->taken, &b->error);
    return def->sun != KILN_SUN_CLAMP ||
           !kiln_map_clamp(b->context, &b->source, def->clamp * exp2(-def->exposure), NULL,
                           &b->error);
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

// Writes a sentence about what the options did with the lights of the last bake.
static bool sun_note(baker *b, const kiln_environment *made)
{
    const kiln_lights *lights = &made->lights;
    double share = 0;
    for (int i = 0; i < lights->count; i++)
        share += lights->light[i].share;
    if (b->def.sun == KILN_SUN_CLAMP)
        snprintf(b->note.text, sizeof b->note.text,
                 "%zu texels above %.4g were made as dark as this, which lost %.3g %% of the light",
                 made->clamped.texel_count, made->clamped.limit, 100 * made->clamped.light_share);
    else if (b->def.sun == KILN_SUN_EXTRACT && !lights->count)
        snprintf(b->note.text, sizeof b->note.text,
                 "no compact light was found, and nothing was taken out");
    else if (lights->count == 1)
        snprintf(b->note.text, sizeof b->note.text,
                 "a light of radius %.3g degrees with %.3g %% of the light shines in place of its "
                 "texels",
                 lights->light[0].angular_radius, 100 * share);
    else
        snprintf(b->note.text, sizeof b->note.text,
                 "%d lights with %.3g %% of the light shine in place of their texels",
                 lights->count, 100 * share);
    return b->def.sun != KILN_SUN_KEEP;
}

const char *baker_note(baker *b, int index)
{
    int count = 0;
    while (kiln_load_report_note(&b->report, count, &b->note)) {
        if (count == index)
            return b->note.text;
        count++;
    }
    if (kiln_cut_note(&b->report, &b->baked.levels_cut, &b->note) && count++ == index)
        return b->note.text;
    return sun_note(b, &b->baked) && count == index ? b->note.text : NULL;
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

kiln_context *baker_context(baker *b)
{
    return b->context;
}

kiln_error *baker_error(baker *b)
{
    return &b->error;
}

const kiln_map *baker_source(const baker *b)
{
    return &b->source;
}

void baker_take_levels(baker *b, kiln_map *levels)
{
    kiln_map_free(&b->scenery.levels);
    b->scenery.levels = *levels;
    *levels = (kiln_map){0};
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

// ----------------------------------------------------------------------------------------- engines

const char *baker_engine_text(int index, int what)
{
    const kiln_engine *engine = kiln_engine_at(index);
    return !engine     ? NULL
           : what == 0 ? engine->name
           : what == 1 ? engine->title
           : what == 2 ? engine->files
                       : engine->ending;
}

int baker_engine_number(int index, int what)
{
    const kiln_engine *engine = kiln_engine_at(index);
    return !engine     ? 0
           : what == 0 ? engine->size
           : what == 1 ? engine->tune
                       : (int)engine->formats[what < 6 ? what - 2 : 3];
}

const char *baker_format_name(int format)
{
    return kiln_format_names()[format];
}

bool baker_engine_files(baker *b, int index, int size, int tune, int format, const char *name,
                        const char *lights_name)
{
    const kiln_engine *engine = kiln_engine_at(index);
    kiln_bake_def def = b->def;
    kiln_environment made;
    def.engine = engine;
    def.tune = (kiln_tune)tune;
    def.levels.size = size;
    def.irradiance_size = KILN_NO_IRRADIANCE;
    kiln_environment_save_def save = {.engine = engine, .format = (kiln_format)format};
    kiln_files_free(&b->files);
    if (!engine || kiln_bake(b->context, &b->source, &def, &made, &b->error))
        return false;
    if (lights_name[0])
        save.lights_path = lights_name;
    bool good =
        !kiln_environment_encode(b->context, &made, name, &save, &b->files, &b->written, &b->error);
    kiln_environment_free(&made);
    return good;
}

int baker_file_count(const baker *b)
{
    return b->files.count;
}

const char *baker_file_name(const baker *b, int index)
{
    return b->files.file[index].name;
}

const unsigned char *baker_file_bytes(const baker *b, int index)
{
    return b->files.file[index].bytes;
}

size_t baker_file_size(const baker *b, int index)
{
    return b->files.file[index].size;
}

const char *baker_files_note(baker *b)
{
    const kiln_save_report *r = &b->written.levels;
    snprintf(b->note.text, sizeof b->note.text,
             "%zu values above %g, up to %.4g, were cut off with %.3g %% of the light, because the "
             "file holds no larger values",
             r->cut_count, r->limit, r->largest, 100 * r->light_share);
    return r->cut_count ? b->note.text : NULL;
}

// --------------------------------------------------------------------------------------- histogram

const double *baker_histogram(baker *b)
{
    const kiln_map *map = &b->source;
    size_t size = (size_t)map->size, width = size * (map->shape == KILN_SHAPE_PANORAMA ? 2 : 1);
    size_t rows = map->shape == KILN_SHAPE_CUBE ? 6 * size : size;
    const float *texel = map->level[0];
    double sum = 0;
    memset(b->histogram, 0, sizeof b->histogram);
    for (size_t y = 0; y < rows; y++) {
        double weight = map->shape == KILN_SHAPE_PANORAMA
                            ? sin(3.14159265358979323846 * ((double)y + 0.5) / (double)rows)
                            : 1;
        for (size_t x = 0; x < width; x++, texel += 3) {
            double peak = fmax((double)texel[0], fmax((double)texel[1], (double)texel[2]));
            int stop = peak > 0 ? (int)floor(log2(peak)) - BAKER_FIRST_STOP : 0;
            b->histogram[stop < 0 ? 0 : stop < BAKER_STOPS ? stop : BAKER_STOPS - 1] += weight;
            sum += weight;
        }
    }
    for (int i = 0; i < BAKER_STOPS; i++)
        b->histogram[i] /= sum;
    return b->histogram;
}

double baker_largest(const baker *b)
{
    const kiln_map *map = &b->source;
    size_t size = (size_t)map->size, count = size * size * 3;
    count *= map->shape == KILN_SHAPE_PANORAMA ? 2 : map->shape == KILN_SHAPE_CUBE ? 6 : 1;
    float largest = 0;
    for (size_t i = 0; i < count; i++)
        largest = fmaxf(largest, map->level[0][i]);
    return (double)largest;
}

// ------------------------------------------------------------------------------------------- files

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

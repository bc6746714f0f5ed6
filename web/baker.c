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
    kiln_map source, baked, irradiance;
    kiln_sh sh;
    view_environment scenery;
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

// Memory of a page ends at 2 GiB; a part of that is kept for files.
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

static bool take_source(baker *b, kiln_result result, kiln_map *map)
{
    if (result)
        return false;
    kiln_map_free(&b->source);
    b->source = *map;
    return true;
}

bool baker_open(baker *b, const void *bytes, size_t size, const char *name)
{
    kiln_map map;
    return take_source(b, kiln_map_decode(b->context, bytes, size, name, NULL, &map, &b->error),
                       &map);
}

bool baker_sky(baker *b, int size, double elevation, double azimuth, double turbidity)
{
    kiln_sky_def def = {.size = size,
                        .elevation = elevation,
                        .has_elevation = true,
                        .azimuth = azimuth,
                        .turbidity = turbidity};
    kiln_map map;
    return take_source(b, kiln_sky(b->context, &def, &map, &b->error), &map);
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

static kiln_result exposed(baker *b, double stops, kiln_map *map)
{
    kiln_result result =
        kiln_map_create(b->context, b->source.shape, b->source.size, 1, map, &b->error);
    if (result)
        return result;
    memcpy(map->level[0], b->source.level[0], 3 * sizeof(float) * kiln_map_texels(map, 0));
    kiln_map_expose(map, stops);
    return KILN_OK;
}

// The harmonics that `kiln bake` stores: of the filter's spectrum where that has enough degrees.
static kiln_result harmonics(baker *b, const kiln_map *source, const kiln_spectrum *spectrum,
                             double rotation)
{
    kiln_spectrum *own = NULL;
    kiln_result result = KILN_OK;
    int wanted = 2 * source->size < KILN_MAX_BANDS ? 2 * source->size : KILN_MAX_BANDS;
    if (!spectrum || kiln_spectrum_degree(spectrum) < wanted) {
        result = kiln_spectrum_analyze(b->context, source, wanted, &own, &b->error);
        spectrum = own;
    }
    if (!result)
        result = kiln_spectrum_sh(spectrum, 3, false, 0, rotation, &b->sh, &b->error);
    kiln_spectrum_destroy(own);
    return result;
}

// The irradiance that `kiln bake --irradiance` makes: the cosine is filtered up to degree 303.
static kiln_result irradiance(baker *b, const kiln_map *source, const kiln_spectrum *spectrum,
                              double rotation, kiln_map *map)
{
    enum { DEGREE = 320, SIZE = 64 };
    kiln_spectrum *own = NULL;
    kiln_lobe lambert = kiln_lobe_lambert();
    kiln_result result = kiln_map_create(b->context, KILN_SHAPE_CUBE, SIZE, 1, map, &b->error);
    if (!result && (!spectrum || kiln_spectrum_degree(spectrum) < DEGREE)) {
        result = kiln_spectrum_analyze(b->context, source, DEGREE, &own, &b->error);
        spectrum = own;
    }
    if (!result)
        result = kiln_spectrum_filter(b->context, spectrum, &lambert, rotation, map, 0, &b->error);
    kiln_spectrum_destroy(own);
    map->roughness[0] = 1;
    return result;
}

static kiln_result beside(baker *b, const kiln_map *source, const kiln_spectrum *spectrum,
                          double rotation, kiln_map *diffuse)
{
    kiln_result result = harmonics(b, source, spectrum, rotation);
    return result ? result : irradiance(b, source, spectrum, rotation, diffuse);
}

static kiln_result filter(baker *b, const kiln_map *source, const kiln_prefilter_def *def,
                          kiln_map *map, kiln_map *diffuse)
{
    kiln_plan *plan = NULL;
    kiln_result result;
    if (source->shape != KILN_SHAPE_PANORAMA) {
        result = kiln_prefilter(b->context, source, def, map, &b->error);
        return result ? result : beside(b, source, NULL, def->rotation, diffuse);
    }
    if ((result = kiln_plan_create(b->context, source->size, def, &plan, &b->error)) == KILN_OK &&
        (result = kiln_plan_map(plan, map, &b->error)) == KILN_OK &&
        (result = kiln_plan_execute(plan, source, map, &b->error)) == KILN_OK)
        result = beside(b, source, kiln_plan_spectrum(plan), def->rotation, diffuse);
    kiln_plan_destroy(plan);
    return result;
}

bool baker_bake(baker *b, int size, int levels, double rotation, double exposure)
{
    kiln_prefilter_def def = {.size = size, .level_count = levels, .rotation = rotation};
    kiln_map brighter = {0}, map = {0}, diffuse = {0};
    kiln_sh before = b->sh;
    kiln_result result = KILN_OK;
    if (!b->source.size)
        result = KILN_ERROR_ARGUMENT;
    else if (exposure != 0)
        result = exposed(b, exposure, &brighter);
    if (!result)
        result = filter(b, exposure != 0 ? &brighter : &b->source, &def, &map, &diffuse);
    kiln_map_free(&brighter);
    if (result) {
        kiln_map_free(&map);
        kiln_map_free(&diffuse);
        b->sh = before;
        return false;
    }
    kiln_map_free(&b->baked);
    b->baked = map;
    kiln_map_free(&b->irradiance);
    b->irradiance = diffuse;
    return true;
}

int baker_level_count(const baker *b)
{
    return b->baked.level_count;
}

int baker_level_size(const baker *b, int level)
{
    return kiln_map_level_size(&b->baked, level);
}

double baker_roughness(const baker *b, int level)
{
    return (double)b->baked.roughness[level];
}

const float *baker_texels(const baker *b, int level)
{
    return b->baked.level[level];
}

const double *baker_harmonics(const baker *b)
{
    return &b->sh.c[0][0];
}

bool baker_scenery(baker *b, int size, int samples)
{
    view_environment_free(&b->scenery);
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
    view_options options = numbers_to(numbers);
    view_reference_def def = {
        .noise = noise, .alone = alone, .thread_count = 1, .progress = progress};
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
    return !kiln_map_save(b->context, &b->irradiance, path, &def, NULL, &b->error);
}

bool baker_save(baker *b, const char *path, int format)
{
    const char *dot = strrchr(path, '.');
    bool texture = dot && (!strcmp(dot, ".ktx2") || !strcmp(dot, ".dds"));
    kiln_save_def def = {.format = (kiln_format)format, .sh = &b->sh, .lobe = "ggx"};
    return !(texture ? kiln_map_save(b->context, &b->baked, path, &def, NULL, &b->error)
                     : kiln_sh_save(b->context, &b->sh, path, &b->error));
}

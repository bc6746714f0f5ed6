// Baking of an environment. In: a map of any shape. Out: prefiltered levels, irradiance and
// spherical harmonics. Every bake runs this sequence:
//
//   source -> mirrored, exposed -> lights taken out or clamped      (bake/lights.c)
//                               -> panorama -> spectrum -> levels      (bake/prefilter.c)
//                                                       -> harmonics   (sphere/sh.c)
//                                                       -> irradiance  (a level of the cosine lobe)
//
// All of these steps are linear, whatever signs the texels have. At the end, values below zero in
// levels and irradiance become 0 and are counted; harmonics have signs and stay as they are.
//
// A plan holds everything that depends only on sizes, and all memory that an execution needs. A
// source panorama is analysed once if the analysis reaches the degree that the irradiance needs. A
// panorama made from another shape is analysed again, to a low degree, for harmonics and
// irradiance. That costs little, and the bits of harmonics and irradiance then do not depend on
// which levels are computed.
#include "bake/environment.h"

#include "bake/lights.h"
#include "bake/low_analysis.h"
#include "bake/rows.h"
#include "image/light.h"
#include "math/math.h"
#include "sphere/grid.h"
#include "sphere/sh.h"

#include <math.h>
#include <string.h>

enum {
    // Number of suns that a plan has memory for from the beginning. A sun is a single texel that
    // holds more than a thousandth of all light.
    RESERVED_SUNS = 64
};

// The memory that the executions of a plan use, one execution after the other.
typedef struct plan_workspace {
    // the changed copy of the source; empty if the plan neither mirrors nor exposes the source and
    // keeps its lights
    kiln_map changed;
    // the panorama that is made from a source of another shape; empty if the source is a panorama
    kiln_map panorama;
    ki_prefilter_workspace prefilter;
    // workspaces of the separate analyses for harmonics and for irradiance; empty where the plan
    // has no such analysis
    ki_low_workspace for_sh, for_irradiance;
    bool has_scratch;
    ki_scratch scratch; // memory that one execution uses and frees, see ki_scratch
} plan_workspace;

// No field but `workspace` changes after the plan is made.
struct kiln_plan {
    kiln_context *context;
    kiln_shape source_shape;
    int source_size;
    bool mirror;
    double exposure, rotation;
    kiln_sun sun;
    kiln_lights_def lights;
    double clamp;
    bool rows; // true: the plan is made to be executed row by row
    // Size of the irradiance map, or 0 for no such map; number of bands of harmonics, or 0 for no
    // harmonics.
    int irradiance_size, sh_bands;
    // resampling of the source to a panorama; NULL if the source is a panorama
    ki_resample_plan *to_panorama;
    ki_prefilter *prefilter;
    // The separate analyses to a low degree for harmonics and for irradiance; NULL where the
    // spectrum of `prefilter` serves instead.
    ki_analysis *for_sh, *for_irradiance;
    // the irradiance map as a level that is filtered by the cosine lobe; NULL for no such map
    ki_level *irradiance;
    plan_workspace workspace;
};

// ---------------------------------------------------------------------------------------- analysis

// Finds the spectrum that `analysis`, to a low degree, computes from the panorama, or the spectrum
// of the prefiltered levels if `analysis` is NULL. If `panorama` is NULL, the rows have passed by
// and the spectrum is in the workspace already.
static kiln_result find_spectrum(const plan_workspace *w, const ki_analysis *analysis,
                                 const ki_low_workspace *low, const kiln_map *panorama,
                                 const kiln_spectrum **spectrum, kiln_error *error)
{
    *spectrum = analysis ? low->spectrum : w->prefilter.spectrum;
    if (analysis && panorama &&
        !ki_analysis_execute(analysis, low->analysis, panorama->level[0], low->spectrum))
        return ki_fail_cancelled(error, "filtering");
    return KILN_OK;
}

// -------------------------------------------------------------------------------------------- plan

static kiln_result check_def(const ki_plan_def *def, kiln_error *error)
{
    int most = def->source_shape == KILN_SHAPE_PANORAMA ? KILN_MAX_SIZE / 2 : KILN_MAX_SIZE;
    if (def->source_shape < KILN_SHAPE_PANORAMA || def->source_shape > KILN_SHAPE_OCTAHEDRON)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "source_shape is %d, it must be %d to %d",
                       (int)def->source_shape, (int)KILN_SHAPE_PANORAMA,
                       (int)KILN_SHAPE_OCTAHEDRON);
    if (def->source_size < 1 || def->source_size > most)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "source_size is %d, it must be 1 to %d",
                       def->source_size, most);
    if (!(fabs(def->exposure) <= 600))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "exposure is %g stops, it must be -600 to 600",
                       def->exposure);
    if (def->irradiance_size < 0 || def->irradiance_size > KILN_MAX_SIZE)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "irradiance_size is %d, it must be 1 to %d",
                       def->irradiance_size, KILN_MAX_SIZE);
    if (def->sh_bands < 0 || def->sh_bands > KILN_MAX_BANDS)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "sh_bands is %d, it must be 1 to %d",
                       def->sh_bands, KILN_MAX_BANDS);
    if ((unsigned)def->sun > KILN_SUN_CLAMP)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "sun is %d, it must be 0 to %d", (int)def->sun,
                       (int)KILN_SUN_CLAMP);
    if (!(def->clamp >= 0))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "clamp is %g, it must be 0 or more", def->clamp);
    return ki_lights_check(&def->lights, error);
}

// Allocates memory for the mirrored and exposed source and for the panorama made from it, and plans
// the conversion to a panorama.
static kiln_result plan_source(kiln_plan *p, kiln_error *error)
{
    kiln_result result = KILN_OK;
    plan_workspace *w = &p->workspace;
    if (!p->rows && (p->mirror || p->exposure != 0 || p->sun != KILN_SUN_KEEP)) {
        w->changed = (kiln_map){.shape = p->source_shape, .size = p->source_size, .level_count = 1};
        result = ki_map_allocate(p->context, &w->changed, error);
    }
    if (result != KILN_OK || p->source_shape == KILN_SHAPE_PANORAMA)
        return result;
    int rows = ki_panorama_rows(p->source_shape, p->source_size);
    w->panorama = (kiln_map){.shape = KILN_SHAPE_PANORAMA, .size = rows, .level_count = 1};
    result = ki_map_allocate(p->context, &w->panorama, error);
    if (result == KILN_OK)
        result =
            ki_resample_plan_create(p->context, p->source_shape, p->source_size,
                                    KILN_SHAPE_PANORAMA, rows, NULL, 0, &p->to_panorama, error);
    return result;
}

// Plans the prefiltered levels. Allocates the memory that their executions and the conversion of
// the source to a panorama work on.
static kiln_result plan_levels(kiln_plan *p, const ki_plan_def *def, int rows, kiln_error *error)
{
    kiln_map source = {.shape = def->source_shape, .size = def->source_size, .level_count = 1};
    ki_prefilter_workspace *w = &p->workspace.prefilter;
    kiln_result result = ki_prefilter_create(p->context, rows, p->to_panorama ? &source : NULL,
                                             def->levels, def->reading, &p->prefilter, error);
    if (result == KILN_OK)
        result = ki_prefilter_workspace_create(p->context, p->prefilter, w, error);
    if (result == KILN_OK && p->to_panorama)
        result = ki_resample_reserve(p->context, p->to_panorama, &w->resampling, error);
    if (result == KILN_OK)
        p->rotation = p->prefilter->def.rotation;
    return result;
}

static kiln_result plan_irradiance(kiln_plan *p, int rows, kiln_error *error)
{
    const ki_analysis *analysis = p->prefilter->analysis;
    kiln_result result = KILN_OK;
    if (p->to_panorama || analysis->degree < KI_IRRADIANCE_DEGREE) {
        result = ki_low_create(p->context, rows, KI_IRRADIANCE_DEGREE, &p->for_irradiance,
                               &p->workspace.for_irradiance, error);
        analysis = p->for_irradiance;
    }
    kiln_lobe lambert = kiln_lobe_lambert();
    ki_zonal zonal;
    ki_zonal_spectrum lobe = {0};
    if (result == KILN_OK)
        result =
            ki_lobe_spectrum(p->context, &lambert, ki_lobe_tolerance, false, &zonal, &lobe, error);
    if (result == KILN_OK)
        result =
            ki_level_create(p->context, &analysis->legendre, &zonal, &lobe, p->prefilter->def.shape,
                            p->irradiance_size, &p->prefilter->tilt, &p->irradiance, error);
    if (result == KILN_OK)
        result = ki_level_reserve(p->context, p->irradiance, &p->workspace.prefilter.levels, error);
    return result;
}

kiln_result ki_plan_create(kiln_context *context, const ki_plan_def *def, kiln_plan **plan,
                           kiln_error *error)
{
    *plan = NULL;
    kiln_result result = check_def(def, error);
    if (result != KILN_OK)
        return result;
    kiln_plan *p = ki_alloc(context, 1, sizeof *p);
    if (!p)
        return ki_fail_memory(context, error, "a plan", sizeof *p);
    *p = (kiln_plan){.context = context,
                     .source_shape = def->source_shape,
                     .source_size = def->source_size,
                     .mirror = def->mirror,
                     .exposure = def->exposure,
                     .irradiance_size = def->irradiance_size,
                     .sh_bands = def->sh_bands,
                     .sun = def->sun,
                     .lights = def->lights,
                     .clamp = def->clamp,
                     .rows = def->rows};
    int rows = ki_panorama_rows(def->source_shape, def->source_size);
    result = plan_source(p, error);
    if (result == KILN_OK)
        result = plan_levels(p, def, rows, error);
    if (result == KILN_OK && p->sh_bands && p->to_panorama)
        result =
            ki_low_create(context, rows, KI_SH_DEGREE, &p->for_sh, &p->workspace.for_sh, error);
    if (result == KILN_OK && p->irradiance_size)
        result = plan_irradiance(p, rows, error);
    if (result == KILN_OK)
        *plan = p;
    else
        kiln_plan_destroy(p);
    return result;
}

void kiln_plan_destroy(kiln_plan *plan)
{
    if (!plan)
        return;
    plan_workspace *w = &plan->workspace;
    ki_scratch_free(&w->scratch);
    ki_low_free(&w->for_sh);
    ki_low_free(&w->for_irradiance);
    ki_prefilter_workspace_free(&w->prefilter);
    kiln_map_free(&w->panorama);
    kiln_map_free(&w->changed);
    ki_level_destroy(plan->irradiance);
    ki_analysis_destroy(plan->for_sh);
    ki_analysis_destroy(plan->for_irradiance);
    ki_prefilter_destroy(plan->prefilter);
    ki_resample_plan_destroy(plan->to_panorama);
    ki_free(plan);
}

kiln_result kiln_plan_environment(const kiln_plan *plan, kiln_environment *environment,
                                  kiln_error *error)
{
    const kiln_prefilter_def *def = &plan->prefilter->def;
    *environment = (kiln_environment){.lobe = def->lobe};
    environment->levels = (kiln_map){.shape = def->shape,
                                     .size = def->size,
                                     .level_count = def->level_count,
                                     .smallest = def->smallest};
    kiln_result result = ki_map_allocate(plan->context, &environment->levels, error);
    if (result == KILN_OK && plan->irradiance_size) {
        environment->irradiance =
            (kiln_map){.shape = def->shape, .size = plan->irradiance_size, .level_count = 1};
        result = ki_map_allocate(plan->context, &environment->irradiance, error);
    }
    if (result != KILN_OK) {
        kiln_environment_free(environment);
        return result;
    }
    for (int i = 0; i < def->level_count; i++)
        environment->levels.roughness[i] = plan->prefilter->roughness[i];
    environment->irradiance.roughness[0] = plan->irradiance_size ? 1 : 0;
    return KILN_OK;
}

const kiln_spectrum *kiln_plan_spectrum(const kiln_plan *plan)
{
    return plan->workspace.prefilter.spectrum;
}

// --------------------------------------------------------------------------------------- execution

static const char *const shape_names[] = {"", "panoramas", "cubes", "octahedra"};

static kiln_result check_source(const kiln_plan *p, const kiln_map *source, kiln_error *error)
{
    kiln_result result = ki_map_check(source, error);
    if (result == KILN_OK && (source->shape != p->source_shape || source->size != p->source_size))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the plan takes %s of size %d, the source is one of the %s of size %d",
                       shape_names[p->source_shape], p->source_size, shape_names[source->shape],
                       source->size);
    return result;
}

static kiln_result check_target(const kiln_plan *p, const kiln_environment *environment,
                                kiln_error *error)
{
    const kiln_prefilter_def *def = &p->prefilter->def;
    const kiln_map *map = &environment->levels, *irradiance = &environment->irradiance;
    kiln_result result = ki_map_check(map, error);
    if (result == KILN_OK && p->irradiance_size)
        result = ki_map_check(irradiance, error);
    if (result != KILN_OK)
        return result;
    if (map->shape != def->shape || map->size != def->size || map->level_count != def->level_count)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the plan writes a map of shape %d, size %d and %d levels, but levels is a "
                       "map of shape %d, size %d and %d levels",
                       (int)def->shape, def->size, def->level_count, (int)map->shape, map->size,
                       map->level_count);
    if (map->smallest != def->smallest)
        return ki_fail(
            error, KILN_ERROR_ARGUMENT,
            "the plan writes a map with smallest %d, but levels is a map with smallest %d",
            def->smallest, map->smallest);
    if (p->irradiance_size &&
        (irradiance->shape != def->shape || irradiance->size != p->irradiance_size))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the plan writes irradiance of shape %d and size %d, but irradiance is a "
                       "map of shape %d and size %d",
                       (int)def->shape, p->irradiance_size, (int)irradiance->shape,
                       irradiance->size);
    return KILN_OK;
}

// Takes lights out of the changed source, or clamps it, as far as the plan says.
static kiln_result take_lights(const kiln_plan *p, kiln_map *changed, kiln_environment *environment,
                               kiln_error *error)
{
    if (p->sun == KILN_SUN_CLAMP)
        return kiln_map_clamp(p->context, changed, p->clamp, &environment->clamped, error);
    if (p->sun == KILN_SUN_KEEP)
        return KILN_OK;
    kiln_lights *lights = &environment->lights;
    kiln_result result = kiln_lights_extract(p->context, changed, &p->lights, lights, error);
    for (int i = 0; i < lights->count; i++) {
        double *d = lights->light[i].direction;
        const double unturned[3] = {d[0], d[1], d[2]};
        ki_turn(unturned, -p->rotation, d);
        ki_tilt_undo(&p->prefilter->tilt, d);
    }
    return result;
}

// Mirrors and exposes the source, takes lights out and converts the result to a panorama, as far as
// the plan says. *source then points to the changed map.
static kiln_result take_source(const kiln_plan *p, plan_workspace *w, const kiln_map **source,
                               const kiln_map **panorama, kiln_environment *environment,
                               kiln_error *error)
{
    static const ki_progress_range range = {"converting", 0, 1};
    kiln_result result = KILN_OK;
    if (w->changed.size) {
        memcpy(w->changed.level[0], (*source)->level[0],
               3 * sizeof(float) * kiln_map_texels(*source, 0));
        if (p->mirror)
            kiln_map_mirror(&w->changed);
        kiln_map_expose(&w->changed, p->exposure);
        result = take_lights(p, &w->changed, environment, error);
        *source = &w->changed;
    }
    *panorama = *source;
    if (!p->to_panorama || result != KILN_OK)
        return result;
    *panorama = &w->panorama;
    return ki_resample_execute(p->context, p->to_panorama, &w->prefilter.resampling,
                               (*source)->level[0], w->panorama.level[0], &range)
               ? KILN_OK
               : ki_fail_cancelled(error, range.name);
}

// Computes harmonics and irradiance after the levels, and removes values below zero. `panorama` is
// NULL if its rows have passed by.
static kiln_result finish(const kiln_plan *p, plan_workspace *w, const kiln_map *panorama,
                          kiln_environment *environment, kiln_error *error)
{
    kiln_result result = KILN_OK;
    const kiln_spectrum *spectrum = NULL;
    if (p->sh_bands)
        result = find_spectrum(w, p->for_sh, &w->for_sh, panorama, &spectrum, error);
    if (result == KILN_OK && p->sh_bands)
        result = ki_sh_project(spectrum, p->sh_bands, &p->prefilter->tilt, p->rotation,
                               &environment->sh, error);
    if (result == KILN_OK && p->irradiance_size)
        result =
            find_spectrum(w, p->for_irradiance, &w->for_irradiance, panorama, &spectrum, error);
    if (result == KILN_OK && p->irradiance_size)
        result = ki_level_execute(p->irradiance, &w->prefilter.levels, spectrum, NULL, p->rotation,
                                  &environment->irradiance, 0, NULL, error);
    if (result == KILN_OK)
        ki_cut_negative(p->context, &environment->levels, 0, environment->levels.level_count,
                        &environment->levels_cut);
    environment->irradiance_cut = (kiln_cut){0};
    if (result == KILN_OK && p->irradiance_size)
        ki_cut_negative(p->context, &environment->irradiance, 0, 1, &environment->irradiance_cut);
    return result;
}

static kiln_result execute_all(const kiln_plan *p, plan_workspace *w, const kiln_map *source,
                               bool rehearses, kiln_environment *environment, kiln_error *error)
{
    const kiln_map *panorama;
    kiln_result result = take_source(p, w, &source, &panorama, environment, error);
    if (result == KILN_OK)
        result = ki_prefilter_execute(p->prefilter, &w->prefilter, panorama, source, rehearses,
                                      &environment->levels, error);
    return result == KILN_OK ? finish(p, w, panorama, environment, error) : result;
}

// Empties what an execution reports in the environment, and says how the environment was computed.
static void begin_environment(const kiln_plan *p, kiln_environment *environment)
{
    environment->lights.count = 0;
    environment->clamped = (kiln_clamp){0};
    environment->lobe = p->prefilter->def.lobe;
    environment->degree = p->prefilter->analysis->degree;
    environment->irradiance.roughness[0] = p->irradiance_size ? 1 : 0;
}

// Executes a plan for a source and an environment whose sizes have been checked. Memory that the
// execution allocates comes from the workspace's scratch, if the workspace has one.
static kiln_result execute(const kiln_plan *p, plan_workspace *w, const kiln_map *source,
                           bool rehearses, kiln_environment *environment, kiln_error *error)
{
    begin_environment(p, environment);
    if (w->has_scratch)
        ki_scratch_begin(p->context, &w->scratch);
    kiln_result result = execute_all(p, w, source, rehearses, environment, error);
    if (!w->has_scratch)
        return result;
    ki_scratch_end(p->context);
    // An execution with more suns than ever before takes some memory from the context, outside of
    // the scratch. The scratch then grows, so that the next execution allocates nothing.
    if (w->scratch.memory && w->scratch.peak > w->scratch.capacity)
        (void)ki_scratch_reserve(p->context, &w->scratch, 0);
    return result;
}

kiln_result kiln_plan_execute(kiln_plan *plan, const kiln_map *source,
                              kiln_environment *environment, kiln_error *error)
{
    kiln_result result = check_source(plan, source, error);
    if (result == KILN_OK)
        result = check_target(plan, environment, error);
    if (result != KILN_OK)
        return result;
    return execute(plan, &plan->workspace, source, false, environment, error);
}

// --------------------------------------------------------------------------------- rows that pass

bool ki_plan_takes_rows(const kiln_plan *p)
{
    return p->rows && p->source_shape == KILN_SHAPE_PANORAMA && p->sun == KILN_SUN_KEEP &&
           ki_prefilter_takes_rows(p->prefilter);
}

// Lists what the rows of the source become: the spectra of the levels and of the irradiance, and
// the mirror levels, for each of which a buffer is reserved.
static kiln_result list_work(const kiln_plan *p, plan_workspace *w, ki_row_work *work,
                             kiln_environment *environment, kiln_error *error)
{
    const ki_prefilter *levels = p->prefilter;
    kiln_result result = KILN_OK;
    *work = (ki_row_work){.mirror = p->mirror, .exposure = p->exposure, .analysis_count = 1};
    work->analysis[0] =
        (ki_row_analysis){levels->analysis, w->prefilter.analysis, w->prefilter.spectrum};
    if (p->for_irradiance)
        work->analysis[work->analysis_count++] = (ki_row_analysis){
            p->for_irradiance, w->for_irradiance.analysis, w->for_irradiance.spectrum};
    for (int i = 0; i < levels->def.level_count && result == KILN_OK; i++) {
        if (!levels->mirrors[i])
            continue;
        ki_row_mirror *mirror = &work->mirrors[work->mirror_count++];
        *mirror =
            (ki_row_mirror){.plan = levels->mirrors[i], .target = environment->levels.level[i]};
        result = ki_resample_plan_bands(p->context, levels->mirrors[i], error);
        if (result == KILN_OK)
            result = ki_resample_reserve(p->context, mirror->plan, &mirror->buffer, error);
    }
    return result;
}

kiln_result ki_plan_execute_rows(kiln_plan *p, const kiln_rows *rows, kiln_environment *environment,
                                 kiln_error *error)
{
    plan_workspace *w = &p->workspace;
    ki_row_work work;
    begin_environment(p, environment);
    kiln_result result = list_work(p, w, &work, environment, error);
    if (result == KILN_OK)
        result = ki_prefilter_begin(p->prefilter, &w->prefilter, error);
    if (result == KILN_OK)
        result = ki_rows_pass(p->context, rows, &work, error);
    for (int i = 0; i < work.mirror_count; i++)
        ki_buffer_free(&work.mirrors[i].buffer);
    if (result == KILN_OK)
        result = ki_prefilter_levels(p->prefilter, &w->prefilter, NULL, NULL, false,
                                     &environment->levels, error);
    return result == KILN_OK ? finish(p, w, NULL, environment, error) : result;
}

// ----------------------------------------------------------------------------------------- scratch

// Fills a source with noise, which gives light to every degree of the spectrum, and one texel so
// bright that it is a sun.
static void fill_rehearsal(kiln_map *source)
{
    uint32_t state = 1;
    size_t count = 3 * kiln_map_texels(source, 0);
    for (size_t i = 0; i < count; i++) {
        state = state * 1664525u + 1013904223u;
        source->level[0][i] = (float)(state >> 8) / 16777216;
    }
    source->level[0][count / 2] = (float)count;
}

// Executes the plan for a made-up source while its scratch is empty, which measures the memory that
// executions need.
static kiln_result rehearse(kiln_plan *p, kiln_error *error)
{
    kiln_map source = {.shape = p->source_shape, .size = p->source_size, .level_count = 1};
    kiln_environment made = {0};
    kiln_result result = ki_map_allocate(p->context, &source, error);
    if (result == KILN_OK)
        result = kiln_plan_environment(p, &made, error);
    if (result == KILN_OK) {
        fill_rehearsal(&source);
        result = execute(p, &p->workspace, &source, true, &made, error);
    }
    kiln_environment_free(&made);
    kiln_map_free(&source);
    return result;
}

kiln_result ki_plan_reserve(kiln_plan *p, kiln_error *error)
{
    kiln_sh sh;
    kiln_result result = KILN_OK;
    plan_workspace *w = &p->workspace;
    w->has_scratch = true;
    if (p->prefilter->tune) {
        result = rehearse(p, error);
    } else if (p->sh_bands) {
        kiln_spectrum *spectrum = w->prefilter.spectrum; // which no execution has written yet
        memset(spectrum->a, 0, ki_coefficient_count(spectrum->degree) * sizeof *spectrum->a);
        ki_scratch_begin(p->context, &w->scratch);
        result = ki_sh_project(spectrum, p->sh_bands, NULL, 0, &sh, error);
        ki_scratch_end(p->context);
    }
    if (result != KILN_OK)
        return result;
    size_t suns = ki_prefilter_suns_size(p->prefilter, RESERVED_SUNS);
    if (p->irradiance) {
        int rows = ki_panorama_rows(p->source_shape, p->source_size);
        size_t own = ki_level_suns_size(p->irradiance, rows, RESERVED_SUNS);
        suns = own > suns ? own : suns;
    }
    // A table for a Fourier transform of one length may be larger than the table for a greater
    // length. A sixteenth of the measured memory is added for that.
    size_t more = suns + w->scratch.peak / 16;
    return ki_scratch_reserve(p->context, &w->scratch, more)
               ? KILN_OK
               : ki_fail_memory(p->context, error, "a plan's scratch", w->scratch.peak + more);
}

void kiln_environment_free(kiln_environment *environment)
{
    if (!environment)
        return;
    kiln_map_free(&environment->levels);
    kiln_map_free(&environment->irradiance);
    *environment = (kiln_environment){0};
}

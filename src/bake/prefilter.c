// The prefiltered levels of an environment (docs/theory/spectral.md). In: a panorama, or the map of
// another shape that the panorama was made from, and a kiln_prefilter_def. Out: the levels of a
// map, each filtered by its lobe. Method: one spherical-harmonic spectrum of the panorama is
// multiplied by the spectrum of each lobe and evaluated at the texels of the level. Mirror levels
// (GGX of roughness 0) are resampled by area. Tuned levels are fitted to how an engine interpolates
// (tune/tune.h).
#include "bake/prefilter.h"

#include "math/math.h"
#include "sphere/grid.h"
#include "sphere/lobe.h"

#include <math.h>
#include <string.h>

bool ki_is_mirror(const kiln_lobe *lobe)
{
    return lobe->kind == KILN_LOBE_GGX && lobe->parameter < 1e-7;
}

static kiln_lobe lobe_of_roughness(enum kiln_lobe_kind kind, double roughness)
{
    double alpha = roughness * roughness;
    switch (kind) {
    case KILN_LOBE_LAMBERT:
        return kiln_lobe_lambert();
    case KILN_LOBE_CHARLIE:
        return kiln_lobe_charlie(fmax(alpha, 0.01));
    case KILN_LOBE_PHONG:
        return kiln_lobe_phong(ki_clamp(2 / (alpha * alpha) - 2, 1, 100000));
    default:
        return kiln_lobe_ggx(alpha);
    }
}

kiln_result ki_prefilter_resolve(const kiln_prefilter_def *def, kiln_prefilter_def *resolved,
                                 float roughness[KILN_MAX_LEVELS], kiln_lobe lobes[KILN_MAX_LEVELS],
                                 kiln_error *error)
{
    kiln_prefilter_def d = def ? *def : (kiln_prefilter_def){0};
    if (d.shape == KILN_SHAPE_AUTO)
        d.shape = KILN_SHAPE_CUBE;
    d.size = d.size ? d.size : 256;
    if (d.size < 1 || d.size > KILN_MAX_SIZE)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "size is %d, it must be 1 to %d", d.size,
                       KILN_MAX_SIZE);
    int full = 1;
    while (d.size >> full)
        full++;
    d.level_count = d.level_count ? d.level_count : full;
    if (d.smallest < 0 || d.smallest > d.size)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "smallest is %d, it must be from 0 to the size, which is %d", d.smallest,
                       d.size);
    if (d.smallest)
        full = KILN_MAX_LEVELS;
    if (d.level_count < 1 || d.level_count > full)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "level_count is %d, a map of size %d has 1 to %d levels", d.level_count,
                       d.size, full);
    if ((int)d.lobe < 0 || d.lobe > KILN_LOBE_PHONG)
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "lobe is %d, it must be one of GGX, Lambert, Charlie and Phong",
                       (int)d.lobe);
    if (!(fabs(d.rotation) <= 1e6))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "rotation is %g degrees, it must be from -1e6 to 1e6", d.rotation);
    if (!(fabs(d.pitch) <= 1e6) || !(fabs(d.roll) <= 1e6))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "pitch and roll are %g and %g degrees, they must be from -1e6 to 1e6",
                       d.pitch, d.roll);
    if ((unsigned)d.up > KILN_UP_MINUS_Z)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "up is %d, it must be 0 to %d", (int)d.up,
                       (int)KILN_UP_MINUS_Z);
    d.tolerance = d.tolerance != 0 ? d.tolerance : ki_lobe_tolerance;
    if (!(d.tolerance >= 1e-6 && d.tolerance <= 0.01))
        return ki_fail(error, KILN_ERROR_ARGUMENT, "tolerance is %g, it must be 1e-6 to 0.01",
                       d.tolerance);
    for (int i = 0; i < d.level_count; i++) {
        roughness[i] = d.level_count > 1 ? (float)i / (float)(d.level_count - 1) : 0;
        if (d.lobe == KILN_LOBE_LAMBERT)
            roughness[i] = 1;
        if (d.roughness)
            roughness[i] = d.roughness[i];
        if (!(roughness[i] >= 0 && roughness[i] <= 1))
            return ki_fail(error, KILN_ERROR_ARGUMENT,
                           "the roughness of level %d is %g, it must be 0 to 1", i,
                           (double)roughness[i]);
        lobes[i] = lobe_of_roughness(d.lobe, (double)roughness[i]);
    }
    d.roughness = NULL;
    *resolved = d;
    return KILN_OK;
}

// Plans a mirror level, which shows the environment unfiltered. `source` is the cube or octahedron
// that the environment's panorama was made from, or NULL if the environment is a panorama itself.
// The level is resampled from `source` where that conversion is exact (from cube to cube, turned by
// a multiple of 90 degrees), and also where the source has less than 4 times the texels of the
// level, because resampling twice, by way of the panorama, would blur the level. In all other cases
// the level is resampled from the panorama, whose texels are then much smaller than those of the
// level. That conversion averages exact areas, whereas a direct conversion would average a limited
// number of sample points in each texel.
static kiln_result plan_mirror(kiln_context *context, ki_prefilter *p, int level,
                               const kiln_map *source, kiln_error *error)
{
    kiln_map panorama = {.shape = KILN_SHAPE_PANORAMA, .size = p->source_size, .level_count = 1};
    kiln_map target = {.shape = p->def.shape,
                       .size = p->def.size,
                       .level_count = level + 1,
                       .smallest = p->def.smallest};
    if (source) {
        bool exact = source->shape == KILN_SHAPE_CUBE && target.shape == KILN_SHAPE_CUBE &&
                     fmod(p->def.rotation, 90) == 0 && (!p->tilt.any || p->tilt.quarter);
        p->direct[level] =
            exact || kiln_map_texels(source, 0) < 4 * kiln_map_texels(&target, level);
    }
    const kiln_map *from = source && p->direct[level] ? source : &panorama;
    return ki_resample_plan_create(context, from->shape, from->size, target.shape,
                                   kiln_map_level_size(&target, level), &p->tilt, p->def.rotation,
                                   &p->mirrors[level], error);
}

static bool is_tuned(const ki_prefilter *p, int level)
{
    return p->tune && ki_tune_makes(p->tune, level);
}

static kiln_result plan_tuning(kiln_context *context, ki_prefilter *p, const ki_reading *reading,
                               const kiln_lobe *first, kiln_error *error)
{
    if (!ki_is_mirror(first))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "tuned levels need the lobe GGX and a first level of roughness 0");
    if (p->def.size & (p->def.size - 1))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "size is %d, it must be a power of two for tuned levels", p->def.size);
    return ki_tune_create(context, &p->def, &p->tilt, p->roughness, reading, &p->tune, error);
}

kiln_result ki_prefilter_create(kiln_context *context, int panorama_size, const kiln_map *source,
                                const kiln_prefilter_def *def, const ki_reading *reading,
                                ki_prefilter **plan, kiln_error *error)
{
    static const char planning[] = "planning";
    kiln_result result = KILN_OK;
    kiln_lobe lobes[KILN_MAX_LEVELS];
    ki_zonal zonals[KILN_MAX_LEVELS];
    ki_zonal_spectrum spectra[KILN_MAX_LEVELS] = {{0}};
    ki_prefilter *p = *plan = ki_alloc(context, 1, sizeof *p);
    if (!p)
        return ki_fail_memory(context, error, "a plan", sizeof *p);
    p->source_size = panorama_size;
    result = ki_prefilter_resolve(def, &p->def, p->roughness, lobes, error);
    if (result != KILN_OK)
        goto done;
    ki_tilt_make(p->def.rotation, p->def.pitch, p->def.roll, p->def.up, &p->tilt);
    if (p->tilt.any)
        p->def.rotation = 0;

    // Least degree to which the panorama is analysed. Low degrees cost little, and with the larger
    // number of latitude rings a constant environment stays constant to the last bit of a float.
    int degree = p->def.tolerance < 1e-3 ? 192 : 64;
    if (reading) {
        result = plan_tuning(context, p, reading, &lobes[0], error);
        if (result != KILN_OK)
            goto done;
        degree = ki_max(degree, ki_tune_degree(p->tune));
    }
    for (int i = 0; i < p->def.level_count; i++) {
        if (ki_is_mirror(&lobes[i]) || is_tuned(p, i))
            continue;
        result = ki_lobe_spectrum(context, &lobes[i], p->def.tolerance, true, &zonals[i],
                                  &spectra[i], error);
        if (result != KILN_OK)
            goto done;
        degree = ki_max(degree, spectra[i].degree);
    }
    result = ki_analysis_create(context, panorama_size, degree, &p->analysis, error);
    for (int i = 0; i < p->def.level_count && result == KILN_OK; i++) {
        int size = ki_max(ki_max(1, p->def.smallest), p->def.size >> i);
        if (!ki_progress(context, planning, (double)i / p->def.level_count))
            result = ki_fail_cancelled(error, planning);
        else if (ki_is_mirror(&lobes[i]))
            result = plan_mirror(context, p, i, source, error);
        else if (!is_tuned(p, i))
            result = ki_level_create(context, &p->analysis->legendre, &zonals[i], &spectra[i],
                                     p->def.shape, size, &p->tilt, &p->levels[i], error);
    }
done:
    for (int i = 0; i < KILN_MAX_LEVELS; i++)
        ki_zonal_free(&spectra[i]);
    if (result != KILN_OK) {
        ki_prefilter_destroy(p);
        *plan = NULL;
    }
    return result;
}

kiln_result ki_prefilter_workspace_create(kiln_context *context, const ki_prefilter *p,
                                          ki_prefilter_workspace *workspace, kiln_error *error)
{
    *workspace = (ki_prefilter_workspace){.context = context};
    kiln_result result = ki_analysis_workspace_create(context, p->analysis, KI_ANALYSIS_BORROWS,
                                                      &workspace->analysis, error);
    // The analysis shares two buffers with the levels and mostly needs more of them. It reserves
    // them first, so that they are not allocated small and then replaced.
    if (result == KILN_OK)
        result = ki_prefilter_begin(p, workspace, error);
    if (result == KILN_OK)
        result = ki_spectrum_create(context, p->analysis, &workspace->spectrum, error);
    for (int i = 0; i < p->def.level_count && result == KILN_OK; i++)
        if (p->levels[i])
            result = ki_level_reserve(context, p->levels[i], &workspace->levels, error);
        else if (p->mirrors[i])
            result = ki_resample_reserve(context, p->mirrors[i], &workspace->resampling, error);
    if (result != KILN_OK)
        ki_prefilter_workspace_free(workspace);
    return result;
}

kiln_result ki_prefilter_begin(const ki_prefilter *p, ki_prefilter_workspace *w, kiln_error *error)
{
    return ki_analysis_borrow(p->analysis, w->analysis, &w->levels.grid, &w->levels.scratch, error);
}

void ki_prefilter_workspace_free(ki_prefilter_workspace *workspace)
{
    ki_analysis_workspace_destroy(workspace->analysis);
    kiln_spectrum_destroy(workspace->spectrum);
    ki_level_workspace_free(&workspace->levels);
    ki_buffer_free(&workspace->resampling);
    *workspace = (ki_prefilter_workspace){0};
}

// Computes level `index` if it is a mirror or is filtered exactly. Leaves tuned levels alone:
// ki_tune_execute computes them later.
static kiln_result execute_level(const ki_prefilter *p, ki_prefilter_workspace *w,
                                 const kiln_map *panorama, const kiln_map *source, int index,
                                 const ki_progress_range *range, kiln_map *map, kiln_error *error)
{
    const ki_resample_plan *mirror = panorama ? p->mirrors[index] : NULL;
    if (p->levels[index])
        return ki_level_execute(p->levels[index], &w->levels, w->spectrum, panorama,
                                p->def.rotation, map, index, range, error);
    const kiln_map *from = p->direct[index] ? source : panorama;
    if (mirror && !ki_resample_execute(w->context, mirror, &w->resampling, from->level[0],
                                       map->level[index], range))
        return ki_fail_cancelled(error, range->name);
    return KILN_OK;
}

static const char stage[] = "filtering"; // name of this work in progress reports

kiln_result ki_prefilter_execute(const ki_prefilter *p, ki_prefilter_workspace *w,
                                 const kiln_map *panorama, const kiln_map *source, bool rehearses,
                                 kiln_map *map, kiln_error *error)
{
    if (!ki_progress(w->context, stage, 0))
        return ki_fail_cancelled(error, stage);
    kiln_result result = ki_prefilter_begin(p, w, error);
    if (result != KILN_OK)
        return result;
    if (!ki_analysis_execute(p->analysis, w->analysis, panorama->level[0], w->spectrum))
        return ki_fail_cancelled(error, stage);
    return ki_prefilter_levels(p, w, panorama, source, rehearses, map, error);
}

bool ki_prefilter_takes_rows(const ki_prefilter *p)
{
    for (int i = 0; i < p->def.level_count; i++)
        if ((p->mirrors[i] && (p->direct[i] || !ki_resample_has_bands(p->mirrors[i]))) ||
            (p->levels[i] && ki_level_needs_panorama(p->levels[i])))
            return false;
    return true;
}

kiln_result ki_prefilter_levels(const ki_prefilter *p, ki_prefilter_workspace *w,
                                const kiln_map *panorama, const kiln_map *source, bool rehearses,
                                kiln_map *map, kiln_error *error)
{
    kiln_result result = KILN_OK;
    // The analysis counts as a quarter of the progress, and each level as half of the progress that
    // remains, because levels get smaller.
    double done = 0.25;
    for (int i = 0; i < p->def.level_count && result == KILN_OK; i++) {
        if (!ki_progress(w->context, stage, done))
            return ki_fail_cancelled(error, stage);
        ki_progress_range part = {stage, done, done + (1 - done) / 2};
        result = execute_level(p, w, panorama, source, i, &part, map, error);
        map->roughness[i] = p->roughness[i];
        done = part.to;
    }
    if (result == KILN_OK && p->tune)
        result = ki_tune_execute(p->tune, &p->analysis->legendre, w->spectrum, p->def.rotation,
                                 rehearses, map, error);
    if (result == KILN_OK && !ki_progress(w->context, stage, 1))
        return ki_fail_cancelled(error, stage);
    return result;
}

void ki_prefilter_destroy(ki_prefilter *plan)
{
    if (!plan)
        return;
    for (int i = 0; i < KILN_MAX_LEVELS; i++) {
        ki_resample_plan_destroy(plan->mirrors[i]);
        ki_level_destroy(plan->levels[i]);
    }
    ki_tune_destroy(plan->tune);
    ki_analysis_destroy(plan->analysis);
    ki_free(plan);
}

size_t ki_prefilter_suns_size(const ki_prefilter *p, size_t count)
{
    size_t most = p->tune ? ki_tune_suns_size(p->tune, p->source_size, count) : 0;
    for (int i = 0; i < p->def.level_count; i++) {
        size_t size = p->levels[i] ? ki_level_suns_size(p->levels[i], p->source_size, count) : 0;
        most = size > most ? size : most;
    }
    return most;
}

// kiln_check_levels. In: a panorama and prefiltered levels of any tool. Out: a report. Method: the
// levels are turned to the axes of the panorama (axes.c), their roughness is found (mapping.c), the
// panorama is filtered exactly for the roughness that each level should have, a few texels of these
// exact levels are proved by brute force, and the levels are compared texel by texel (measure.c,
// faults.c).
#include "check/check.h"

#include "image/texel.h"
#include "math/math.h"

#include <math.h>
#include <string.h>

// PROOFS: largest number of texels of a level that are computed by brute force.
enum { PROOFS = 16 };

static kiln_lobe lobe_of(kiln_lobe_kind kind, double roughness)
{
    double alpha = roughness * roughness;
    switch (kind) {
    case KILN_LOBE_LAMBERT:
        return kiln_lobe_lambert();
    case KILN_LOBE_CHARLIE:
        return kiln_lobe_charlie(fmax(0.01, alpha));
    case KILN_LOBE_PHONG:
        return kiln_lobe_phong(fmax(1, 2 / (alpha * alpha) - 2));
    default:
        return kiln_lobe_ggx(alpha);
    }
}

static kiln_result check_def(const kiln_map *map, const kiln_check_levels_def *def,
                             kiln_error *error)
{
    if ((unsigned)def->lobe > KILN_LOBE_PHONG)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "lobe is %d, it must be 0 to %d", (int)def->lobe,
                       (int)KILN_LOBE_PHONG);
    if (def->engine && !ki_recipe_of(def->engine))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "the engine is unknown, take an engine from kiln_engine_find");
    for (int k = 0; k < map->level_count && def->stated; k++)
        if (!(map->roughness[k] >= 0 && map->roughness[k] <= 1))
            return ki_fail(error, KILN_ERROR_ARGUMENT,
                           "roughness of level %d is %g, it must be 0 to 1", k,
                           (double)map->roughness[k]);
    return KILN_OK;
}

// Compares some texels of an exact level with brute force.
static kiln_result prove(kiln_context *context, const kiln_map *panorama, const ki_pair *pair,
                         kiln_lobe_kind kind, kiln_check_level *report, kiln_error *error)
{
    double at[PROOFS][3], values[PROOFS][3], sum = 0, norm = 0;
    size_t texels = kiln_map_texels(&pair->exact, 0), index[PROOFS];
    const kiln_lobe lobe = lobe_of(kind, report->roughness);
    double rows = panorama->size;
    int count = (int)ki_clamp(4e6 / (rows * rows), 2, PROOFS);
    if (kind == KILN_LOBE_GGX && report->roughness <= 0)
        return KILN_OK;
    for (int i = 0; i < count; i++) {
        double part = 0.37 + i * 0.6180339887498949; // the golden ratio spreads the texels evenly
        index[i] = (size_t)((part - floor(part)) * (double)texels);
        kiln_map_direction(&pair->exact, 0, index[i], at[i]);
    }
    kiln_result result = kiln_reference_filter(context, panorama, &lobe, 0, (const double(*)[3])at,
                                               count, values, error);
    for (int i = 0; i < count && result == KILN_OK; i++)
        for (size_t c = 0; c < 3; c++) {
            double d = (double)pair->exact.level[0][3 * index[i] + c] - values[i][c];
            sum += d * d;
            norm += values[i][c] * values[i][c];
        }
    report->proof = norm > 0 ? sqrt(sum / norm) : 0;
    report->proof_count = count;
    return result;
}

// Everything about one check.
typedef struct check {
    kiln_context *context;
    const kiln_map *panorama;
    const kiln_check_levels_def *def;
    kiln_map levels; // the levels in the panorama's directions, divided by the brightness
    kiln_map exact;
    kiln_check_levels_report *report;
} check;

// Turns the levels to the panorama's directions.
static kiln_result turn(check *c, const kiln_map *levels, kiln_error *error)
{
    const ki_recipe *recipe = c->def->engine ? ki_recipe_of(c->def->engine) : NULL;
    const ki_axes *expected = recipe ? &recipe->axes : NULL;
    ki_axes found;
    kiln_result result = ki_find_axes(c->context, c->panorama, levels,
                                      expected ? expected : &ki_axes_none, &found, error);
    if (result != KILN_OK)
        return result;
    memcpy(c->report->axis, found.axis, sizeof found.axis);
    memcpy(c->report->sign, found.sign, sizeof found.sign);
    ki_axes wanted = expected ? *expected : ki_axes_known(&found) ? found : ki_axes_none;
    memcpy(c->report->wanted_axis, wanted.axis, sizeof wanted.axis);
    memcpy(c->report->wanted_sign, wanted.sign, sizeof wanted.sign);
    // What an engine's file shows is said in the directions in which the engine shows it.
    ki_axes shown = expected ? ki_axes_shown(&found, expected) : found;
    ki_say_axes(&shown, expected ? &ki_axes_none : NULL, &c->report->findings);
    return ki_map_unturn(c->context, levels, &found, &c->levels, error);
}

static void divide(kiln_map *map, double factor)
{
    for (int k = 0; k < map->level_count && factor != 1; k++)
        for (size_t i = 0; i < 3 * kiln_map_texels(map, k); i++)
            map->level[k][i] = (float)((double)map->level[k][i] / factor);
}

static kiln_result filter(check *c, const ki_mapping *mapping, kiln_error *error)
{
    float roughness[KILN_MAX_LEVELS];
    for (int k = 0; k < c->levels.level_count; k++)
        roughness[k] = (float)mapping->wanted[k];
    const kiln_prefilter_def def = {.shape = c->levels.shape,
                                    .size = c->levels.size,
                                    .level_count = c->levels.level_count,
                                    .smallest = c->levels.smallest,
                                    .lobe = c->def->lobe,
                                    .roughness = roughness};
    return kiln_prefilter(c->context, c->panorama, &def, &c->exact, error);
}

// Says which faults single texels have. Fireflies and seams are named only where no other fault
// explains them.
static void judge_texels(const kiln_check_levels_report *report, bool explained,
                         kiln_findings *findings)
{
    size_t fireflies = 0, negative = 0;
    double seam = 0;
    for (int k = 0; k < report->level_count; k++) {
        const kiln_check_level *level = &report->level[k];
        fireflies += level->firefly_count;
        negative += level->negative_count;
        if (level->seam > 3 * level->within)
            seam = fmax(seam, level->seam);
    }
    if (negative)
        ki_find(findings, KILN_FINDING_NEGATIVE, true, "%zu texels are below zero", negative);
    if (fireflies && !explained)
        ki_find(findings, KILN_FINDING_FIREFLY, true,
                "%zu texels are more than twice as bright as anything near them should be",
                fireflies);
    if (seam > 0.01 && !explained)
        ki_find(findings, KILN_FINDING_SEAM, true,
                "the errors jump at the edges of the faces, by %.3g %%", 100 * seam);
}

// Says which faults of all levels explain their errors. Clamped light makes levels look like those
// of another roughness, and so do levels of another roughness look shifted.
static void judge(const ki_pair *pairs, const ki_mapping *mapping, bool atlas,
                  kiln_check_levels_report *report)
{
    kiln_findings *findings = &report->findings;
    int before = findings->fault_count;
    ki_judge_clamp(&pairs[0], findings);
    if (findings->fault_count == before)
        ki_judge_mapping(report->level_count, mapping, findings);
    if (findings->fault_count == before)
        ki_judge_shift(pairs, report, findings);
    judge_texels(report, atlas || findings->fault_count > before, findings);
}

static kiln_result measure(check *c, const ki_mapping *mapping, kiln_error *error)
{
    ki_pair pairs[KILN_MAX_LEVELS];
    kiln_check_levels_report *report = c->report;
    kiln_result result = KILN_OK;
    report->level_count = c->levels.level_count;
    for (int k = 0; k < report->level_count && result == KILN_OK; k++) {
        kiln_check_level *level = &report->level[k];
        pairs[k] = ki_pair_make(&c->levels, &c->exact, k);
        *level = (kiln_check_level){
            .size = pairs[k].is.size, .roughness = mapping->wanted[k], .found = mapping->found[k]};
        ki_measure_level(&pairs[k], level);
        report->worst = fmax(report->worst, level->rms);
        result = prove(c->context, c->panorama, &pairs[k], c->def->lobe, level, error);
    }
    if (result != KILN_OK)
        return result;
    // A cube of what a shader reads from an atlas has more texels than the atlas: its sharp levels
    // lack the finest detail.
    const ki_recipe *recipe = c->def->engine ? ki_recipe_of(c->def->engine) : NULL;
    judge(pairs, mapping, recipe && recipe->read, report);
    return KILN_OK;
}

static kiln_result check_all(check *c, const kiln_map *levels, kiln_error *error)
{
    ki_mapping mapping;
    kiln_result result = turn(c, levels, error);
    if (result == KILN_OK)
        result =
            ki_find_roughness(c->context, c->panorama, &c->levels, c->def->lobe, &mapping, error);
    if (result != KILN_OK)
        return result;
    ki_want_roughness(levels, c->def, &mapping, &c->report->findings);
    c->report->brightness = mapping.brightness;
    divide(&c->levels, mapping.brightness);
    result = filter(c, &mapping, error);
    return result == KILN_OK ? measure(c, &mapping, error) : result;
}

// Returns the first engine that levels are tuned for whose axes and roughness the levels have.
static const kiln_engine *find_engine(const kiln_map *levels,
                                      const kiln_check_levels_report *report)
{
    const ki_recipe *recipe;
    ki_axes axes;
    memcpy(axes.axis, report->axis, sizeof axes.axis);
    memcpy(axes.sign, report->sign, sizeof axes.sign);
    for (int i = 0; (recipe = ki_recipe_at(i)) != NULL; i++) {
        bool fits = recipe->level && recipe->about.tune && levels->shape == KILN_SHAPE_CUBE &&
                    !recipe->flat && ki_axes_equal(&axes, &recipe->axes);
        for (int k = 0; k < levels->level_count && fits; k++)
            fits = fabs(recipe->roughness(k, levels->level_count, levels->size) -
                        report->level[k].roughness) < 1e-4;
        if (fits)
            return &recipe->about;
    }
    return NULL;
}

// Moves the levels to `difference`, and subtracts the exact levels.
static void take_difference(check *c, kiln_map *difference)
{
    for (int k = 0; k < c->levels.level_count; k++)
        for (size_t i = 0; i < 3 * kiln_map_texels(&c->levels, k); i++)
            c->levels.level[k][i] -= c->exact.level[k][i];
    *difference = c->levels;
    c->levels = (kiln_map){0};
}

kiln_result kiln_check_levels(kiln_context *context, const kiln_map *source, const kiln_map *levels,
                              const kiln_check_levels_def *def, kiln_check_levels_report *report,
                              kiln_map *difference, kiln_error *error)
{
    static const kiln_check_levels_def defaults = {0};
    kiln_map panorama = {0};
    *report = (kiln_check_levels_report){.brightness = 1};
    if (difference)
        *difference = (kiln_map){0};
    check c = {.context = context, .def = def ? def : &defaults, .report = report};
    kiln_result result = ki_map_check(source, error);
    if (result == KILN_OK)
        result = ki_map_check(levels, error);
    if (result == KILN_OK)
        result = check_def(levels, c.def, error);
    if (result == KILN_OK && source->shape != KILN_SHAPE_PANORAMA)
        result = kiln_map_convert(context, source, KILN_SHAPE_PANORAMA,
                                  ki_min(2 * source->size, KILN_MAX_SIZE / 2), 0, &panorama, error);
    if (result == KILN_OK) {
        c.panorama = source->shape == KILN_SHAPE_PANORAMA ? source : &panorama;
        result = check_all(&c, levels, error);
        report->engine = c.def->engine                  ? c.def->engine
                         : c.def->lobe == KILN_LOBE_GGX ? find_engine(levels, report)
                                                        : NULL;
    }
    if (difference && result == KILN_OK)
        take_difference(&c, difference);
    kiln_map_free(&c.levels);
    if (result != KILN_OK)
        memset(report, 0, sizeof *report);
    kiln_map_free(&c.exact);
    kiln_map_free(&panorama);
    return result;
}

// kiln_check_shown. In: a panorama, a cube with levels, and the engine that reads them. Out: the
// relative errors of what the engine shows at 19 roughnesses, against the brute-force sum over all
// texels of the panorama, and those of what it would show of exact levels. Also kiln_check_right,
// which judges levels by both reports.
#include "check/check.h"

#include "bake/reference.h"
#include "image/image.h"
#include "math/math.h"

#include <math.h>
#include <string.h>

enum { MOST = 192 };

// A coarser rule than the default, which takes three times as long on a panorama of 256 rows. The
// reported errors differ by at most 1e-5 between the two rules.
static const ki_reference_rule rule = {
    .centre = 1.0 / 60, .pairs = 1.0 / 8, .quads = 1, .edge = 0.03};

// Spreads directions evenly on a spiral from pole to pole.
static void spread(int count, double at[MOST][3])
{
    const double golden = 2.399963229728653; // angle between neighbours on the spiral
    for (int i = 0; i < count; i++) {
        double sine, cosine, y = 1 - (2 * i + 1.0) / count, r = sqrt(1 - y * y);
        ki_sincos(golden * i, &sine, &cosine);
        at[i][0] = r * cosine;
        at[i][1] = y;
        at[i][2] = r * sine;
    }
}

// Returns light on a display whose mean light `mean` is shown as half of white.
static double display(double light, double mean)
{
    return light > 0 ? light / (light + mean) : 0;
}

// What all roughnesses have in common.
typedef struct comparison {
    kiln_context *context;
    const kiln_map *panorama;
    const kiln_engine *engine;
    double mean;                        // mean of the panorama's values
    int count;                          // number of directions
    double at[MOST][3], truth[MOST][3]; // the directions, and the brute-force sums of one roughness
} comparison;

// Mean squares of relative differences, and of differences of values on a display, summed over all
// roughnesses.
typedef struct squares {
    double relative, displayed;
} squares;

// Measures what the engine shows of a map, which has the panorama's directions, against c->truth. Adds
// to `to` and returns in *rms the relative error of one roughness.
static kiln_result measure(const comparison *c, const kiln_map *map, double roughness, squares *to,
                           double *rms, kiln_error *error)
{
    double shown[MOST][3], sum = 0, norm = 0, off = 0;
    kiln_result result = kiln_engine_show(c->context, c->engine, map, roughness,
                                          (const double(*)[3])c->at, c->count, shown, error);
    for (int i = 0; i < c->count && result == KILN_OK; i++)
        for (int k = 0; k < 3; k++) {
            double truth = c->truth[i][k];
            sum += (shown[i][k] - truth) * (shown[i][k] - truth);
            norm += truth * truth;
            double d = display(shown[i][k], c->mean) - display(truth, c->mean);
            off += d * d;
        }
    *rms = norm > 0 ? sqrt(sum / norm) : 0;
    to->relative += *rms * *rms;
    to->displayed += off / (3 * c->count);
    return result;
}

// Filters exact levels of the sizes of `map`, with the engine's roughness.
static kiln_result filter(const comparison *c, const kiln_map *map, kiln_map *exact,
                          kiln_error *error)
{
    const ki_recipe *recipe = ki_recipe_of(c->engine);
    float roughness[KILN_MAX_LEVELS];
    for (int k = 0; k < map->level_count; k++)
        roughness[k] = (float)recipe->roughness(k, map->level_count, map->size);
    const kiln_prefilter_def def = {.shape = map->shape,
                                    .size = map->size,
                                    .level_count = map->level_count,
                                    .smallest = map->smallest,
                                    .roughness = roughness};
    return kiln_prefilter(c->context, c->panorama, &def, exact, error);
}

static kiln_result check_arguments(const kiln_map *source, const kiln_map *levels,
                                   const kiln_engine *engine, kiln_error *error)
{
    const ki_recipe *recipe = ki_recipe_of(engine);
    kiln_result result = ki_map_check(source, error);
    if (result == KILN_OK)
        result = ki_map_check(levels, error);
    if (result == KILN_OK && (!recipe || !recipe->level || levels->shape != KILN_SHAPE_CUBE))
        return ki_fail(error, KILN_ERROR_ARGUMENT,
                       "%s reads no levels of a cube, take an engine from kiln_engine_find that "
                       "reads levels",
                       recipe ? recipe->about.name : "the unknown engine");
    return result;
}

kiln_result kiln_check_shown(kiln_context *context, const kiln_map *source, const kiln_map *levels,
                             const kiln_engine *engine, kiln_check_shown_report *report,
                             kiln_error *error)
{
    kiln_map panorama = {0}, map = {0}, exact = {0};
    comparison c = {.context = context, .panorama = source, .engine = engine};
    memset(report, 0, sizeof *report);
    kiln_result result = check_arguments(source, levels, engine, error);
    if (result == KILN_OK)
        result = ki_map_unturn(context, levels, &ki_recipe_of(engine)->axes, &map, error);
    if (result == KILN_OK && source->shape != KILN_SHAPE_PANORAMA) {
        c.panorama = &panorama;
        result = kiln_map_convert(context, source, KILN_SHAPE_PANORAMA,
                                  ki_min(2 * source->size, KILN_MAX_SIZE / 2), 0, &panorama, error);
    }
    if (result == KILN_OK)
        result = filter(&c, &map, &exact, error);
    double rows = c.panorama->size;
    squares is = {0}, ideal = {0};
    c.count = (int)ki_clamp(MOST * 1024.0 * 1024 / (rows * rows), 12, MOST);
    if (result == KILN_OK)
        c.mean = ki_map_mean(c.panorama);
    spread(c.count, c.at);
    for (int i = 0; i < KILN_SHOWN && result == KILN_OK; i++) {
        double roughness = ki_min(100, 10 + 5 * i) / 100.0, rms = 0;
        const kiln_lobe lobe = kiln_lobe_ggx(roughness * roughness);
        result = ki_reference_integrate(context, c.panorama, &lobe, 0, (const double(*)[3])c.at,
                                        c.count, &rule, c.truth, error);
        if (result == KILN_OK)
            result = measure(&c, &map, roughness, &is, &report->rms[i], error);
        if (result == KILN_OK)
            result = measure(&c, &exact, roughness, &ideal, &rms, error);
        if (report->rms[i] > report->worst) {
            report->worst = report->rms[i];
            report->worst_roughness = roughness;
        }
    }
    report->all = sqrt(is.relative / KILN_SHOWN);
    report->displayed = sqrt(is.displayed / KILN_SHOWN);
    report->exact_all = sqrt(ideal.relative / KILN_SHOWN);
    report->exact_displayed = sqrt(ideal.displayed / KILN_SHOWN);
    report->direction_count = c.count;
    if (result != KILN_OK)
        memset(report, 0, sizeof *report);
    kiln_map_free(&panorama);
    kiln_map_free(&map);
    kiln_map_free(&exact);
    return result;
}

bool kiln_check_right(const kiln_check_levels_report *levels, const kiln_check_shown_report *shown,
                      double tolerance)
{
    bool tuned =
        shown && shown->direction_count &&
        (shown->all < 0.99 * shown->exact_all || shown->displayed < 0.99 * shown->exact_displayed);
    return levels->level_count > 0 && !levels->findings.fault_count &&
           (levels->worst <= tolerance || tuned);
}

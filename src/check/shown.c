// kiln_check_shown. In: a panorama, a cube with levels, and the engine that reads them. Out: the
// relative errors of what the engine shows at 19 roughnesses, against the brute-force sum over all
// texels of the panorama.
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

// Measures one roughness. `map` has the panorama's directions, and `mean` is the mean of the
// panorama's values. Adds to *squares the mean square difference of values on a display.
static kiln_result measure(kiln_context *context, const kiln_map *panorama, double mean,
                           const kiln_map *map, const kiln_engine *engine, double roughness,
                           int count, double *rms, double *squares, kiln_error *error)
{
    double at[MOST][3], shown[MOST][3], exact[MOST][3], sum = 0, norm = 0, off = 0;
    const kiln_lobe lobe = kiln_lobe_ggx(roughness * roughness);
    spread(count, at);
    kiln_result result = kiln_engine_show(context, engine, map, roughness, (const double(*)[3])at,
                                          count, shown, error);
    if (result == KILN_OK)
        result = ki_reference_integrate(context, panorama, &lobe, 0, (const double(*)[3])at, count,
                                        &rule, exact, error);
    for (int i = 0; i < count && result == KILN_OK; i++)
        for (int c = 0; c < 3; c++) {
            sum += (shown[i][c] - exact[i][c]) * (shown[i][c] - exact[i][c]);
            norm += exact[i][c] * exact[i][c];
            double d = display(shown[i][c], mean) - display(exact[i][c], mean);
            off += d * d;
        }
    *rms = norm > 0 ? sqrt(sum / norm) : 0;
    *squares += off / (3 * count);
    return result;
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
    kiln_map panorama = {0}, map = {0};
    memset(report, 0, sizeof *report);
    kiln_result result = check_arguments(source, levels, engine, error);
    if (result == KILN_OK)
        result = ki_map_unturn(context, levels, &ki_recipe_of(engine)->axes, &map, error);
    bool convert = source->shape != KILN_SHAPE_PANORAMA;
    if (result == KILN_OK && convert)
        result = kiln_map_convert(context, source, KILN_SHAPE_PANORAMA,
                                  ki_min(2 * source->size, KILN_MAX_SIZE / 2), 0, &panorama, error);
    double rows = convert ? panorama.size : source->size;
    int count = (int)ki_clamp(MOST * 1024.0 * 1024 / (rows * rows), 12, MOST);
    double squares = 0, displayed = 0, mean = 0;
    if (result == KILN_OK)
        mean = ki_map_mean(convert ? &panorama : source);
    for (int i = 0; i < KILN_SHOWN && result == KILN_OK; i++) {
        double roughness = ki_min(100, 10 + 5 * i) / 100.0;
        result = measure(context, convert ? &panorama : source, mean, &map, engine, roughness,
                         count, &report->rms[i], &displayed, error);
        squares += report->rms[i] * report->rms[i];
        if (report->rms[i] > report->worst) {
            report->worst = report->rms[i];
            report->worst_roughness = roughness;
        }
    }
    report->all = sqrt(squares / KILN_SHOWN);
    report->displayed = sqrt(displayed / KILN_SHOWN);
    report->direction_count = count;
    if (result != KILN_OK)
        memset(report, 0, sizeof *report);
    kiln_map_free(&panorama);
    kiln_map_free(&map);
    return result;
}

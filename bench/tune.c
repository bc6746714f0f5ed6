// The cases tune and lights. In: eight panoramas, in the case lights without their suns and lamps,
// which are added to both sides of the comparison as analytic discs. Out: the errors of what
// engines show of exact and of tuned levels. An engine maps the roughness to a fractional level,
// mixes two levels linearly, and reads each bilinearly. The result is compared with the exact
// environment at the same roughness.
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The panoramas. The first two, courtyard (even light) and sunrise (a sun), have bars that their
// errors must reach; the others go from even to sunny light.
static const char *const names[] = {"courtyard", "sunrise", "city",   "interior",
                                    "studio",    "forest",  "sunset", "night"};
enum { NAME_COUNT = sizeof names / sizeof *names };

typedef struct layout {
    const char *engine, *title;
    int size, level_count; // size and number of levels; 0 for the engine's default value
} layout;
static const layout layouts[] = {
    {"three", "three of 9 levels from 1024", 1024, 9},
    {"three", "three", 0, 0},
    {"babylon", "babylon", 0, 0},
    {"filament", "filament", 0, 0},
};
enum { LAYOUT_COUNT = sizeof layouts / sizeof *layouts };

// How levels are made: exact, or tuned with level 0 exact (SHARP) or tuned too (SOFT).
enum { NONE, SHARP, SOFT, TUNINGS };
static const char *const tunings[] = {"none", "sharp", "soft"};
static const double bar = 0.6, aim = 0.5, soft_aim = 0.25;

// Number of roughnesses that are compared, from 0.05 to 1 in equal steps.
enum { ROUGHNESS_COUNT = 39 };

typedef struct tuning {
    kiln_context *context;
    kiln_map source;
    kiln_spectrum *spectrum;
    kiln_map maps[LAYOUT_COUNT][TUNINGS];
    double seconds[LAYOUT_COUNT][TUNINGS];
    // relative errors; until report() takes the root, `rms` holds the mean square
    bench_figures figures[LAYOUT_COUNT][TUNINGS];
    // relative RMS error of the directions without the brightest 200th of them
    double far[LAYOUT_COUNT][TUNINGS];
    // RMS error of x / (x + mean) for each radiance x, which is about what is seen after a tone
    // curve
    double seen[LAYOUT_COUNT][TUNINGS];
    double mean; // mean radiance of the environment
    // The case lights: lights are taken out of the source, and the first layout and the last tuning
    // are left out.
    bool lights;
    kiln_lights taken;
    double (*directions)[3], (*values)[3];
    double (*lit)[3]; // what the lights that were taken out add in each direction
} tuning;

static int first_layout(const tuning *d)
{
    return d->lights ? 1 : 0;
}

static int tuning_count(const tuning *d)
{
    return d->lights ? SOFT : TUNINGS;
}

static bool bake(bench *b, tuning *d)
{
    for (int i = first_layout(d); i < LAYOUT_COUNT; i++)
        for (int v = 0; v < tuning_count(d); v++) {
            const layout *l = &layouts[i];
            const kiln_engine *engine = kiln_engine_find(l->engine);
            float roughness[KILN_MAX_LEVELS];
            kiln_prefilter_def def;
            if (kiln_engine_levels(engine, l->size, l->level_count, roughness, &def, &b->error))
                return false;
            def.tune_for = v == NONE ? NULL : engine;
            def.tune_soft = v == SOFT;
            double start = bench_cpu();
            if (kiln_prefilter(d->context, &d->source, &def, &d->maps[i][v], &b->error))
                return false;
            d->seconds[i][v] = bench_cpu() - start;
        }
    return true;
}

static int by_size(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static double brightness(const float *rgb)
{
    return (double)rgb[0] + (double)rgb[1] + (double)rgb[2];
}

// Returns the brightness that only the brightest 200th of the directions exceed. In an environment
// with suns these directions are around the suns.
static double find_bright(const kiln_map *truth)
{
    size_t count = kiln_map_texels(truth, 0);
    float *all = malloc(count * sizeof *all);
    for (size_t i = 0; i < count && all; i++)
        all[i] = (float)brightness(truth->level[0] + 3 * i);
    if (all)
        qsort(all, count, sizeof *all, by_size);
    double bright = all ? (double)all[count - 1 - count / 200] : 0;
    free(all);
    return bright;
}

// Returns the lobe's value in a direction, as the mean over the disc of a light. Points on a spiral
// stand for the disc where the lobe changes over the disc.
static double disc_mean(const kiln_lobe *lobe, double width, const kiln_light *light,
                        const double direction[3])
{
    enum { POINTS = 64 };
    const double *l = light->direction;
    double radius = light->angular_radius * acos(-1) / 180, sum = 0, point[3];
    double cosine = l[0] * direction[0] + l[1] * direction[1] + l[2] * direction[2];
    if (acos(fmax(-1, fmin(1, cosine))) > 8 * (radius + width))
        return kiln_lobe_evaluate(lobe, cosine);
    double side = l[2] < 0 ? -1 : 1, a = -1 / (side + l[2]);
    const double t[3] = {1 + side * l[0] * l[0] * a, side * l[0] * l[1] * a, -side * l[0]};
    const double u[3] = {l[0] * l[1] * a, side + l[1] * l[1] * a, -l[1]};
    for (int i = 0; i < POINTS; i++) {
        double sine = sin(radius) * sqrt((i + 0.5) / POINTS), phi = 2.39996322972865332 * i;
        cosine = 0;
        for (int c = 0; c < 3; c++) {
            point[c] = sqrt(1 - sine * sine) * l[c] + sine * (cos(phi) * t[c] + sin(phi) * u[c]);
            cosine += point[c] * direction[c];
        }
        sum += kiln_lobe_evaluate(lobe, fmin(cosine, 1)) / POINTS;
    }
    return sum;
}

// Returns the integral of a lobe of width alpha over the sphere. Nodes are dense near 0.
static double lobe_sum(const kiln_lobe *lobe, double alpha)
{
    enum { NODES = 4000 };
    const double half = acos(-1) / 2, k = log(8 / alpha);
    double sum = 0;
    for (int i = 0; i < NODES; i++) {
        double v = (i + 0.5) / NODES, angle = half * sinh(k * v) / sinh(k);
        double step = half * k * cosh(k * v) / sinh(k) / NODES;
        sum += 4 * half * kiln_lobe_evaluate(lobe, cos(angle)) * sin(angle) * step;
    }
    return sum;
}

// Computes what the lights that were taken out add, as discs, to the filtered environment.
static void light_directions(tuning *d, const kiln_lobe *lobe, double alpha, int count)
{
    double whole = lobe_sum(lobe, alpha);
    memset(d->lit, 0, (size_t)count * sizeof *d->lit);
    for (int i = 0; i < d->taken.count; i++)
        for (int k = 0; k < count; k++) {
            const kiln_light *light = &d->taken.light[i];
            double value = disc_mean(lobe, alpha, light, d->directions[k]);
            for (int c = 0; c < 3; c++)
                d->lit[k][c] += value / whole * light->irradiance[c];
        }
}

// Adds the relative errors of what the engines show of each map at one roughness. The narrower the
// lobe, the more directions are compared.
static bool compare(bench *b, tuning *d, double roughness)
{
    int size = roughness < 0.08 ? 1024 : roughness < 0.15 ? 512 : roughness < 0.4 ? 256 : 128;
    int count = size * size;
    kiln_map truth = {0};
    kiln_lobe lobe = kiln_lobe_ggx(roughness * roughness);
    float one[1] = {(float)roughness};
    kiln_prefilter_def def = {.shape = KILN_SHAPE_OCTAHEDRON, .size = size, .level_count = 1};
    def.roughness = one;
    // The tolerance is for the narrowest lobe, whose spectrum is cut off at the greatest degree
    // with a somewhat larger error than that of other lobes.
    def.tolerance = 5e-4;
    bool done =
        roughness < 0.06
            ? !kiln_prefilter(d->context, &d->source, &def, &truth, &b->error)
            : !kiln_map_create(d->context, KILN_SHAPE_OCTAHEDRON, size, 1, &truth, &b->error) &&
                  !kiln_spectrum_filter(d->context, d->spectrum, &lobe, 0, &truth, 0, &b->error);
    for (int k = 0; k < count && done; k++)
        kiln_map_direction(&truth, 0, (size_t)k, d->directions[k]);
    double bright = done ? find_bright(&truth) : 0;
    if (done)
        light_directions(d, &lobe, roughness * roughness, count);
    for (int m = 0; m < LAYOUT_COUNT * TUNINGS && done; m++) {
        int i = m / TUNINGS, v = m % TUNINGS;
        if (i < first_layout(d) || v >= tuning_count(d))
            continue;
        double off = 0, whole = 0, far_off = 0, far_whole = 0, seen_off = 0, sphere = 0;
        done = !kiln_engine_show(d->context, kiln_engine_find(layouts[i].engine), &d->maps[i][v],
                                 roughness, (const double(*)[3])d->directions, count, d->values,
                                 &b->error);
        for (int k = 0; k < count && done; k++) {
            // The solid angle of an octahedron's texel is proportional to (|x| + |y| + |z|)^3.
            const double *at = d->directions[k];
            double weight = pow(fabs(at[0]) + fabs(at[1]) + fabs(at[2]), 3);
            bool far = brightness(truth.level[0] + 3 * (size_t)k) < bright;
            sphere += 3 * weight;
            for (int c = 0; c < 3; c++) {
                double error = d->values[k][c] - (double)truth.level[0][3 * k + c];
                double wanted = (double)truth.level[0][3 * k + c] + d->lit[k][c];
                double shown = d->values[k][c] + d->lit[k][c];
                double seen = d->mean * error / ((d->mean + wanted) * (d->mean + shown));
                seen_off += weight * seen * seen;
                off += weight * error * error;
                whole += weight * wanted * wanted;
                far_off += far ? weight * error * error : 0;
                far_whole += far ? weight * wanted * wanted : 0;
            }
        }
        // Weight of this roughness in the mean over roughness, by the trapezoidal rule.
        double part = (roughness < 0.051 || roughness > 0.999 ? 0.5 : 1) / (ROUGHNESS_COUNT - 1);
        d->figures[i][v].rms += part * off / whole;
        d->far[i][v] += part * far_off / far_whole;
        d->seen[i][v] += part * seen_off / sphere;
        d->figures[i][v].largest = fmax(d->figures[i][v].largest, sqrt(off / whole));
    }
    kiln_map_free(&truth);
    return done;
}

static void report(bench *b, tuning *d, const char *name)
{
    for (int i = first_layout(d); i < LAYOUT_COUNT; i++) {
        printf("  %-10s %-24s", i > first_layout(d) ? "" : name, layouts[i].title);
        for (int v = 0; v < tuning_count(d); v++) {
            char row[96];
            bench_figures *f = &d->figures[i][v];
            f->rms = sqrt(f->rms);
            d->far[i][v] = sqrt(d->far[i][v]);
            d->seen[i][v] = sqrt(d->seen[i][v]);
            printf("%6.2f /%5.1f,%6.2f,%5.2f (%4.1f s)", 100 * f->rms, 100 * f->largest,
                   100 * d->far[i][v], 100 * d->seen[i][v], d->seconds[i][v]);
            snprintf(row, sizeof row, "%s: %s: %s rms", name, layouts[i].title, tunings[v]);
            bench_value(b, row, "relative", f->rms);
            snprintf(row, sizeof row, "%s: %s: %s largest", name, layouts[i].title, tunings[v]);
            bench_value(b, row, "relative", f->largest);
            snprintf(row, sizeof row, "%s: %s: %s far rms", name, layouts[i].title, tunings[v]);
            bench_value(b, row, "relative", d->far[i][v]);
            snprintf(row, sizeof row, "%s: %s: %s seen rms", name, layouts[i].title, tunings[v]);
            bench_value(b, row, "of white", d->seen[i][v]);
        }
        puts("");
    }
    fflush(stdout);
    // Only courtyard (even light) and sunrise (sun) have bars that their errors must reach.
    if (d->lights || (strcmp(name, "courtyard") != 0 && strcmp(name, "sunrise") != 0))
        return;
    const bench_figures *f = d->figures[0];
    bench_bar(b, "rms of sharp over none, three, 9 levels", f[SHARP].rms / f[NONE].rms, "", bar,
              false);
    bench_aim("rms of sharp over none, three, 9 levels", f[SHARP].rms / f[NONE].rms, "", aim);
    f = d->figures[2];
    if (!strcmp(name, "sunrise"))
        bench_aim("rms of soft over none, babylon", f[SOFT].rms / f[NONE].rms, "", soft_aim);
}

// Loads a panorama, and takes its lights out in the case lights.
static bool load(bench *b, tuning *d, const char *name)
{
    static const kiln_lights_def def = {.share = 0.001};
    char path[1024];
    snprintf(path, sizeof path, "%s/%s.exr", b->data, name);
    if (kiln_map_load(d->context, path, NULL, &d->source, &b->error) ||
        (d->lights && kiln_lights_extract(d->context, &d->source, &def, &d->taken, &b->error)))
        return false;
    double share = 0;
    for (int i = 0; i < d->taken.count; i++)
        share += d->taken.light[i].share;
    if (d->lights)
        printf("  %-10s %d lights with %.1f %% of the light\n", name, d->taken.count, 100 * share);
    return true;
}

static bool check_environment(bench *b, tuning *d, const char *name)
{
    bool done =
        load(b, d, name) &&
        !kiln_spectrum_analyze(d->context, &d->source, KILN_MAX_DEGREE, &d->spectrum, &b->error) &&
        bake(b, d);
    double(*power)[3] = malloc((KILN_MAX_DEGREE + 1) * sizeof *power);
    if (!power)
        done = bench_fail(b, "no memory");
    done = done && !kiln_spectrum_power(d->spectrum, power, &b->error);
    // The power of degree 0 of the spectrum is 4 pi times the squared mean radiance of each
    // channel.
    if (done && power)
        d->mean = sqrt((power[0][0] + power[0][1] + power[0][2]) / (12 * acos(-1)));
    free(power);
    for (int k = 0; k < ROUGHNESS_COUNT && done; k++)
        done = compare(b, d, 0.05 + 0.95 * k / (ROUGHNESS_COUNT - 1));
    if (done)
        report(b, d, name);
    for (int i = 0; i < LAYOUT_COUNT; i++)
        for (int v = 0; v < TUNINGS; v++)
            kiln_map_free(&d->maps[i][v]);
    kiln_spectrum_destroy(d->spectrum);
    kiln_map_free(&d->source);
    return done;
}

// With its lights as discs, a panorama shall err no more than courtyard, which has no lights, and
// night at most twice as much. The lamps and windows of studio and forest are no discs, so that
// parts of these remain.
static void compare_with_calm(bench *b, const tuning *d, const tuning *calm, const char *name)
{
    double limit = strcmp(name, "night") == 0 ? 2 : 1;
    bool promised = strcmp(name, "studio") != 0 && strcmp(name, "forest") != 0;
    for (int i = first_layout(d); i < LAYOUT_COUNT; i++)
        for (int v = 0; v < tuning_count(d); v++) {
            double ratio = d->figures[i][v].rms / calm->figures[i][v].rms;
            char what[96];
            snprintf(what, sizeof what, "%s over courtyard, %s, %s, rms", name, layouts[i].title,
                     tunings[v]);
            if (promised)
                bench_bar(b, what, ratio, "", limit, false);
            else
                bench_aim(what, ratio, "", limit);
        }
}

// Compares all panoramas.
static bool run(bench *b, bool lights)
{
    enum { MOST = 1024 * 1024 };
    kiln_context *context = NULL;
    tuning calm = {0};
    if (kiln_context_create(NULL, &context, &b->error))
        return false;
    printf("  errors of what the engine shows, in %%: relative RMS error over roughness 0.05 to 1 "
           "/ of the\n  worst roughness, relative RMS error without the brightest 200th of the "
           "directions, RMS error\n  of x / (x + mean) with white as 100 %% (CPU time of the "
           "bake)\n  %-35s",
           "");
    for (int v = 0; v < TUNINGS; v++)
        printf("%18s%17s", tunings[v], "");
    puts("");
    double(*directions)[3] = malloc((size_t)3 * MOST * sizeof *directions);
    bool done = directions != NULL || bench_fail(b, "no memory");
    for (int i = 0; i < NAME_COUNT && done; i++) {
        tuning d = {.context = context,
                    .directions = directions,
                    .values = directions + MOST,
                    .lit = directions + (size_t)2 * MOST,
                    .lights = lights};
        done = check_environment(b, &d, names[i]);
        if (i == 0)
            calm = d;
        else if (lights && done)
            compare_with_calm(b, &d, &calm, names[i]);
    }
    free(directions);
    kiln_context_destroy(context);
    return done;
}

bool bench_tune(bench *b)
{
    return run(b, false);
}

bool bench_lights(bench *b)
{
    return run(b, true);
}

// What an engine shows of a bake: its formula from roughness to level, two levels mixed linearly, each
// read bilinearly, against the exact result at that very roughness.
#include "bench.h"

#include <math.h>
#include <stdlib.h>

static const char *const names[] = {"courtyard", "interior", "studio", "forest",
                                    "city",      "sunset",   "night",  "sunrise"};
enum { NAME_COUNT = sizeof names / sizeof *names };

typedef struct layout {
    const char *engine, *title;
    int size, level_count; // 0: the engine's own
} layout;
static const layout layouts[] = {
    {"three", "three, 1024, 9 levels", 1024, 9},
    {"three", "three", 0, 0},
    {"babylon", "babylon", 0, 0},
    {"filament", "filament", 0, 0},
};
enum { LAYOUT_COUNT = sizeof layouts / sizeof *layouts };

static const char *const variants[] = {"none"};
enum { VARIANT_COUNT = sizeof variants / sizeof *variants };

// Roughness .05 to 1 in equal steps.
enum { ROUGHNESS_COUNT = 39 };

typedef struct display {
    kiln_context *context;
    kiln_map source;
    kiln_spectrum *spectrum;
    kiln_map maps[LAYOUT_COUNT][VARIANT_COUNT];
    bench_figures figures[LAYOUT_COUNT][VARIANT_COUNT]; // rms as a sum of squares until the end
    double (*directions)[3], (*values)[3];
} display;

static bool bake(bench *b, display *d)
{
    for (int i = 0; i < LAYOUT_COUNT; i++)
        for (int v = 0; v < VARIANT_COUNT; v++) {
            const layout *l = &layouts[i];
            float roughness[KILN_MAX_LEVELS];
            kiln_prefilter_def def;
            if (kiln_engine_levels(kiln_engine_find(l->engine), l->size, l->level_count, roughness,
                                   &def, &b->error) ||
                kiln_prefilter(d->context, &d->source, &def, &d->maps[i][v], &b->error))
                return false;
        }
    return true;
}

// The relative error at one roughness of each map, over directions as dense as the lobe is narrow.
static bool compare(bench *b, display *d, double roughness)
{
    int size = roughness < 0.08 ? 1024 : roughness < 0.15 ? 512 : roughness < 0.4 ? 256 : 128;
    int count = size * size;
    kiln_map truth = {0};
    kiln_lobe lobe = kiln_lobe_ggx(roughness * roughness);
    float one[1] = {(float)roughness};
    kiln_prefilter_def def = {
        .shape = KILN_SHAPE_OCTAHEDRON, .has_shape = true, .size = size, .level_count = 1};
    def.roughness = one;
    // The narrowest lobe's spectrum ends at the degree limit with a little more left than usual.
    def.tolerance = 5e-4;
    bool done =
        roughness < 0.06
            ? !kiln_prefilter(d->context, &d->source, &def, &truth, &b->error)
            : !kiln_map_create(d->context, KILN_SHAPE_OCTAHEDRON, size, 1, &truth, &b->error) &&
                  !kiln_spectrum_filter(d->context, d->spectrum, &lobe, 0, &truth, 0, &b->error);
    for (int k = 0; k < count && done; k++)
        kiln_map_direction(&truth, 0, (size_t)k, d->directions[k]);
    for (int m = 0; m < LAYOUT_COUNT * VARIANT_COUNT && done; m++) {
        int i = m / VARIANT_COUNT, v = m % VARIANT_COUNT;
        double off = 0, whole = 0;
        done = !kiln_engine_show(d->context, kiln_engine_find(layouts[i].engine), &d->maps[i][v],
                                 roughness, (const double(*)[3])d->directions, count, d->values,
                                 &b->error);
        for (int k = 0; k < count && done; k++) {
            // The solid angle of an octahedron's texel goes by the cube of its |x| + |y| + |z|.
            const double *at = d->directions[k];
            double weight = pow(fabs(at[0]) + fabs(at[1]) + fabs(at[2]), 3);
            for (int c = 0; c < 3; c++) {
                double wanted = (double)truth.level[0][3 * k + c];
                double error = d->values[k][c] - wanted;
                off += weight * error * error;
                whole += weight * wanted * wanted;
            }
        }
        double relative = sqrt(off / whole);
        d->figures[i][v].rms += relative * relative / ROUGHNESS_COUNT;
        d->figures[i][v].largest = fmax(d->figures[i][v].largest, relative);
    }
    kiln_map_free(&truth);
    return done;
}

static void report(bench *b, display *d, const char *name)
{
    printf("  %-10s", name);
    for (int i = 0; i < LAYOUT_COUNT; i++)
        for (int v = 0; v < VARIANT_COUNT; v++) {
            char row[96];
            bench_figures *f = &d->figures[i][v];
            f->rms = sqrt(f->rms);
            printf("%8.2f /%6.1f", 100 * f->rms, 100 * f->largest);
            snprintf(row, sizeof row, "%s: %s: %s rms", name, layouts[i].title, variants[v]);
            bench_value(b, row, "relative", f->rms);
            snprintf(row, sizeof row, "%s: %s: %s largest", name, layouts[i].title, variants[v]);
            bench_value(b, row, "relative", f->largest);
        }
    puts("");
}

static bool check_environment(bench *b, display *d, const char *name)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s.exr", b->data, name);
    bool done =
        !kiln_map_load(d->context, path, NULL, &d->source, &b->error) &&
        !kiln_spectrum_analyze(d->context, &d->source, KILN_MAX_DEGREE, &d->spectrum, &b->error) &&
        bake(b, d);
    for (int k = 0; k < ROUGHNESS_COUNT && done; k++)
        done = compare(b, d, 0.05 + 0.95 * k / (ROUGHNESS_COUNT - 1));
    if (done)
        report(b, d, name);
    for (int i = 0; i < LAYOUT_COUNT; i++)
        for (int v = 0; v < VARIANT_COUNT; v++)
            kiln_map_free(&d->maps[i][v]);
    kiln_spectrum_destroy(d->spectrum);
    kiln_map_free(&d->source);
    return done;
}

bool bench_display(bench *b)
{
    enum { MOST = 1024 * 1024 };
    kiln_context *context = NULL;
    if (kiln_context_create(NULL, &context, &b->error))
        return false;
    printf("  displayed error in %%, rms over roughness .05 to 1 / of the worst roughness\n  %-10s",
           "");
    for (int i = 0; i < LAYOUT_COUNT; i++)
        for (int v = 0; v < VARIANT_COUNT; v++)
            printf(" %s, %s", layouts[i].title, variants[v]);
    puts("");
    double(*directions)[3] = malloc(2 * MOST * sizeof *directions);
    bool done = directions != NULL || bench_fail(b, "no memory");
    for (int i = 0; i < NAME_COUNT && done; i++) {
        display d = {.context = context, .directions = directions, .values = directions + MOST};
        done = check_environment(b, &d, names[i]);
    }
    free(directions);
    kiln_context_destroy(context);
    return done;
}

// The accuracy case. In: eight panoramas and a sky. Out: the relative errors of every prefiltered
// level against brute force, a sum over every texel of the panorama (kiln_reference_filter): the
// RMS and the largest error.
#include "bench.h"

#include <math.h>
#include <string.h>

static const char *const names[] = {"sky",   "city",   "courtyard", "forest", "interior",
                                    "night", "studio", "sunrise",   "sunset"};
enum { NAME_COUNT = sizeof names / sizeof *names, TEXELS = 256 };
static const double rms_bar = 1e-4, largest_bar = 2e-3;

// Compares all texels of a small level, or TEXELS random texels of a larger one, with brute force
// (kiln_reference_filter).
bool bench_check_level(bench *b, kiln_context *context, const kiln_map *source, const kiln_map *map,
                       int level, bench_figures *f)
{
    static double directions[TEXELS][3], truth[TEXELS][3];
    size_t chosen[TEXELS], texels = kiln_map_texels(map, level);
    int count = texels < TEXELS ? (int)texels : TEXELS;
    unsigned long long seed = 1 + (unsigned long long)level;
    for (int i = 0; i < count; i++) {
        seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
        chosen[i] = texels <= TEXELS ? (size_t)i : (size_t)((seed >> 33) * texels >> 31);
        kiln_map_direction(map, level, chosen[i], directions[i]);
    }
    double r = (double)map->roughness[level], off = 0, whole = 0;
    kiln_lobe lobe = kiln_lobe_ggx(r * r);
    if (kiln_reference_filter(context, source, &lobe, 0, (const double(*)[3])directions, count,
                              truth, &b->error))
        return false;
    f->largest = 0;
    for (int i = 0; i < count; i++)
        for (size_t c = 0; c < 3; c++) {
            double d = fabs((double)map->level[level][3 * chosen[i] + c] - truth[i][c]);
            off += d * d;
            whole += truth[i][c] * truth[i][c];
            if (d > 0)
                f->largest = fmax(f->largest, d / truth[i][c]);
        }
    f->rms = whole > 0 ? sqrt(off / whole) : sqrt(off);
    return true;
}

// Returns the relative difference between the mean radiance of the source and of level 0. Level 0
// is the source resampled by area without a lobe, which must not lose light.
static double check_mirror(const kiln_map *source, const kiln_map *map)
{
    double mean[2] = {0}, weights[2] = {0};
    int n = source->size;
    for (size_t i = 0; i < kiln_map_texels(source, 0); i++) {
        size_t row = i / (2 * (size_t)n);
        double weight = sin(((double)row + 0.5) * 3.14159265358979323846 / n);
        mean[0] += weight * (double)source->level[0][3 * i + 1];
        weights[0] += weight;
    }
    int edge = map->size;
    for (size_t i = 0; i < kiln_map_texels(map, 0); i++) {
        // The solid angle of a cube face's texel, from its four corners.
        size_t column = i % (size_t)edge, row = i / (size_t)edge % (size_t)edge;
        double angle = 0;
        for (int c = 0; c < 4; c++) {
            double x = 2 * ((double)column + (c & 1)) / edge - 1;
            double y = 2 * ((double)row + (c >> 1)) / edge - 1;
            angle += (c == 0 || c == 3 ? 1 : -1) * atan2(x * y, sqrt(x * x + y * y + 1));
        }
        mean[1] += angle * (double)map->level[0][3 * i + 1];
        weights[1] += angle;
    }
    return fabs(mean[1] / weights[1] / (mean[0] / weights[0]) - 1);
}

static bool check_environment(bench *b, kiln_context *context, const char *name,
                              bench_figures *worst)
{
    kiln_map source = {0}, map = {0};
    kiln_result result;
    char path[1024], row[64];
    if (!strcmp(name, "sky")) {
        result = kiln_sky(context, NULL, &source, &b->error);
    } else {
        snprintf(path, sizeof path, "%s/%s.exr", b->data, name);
        result = kiln_map_load(context, path, NULL, &source, &b->error);
    }
    if (!result)
        result = kiln_prefilter(context, &source, NULL, &map, &b->error);
    bool done = result == KILN_OK;
    if (done) {
        double mirror = check_mirror(&source, &map);
        printf("  %-11s%9.1e", name, mirror);
        snprintf(row, sizeof row, "%s mirror mean", name);
        bench_value(b, row, "relative", mirror);
        worst->rms = fmax(worst->rms, mirror);
    }
    bench_figures own = {0};
    for (int k = 1; k < map.level_count && done; k++) {
        bench_figures f = {0};
        done = bench_check_level(b, context, &source, &map, k, &f);
        own.rms = fmax(own.rms, f.rms);
        own.largest = fmax(own.largest, f.largest);
        printf("%9.1e", f.rms);
        fflush(stdout);
        snprintf(row, sizeof row, "%s level %d rms", name, k);
        bench_value(b, row, "relative", f.rms);
        snprintf(row, sizeof row, "%s level %d largest", name, k);
        bench_value(b, row, "relative", f.largest);
    }
    if (done)
        printf("%11.1e\n", own.largest);
    worst->rms = fmax(worst->rms, own.rms);
    worst->largest = fmax(worst->largest, own.largest);
    kiln_map_free(&map);
    kiln_map_free(&source);
    return done;
}

bool bench_accuracy(bench *b)
{
    kiln_context *context = NULL;
    bench_figures worst = {0};
    if (kiln_context_create(NULL, &context, &b->error))
        return false;
    printf(
        "  relative RMS error by the roughness of the level, from 256 texels of each level (at\n  "
        "roughness 0 the relative error of the mean); last column: the largest error\n  %-11s",
        "");
    for (int k = 0; k < 9; k++)
        printf("%9.3f", k / 8.0);
    printf("%11s\n", "largest");
    bool done = true;
    for (int i = 0; i < NAME_COUNT && done; i++)
        done = check_environment(b, context, names[i], &worst);
    if (done) {
        bench_bar(b, "largest RMS error of a level", worst.rms, "", rms_bar, false);
        bench_bar(b, "largest error of a value", worst.largest, "", largest_bar, false);
    }
    kiln_context_destroy(context);
    return done;
}

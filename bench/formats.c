// The program bench_formats, which bench/engines/formats.mjs calls: what each format of each engine
// costs in accuracy.
//     bench_formats PANORAMA FOLDER [ENGINE...]
// In: a panorama. Out: for each engine of `kiln engines` and each of the engine's formats, the
// files in FOLDER as `kiln bake --for` writes them by default, and a line
//     ENGINE FORMAT TUNED ALONE SHOWN WORST DISPLAYED SECONDS PATH
// ALONE is the RMS difference of the file's levels from the unrounded levels, relative to the RMS
// of a level and then over all levels; for an atlas, from the levels of the engine's atlas of
// halves. SHOWN, WORST and DISPLAYED are the errors of kiln_check_shown, and SECONDS the CPU time
// that writing took. An engine without formats has the format "-". "?" stands for errors of files
// that kiln_levels_load does not read.
#include <kiln/check.h>
#include <kiln/kiln.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct bench {
    kiln_context *context;
    kiln_map panorama;
    const char *folder;
    kiln_check_levels_report axes; // of the engine's first file; only the axes are used
    kiln_error error;
} bench;

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// Returns the direction of the centre of a texel of a cube face. s goes to the right and t down.
static void face_direction(int face, double s, double t, double d[3])
{
    const double all[6][3] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t},
                              {s, -1, -t}, {s, -t, 1},  {-s, -t, -1}};
    memcpy(d, all[face], sizeof all[face]);
}

// Returns the number of the texel, counted over all faces of `size`, that a direction meets.
static size_t texel_of(const double d[3], int size)
{
    int axis = fabs(d[0]) >= fabs(d[1]) && fabs(d[0]) >= fabs(d[2]) ? 0
               : fabs(d[1]) >= fabs(d[2])                           ? 1
                                                                    : 2;
    int face = 2 * axis + (d[axis] < 0);
    double m = fabs(d[axis]), sign = d[axis] < 0 ? -1 : 1;
    double s = (axis == 0 ? -sign * d[2] : axis == 1 ? d[0] : sign * d[0]) / m;
    double t = (axis == 1 ? sign * d[2] : -d[1]) / m;
    int x = (int)floor((s + 1) / 2 * size), y = (int)floor((t + 1) / 2 * size);
    return ((size_t)face * (size_t)size + (size_t)y) * (size_t)size + (size_t)x;
}

// Returns the RMS difference of level k of a file, in the axes of the file, from a cube in kiln's
// directions, relative to the RMS value of the level of the cube.
static double level_error(const kiln_map *file, const kiln_check_levels_report *axes,
                          const kiln_map *cube, int k)
{
    int n = kiln_map_level_size(cube, k);
    double off = 0, all = 0;
    for (size_t i = 0; i < 6 * (size_t)n * (size_t)n; i++) {
        double e[3], d[3];
        int face = (int)(i / (size_t)(n * n)), y = (int)(i / (size_t)n) % n,
            x = (int)(i % (size_t)n);
        face_direction(face, (2 * x + 1.0) / n - 1, (2 * y + 1.0) / n - 1, e);
        for (int c = 0; c < 3; c++)
            d[c] = axes->sign[c] * e[axes->axis[c]];
        const float *is = file->level[k] + 3 * i, *wanted = cube->level[k] + 3 * texel_of(d, n);
        for (int c = 0; c < 3; c++) {
            off += pow((double)is[c] - (double)wanted[c], 2);
            all += pow((double)wanted[c], 2);
        }
    }
    return sqrt(off / all);
}

static double levels_error(const kiln_map *file, const kiln_check_levels_report *axes,
                           const kiln_map *cube)
{
    double sum = 0;
    for (int k = 0; k < cube->level_count; k++)
        sum += pow(level_error(file, axes, cube, k), 2);
    return sqrt(sum / cube->level_count);
}

// An engine that reads an atlas, whose levels are compared with those of an atlas of halves.
static const struct {
    const char *engine, *halves; // the engine, and the engine that writes the atlas of halves
} atlases[] = {{"three-cubeuv", "three-cubeuv"},
               {"playcanvas", "playcanvas-dds"},
               {"playcanvas-dds", "playcanvas-dds"}};

static const char *halves_of(const char *engine)
{
    for (size_t i = 0; i < sizeof atlases / sizeof *atlases; i++)
        if (!strcmp(atlases[i].engine, engine))
            return atlases[i].halves;
    return NULL;
}

static void report_missing(const char *what, const kiln_error *error)
{
    fprintf(stderr, "%s: %s\n", what, error->message);
}

// Writes the files of an engine, and sets `path` to the path of the file that holds the levels.
static kiln_result write_files(bench *b, const kiln_engine *engine, kiln_format format,
                               const kiln_environment *made, char path[512], double *time)
{
    const char *ending = kiln_engine_ending(engine, format);
    const char *word = format ? kiln_format_names()[format] : "only";
    char stem[400];
    snprintf(stem, sizeof stem, "%s/%s-%s", b->folder, engine->name, word);
    snprintf(path, 512, "%s%s%s", stem, ending[0] ? "." : "", ending);
    double begin = seconds();
    kiln_result result = kiln_engine_save(b->context, engine, &made->levels, &made->sh, format,
                                          path, NULL, &b->error);
    *time = seconds() - begin;
    if (!ending[0])
        snprintf(path, 512, "%s%s", stem,
                 !strcmp(engine->name, "filament") ? "_ibl.ktx"
                 : !strcmp(engine->name, "bevy")   ? "_specular.ktx2"
                                                   : ".ktx2");
    return result;
}

// Sets *alone to the error that halves have, from the cube alone.
static kiln_result round_halves(bench *b, const kiln_map *cube, double *alone)
{
    char path[512];
    kiln_map back = {0}, halving = *cube; // a KTX2 file holds the levels whose sizes are halved
    const kiln_save_def def = {.format = KILN_FORMAT_RGBA16F};
    const kiln_check_levels_report none = {.axis = {0, 1, 2}, .sign = {1, 1, 1}};
    snprintf(path, sizeof path, "%s/halves.ktx2", b->folder);
    halving.smallest = 0;
    while (cube->size >> (halving.level_count - 1) < cube->smallest)
        halving.level_count--;
    kiln_result result = kiln_map_save(b->context, &halving, path, &def, NULL, &b->error);
    if (result == KILN_OK)
        result = kiln_map_load(b->context, path, NULL, &back, &b->error);
    if (result == KILN_OK)
        *alone = levels_error(&back, &none, &halving);
    kiln_map_free(&back);
    return result;
}

// Sets *alone to the error of the levels of an atlas from those of the atlas of halves.
static kiln_result compare_atlas(bench *b, const kiln_engine *engine, const kiln_map *file,
                                 const kiln_environment *made, double *alone)
{
    char path[512];
    double time;
    kiln_map halves = {0};
    const kiln_check_levels_report none = {.axis = {0, 1, 2}, .sign = {1, 1, 1}};
    const kiln_engine *other = kiln_engine_find(halves_of(engine->name));
    kiln_result result = write_files(b, other, other->formats[0], made, path, &time);
    if (result == KILN_OK)
        result = kiln_levels_load(b->context, path, other, NULL, &halves, &b->error);
    if (result == KILN_OK)
        *alone = levels_error(file, &none, &halves);
    kiln_map_free(&halves);
    return result;
}

// Sets *alone to the error of a file's levels from the cube that the file was written from.
static kiln_result compare(bench *b, const kiln_engine *engine, kiln_format format,
                           const kiln_map *file, const kiln_environment *made, double *alone)
{
    const char *halves = halves_of(engine->name);
    bool rounded = format == KILN_FORMAT_RGBA16F || (halves && !strcmp(halves, engine->name));
    if (halves && rounded && format != KILN_FORMAT_UASTC)
        return round_halves(b, &made->levels, alone);
    if (halves)
        return compare_atlas(b, engine, file, made, alone);
    const kiln_check_levels_def def = {.engine = engine};
    kiln_result result = KILN_OK;
    if (format == engine->formats[0])
        result = kiln_check_levels(b->context, &b->panorama, file, &def, &b->axes, NULL, &b->error);
    if (result == KILN_OK)
        *alone = levels_error(file, &b->axes, &made->levels);
    return result;
}

// Prints the error of a file that holds a panorama, which was written from `cube`.
static kiln_result measure_panorama(bench *b, const kiln_map *cube, double time, const char *path)
{
    kiln_map file = {0}, wanted = {0};
    double off = 0, all = 0;
    kiln_result result = kiln_map_load(b->context, path, NULL, &file, &b->error);
    if (result == KILN_OK)
        result = kiln_map_convert(b->context, cube, KILN_SHAPE_PANORAMA, file.size, 0, &wanted,
                                  &b->error);
    for (size_t i = 0; !result && i < 3 * kiln_map_texels(&wanted, 0); i++) {
        off += pow((double)file.level[0][i] - (double)wanted.level[0][i], 2);
        all += pow((double)wanted.level[0][i], 2);
    }
    if (result == KILN_OK)
        printf("%.4g ? ? ? %.3f %s\n", sqrt(off / all), time, path);
    kiln_map_free(&file);
    kiln_map_free(&wanted);
    return result;
}

static kiln_result measure(bench *b, const kiln_engine *engine, kiln_format format,
                           const kiln_environment *made)
{
    char path[512];
    double time, alone = 0;
    kiln_map file = {0};
    kiln_check_shown_report shown;
    const char *word = format ? kiln_format_names()[format] : "-";
    kiln_result result = write_files(b, engine, format, made, path, &time);
    if (result != KILN_OK)
        return result;
    printf("%s %s %d ", engine->name, word, engine->tune);
    if (kiln_engine_level(engine, 0.5, engine->size, engine->level_count) < 0)
        return measure_panorama(b, &made->levels, time, path);
    result = kiln_levels_load(b->context, path, engine, NULL, &file, &b->error);
    if (result == KILN_OK)
        result = compare(b, engine, format, &file, made, &alone);
    if (result == KILN_OK)
        result = kiln_check_shown(b->context, &b->panorama, &file, engine, &shown, &b->error);
    if (result == KILN_OK)
        printf("%.4g %.4g %.4g %.4g", alone, shown.all, shown.worst, shown.displayed);
    else
        printf("? ? ? ?");
    printf(" %.3f %s\n", time, path);
    fflush(stdout);
    if (result != KILN_OK)
        report_missing(engine->name, &b->error);
    kiln_map_free(&file);
    return KILN_OK;
}

static kiln_result measure_engine(bench *b, const kiln_engine *engine)
{
    kiln_environment made = {0};
    const kiln_bake_def def = {.engine = engine, .irradiance_size = KILN_NO_IRRADIANCE};
    kiln_result result = kiln_bake(b->context, &b->panorama, &def, &made, &b->error);
    for (int i = 0; i < 4 && !result && (!i || engine->formats[i]); i++)
        result = measure(b, engine, engine->formats[i], &made);
    kiln_environment_free(&made);
    return result;
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "bench_formats PANORAMA FOLDER [ENGINE...]\n");
        return 2;
    }
    bench b = {.folder = argv[2]};
    kiln_result result = kiln_context_create(NULL, &b.context, &b.error);
    if (result == KILN_OK)
        result = kiln_map_load(b.context, argv[1], NULL, &b.panorama, &b.error);
    const kiln_engine *engine;
    for (int i = 0; result == KILN_OK && (engine = kiln_engine_at(i)) != NULL; i++) {
        bool wanted = argc == 3;
        for (int k = 3; k < argc; k++)
            wanted |= !strcmp(argv[k], engine->name);
        if (wanted)
            result = measure_engine(&b, engine);
    }
    if (result != KILN_OK)
        report_missing(argv[1], &b.error);
    kiln_map_free(&b.panorama);
    kiln_context_destroy(b.context);
    return result != KILN_OK;
}

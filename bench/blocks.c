// The program bench_blocks, which bench/blocks/blocks.mjs calls for kiln's part of the comparison
// of BC6H encoders.
//     bench_blocks save PANORAMA TRUTH.ktx2 BLOCKS.dds
//         bakes, writes the levels as floats and as BC6H, and prints the least CPU time of the
//         encoding in microseconds for each texel
//     bench_blocks uastc - TRUTH.ktx2 BLOCKS.ktx2
//         writes the levels as UASTC HDR, and prints the least CPU time likewise, then for each
//         level three errors: the RMS difference of half floats' bits; the RMS error divided by the
//         RMS radiance; and the RMS difference of x / (x + m), where x is a radiance and m the mean
//         of the level, which is about how much the errors show on a screen
//     bench_blocks error TRUTH.ktx2 LEVEL PICTURE
//         prints these three errors of a picture of six faces, one below the other, from a level
//         of TRUTH
#include <kiln/kiln.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

// Returns the CPU seconds of the process, in which one thread works.
static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// Saves a cube five times, and sets *microseconds to the CPU time that the fastest of them took for
// each texel.
static kiln_result time_save(kiln_context *context, const kiln_map *cube, const char *path,
                             const kiln_save_def *def, double *microseconds, kiln_error *error)
{
    double fastest = 1e9, texels = 0;
    kiln_result result = KILN_OK;
    for (int k = 0; k < cube->level_count; k++)
        texels += (double)kiln_map_texels(cube, k);
    for (int i = 0; i < 5 && !result; i++) {
        double begin = seconds();
        result = kiln_map_save(context, cube, path, def, NULL, error);
        fastest = fmin(fastest, seconds() - begin);
    }
    *microseconds = fastest * 1e6 / texels;
    return result;
}

static kiln_result save(kiln_context *context, char **argv, kiln_error *error)
{
    kiln_map panorama = {0}, cube = {0};
    kiln_save_def floats = {.format = KILN_FORMAT_RGBA32F}, blocks = {.format = KILN_FORMAT_BC6H};
    kiln_prefilter_def def = {.size = 256};
    kiln_result result = kiln_map_load(context, argv[2], NULL, &panorama, error);
    if (!result)
        result = kiln_prefilter(context, &panorama, &def, &cube, error);
    if (!result)
        result = kiln_map_save(context, &cube, argv[3], &floats, NULL, error);
    double microseconds = 0;
    if (!result)
        result = time_save(context, &cube, argv[4], &blocks, &microseconds, error);
    if (!result)
        printf("%.4f\n", microseconds);
    kiln_map_free(&panorama);
    kiln_map_free(&cube);
    return result;
}

// Returns the bits of a half float as a number, interpolated between neighbouring half floats. Each
// factor of two in value has 1024 such numbers.
static double code(double value)
{
    int exponent;
    double mantissa = frexp(value, &exponent);
    return value < ldexp(1, -14) ? ldexp(value, 24) : 1024 * (exponent + 14 + 2 * mantissa - 1);
}

static void print_errors(const float *truth, const float *values, size_t count)
{
    double codes = 0, off = 0, all = 0, mean = 0, shown = 0;
    for (size_t i = 0; i < count; i++)
        mean += (double)truth[i] / (double)count;
    for (size_t i = 0; i < count; i++) {
        double a = (double)truth[i], b = (double)values[i];
        double tone = a / (a + mean) - b / (b + mean);
        codes += (code(a) - code(b)) * (code(a) - code(b));
        off += (a - b) * (a - b);
        all += a * a;
        shown += tone * tone;
    }
    printf(" %.6g %.6g %.6g", sqrt(codes / (double)count), sqrt(off / all),
           sqrt(shown / (double)count));
}

static kiln_result save_uastc(kiln_context *context, char **argv, kiln_error *error)
{
    kiln_map cube = {0}, back = {0};
    kiln_save_def blocks = {.format = KILN_FORMAT_UASTC};
    kiln_result result = kiln_map_load(context, argv[3], NULL, &cube, error);
    double microseconds = 0;
    if (!result)
        result = time_save(context, &cube, argv[4], &blocks, &microseconds, error);
    if (!result)
        result = kiln_map_load(context, argv[4], NULL, &back, error);
    if (!result)
        printf("%.4f", microseconds);
    for (int k = 0; k < cube.level_count && !result; k++)
        print_errors(cube.level[k], back.level[k], 3 * kiln_map_texels(&cube, k));
    kiln_map_free(&cube);
    kiln_map_free(&back);
    return result;
}

static kiln_result compare(kiln_context *context, char **argv, kiln_error *error)
{
    kiln_map truth = {0};
    kiln_image picture = {0};
    int level = atoi(argv[3]);
    kiln_result result = kiln_map_load(context, argv[2], NULL, &truth, error);
    if (!result)
        result = kiln_image_load(context, argv[4], &picture, error);
    size_t count = result ? 0 : 3 * kiln_map_texels(&truth, level);
    if (!result && (size_t)picture.width * (size_t)picture.height * 3 != count) {
        fprintf(stderr, "%s: %d x %d\n", argv[4], picture.width, picture.height);
        result = KILN_ERROR_FORMAT;
        count = 0;
    }
    if (!result)
        print_errors(truth.level[level], picture.pixels, count);
    kiln_map_free(&truth);
    kiln_image_free(&picture);
    return result;
}

int main(int argc, char **argv)
{
    kiln_context *context = NULL;
    kiln_error error = {0};
    if (argc != 5) {
        fprintf(stderr, "bench_blocks save PANORAMA TRUTH BLOCKS | error TRUTH LEVEL PICTURE\n");
        return 2;
    }
    kiln_result result =
        kiln_context_create(&(kiln_context_def){.thread_count = 1}, &context, &error);
    if (!result)
        result = !strcmp(argv[1], "save")    ? save(context, argv, &error)
                 : !strcmp(argv[1], "uastc") ? save_uastc(context, argv, &error)
                                             : compare(context, argv, &error);
    kiln_context_destroy(context);
    if (result)
        fprintf(stderr, "%s\n", error.message);
    return result != KILN_OK;
}

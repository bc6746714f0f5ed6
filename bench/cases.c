// The cases that measure kiln inside one process: plans for probes, threads, instruction sets,
// files, the growth of time with sizes, and a fixed bake whose instructions are counted. In:
// panoramas. Out: times, errors and hashes, printed and as rows of CSV files.
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST = 16 }; // number of samples of the case scaling

// Bakes levels once with kiln_bake, which makes, executes and destroys a plan.
static bool bake_once(bench *b, kiln_context *context, const kiln_map *source,
                      const kiln_prefilter_def *def, kiln_map *map, int *degree)
{
    kiln_bake_def bake = {.levels = def ? *def : (kiln_prefilter_def){0},
                          .irradiance_size = KILN_NO_IRRADIANCE};
    kiln_environment environment;
    bool done = !kiln_bake(context, source, &bake, &environment, &b->error);
    *map = environment.levels;
    if (done && degree)
        *degree = environment.degree;
    return done;
}

// ------------------------------------------------------------------------------------------- probe

static bool probe_at(bench *b, kiln_context *context, const kiln_map *source, double tolerance,
                     double fft)
{
    kiln_bake_def def = {.levels = {.size = 64, .level_count = 7, .tolerance = tolerance},
                         .irradiance_size = KILN_NO_IRRADIANCE};
    kiln_environment environment = {0};
    const kiln_map *map = &environment.levels;
    kiln_plan *plan = NULL;
    double create[BENCH_MAX_RUNS], execute[BENCH_MAX_RUNS];
    bench_figures worst = {0};
    bool done = true;
    for (int i = 0; i < b->runs && done; i++) {
        kiln_plan_destroy(plan);
        plan = NULL;
        double start = bench_cpu();
        done = !kiln_plan_create(context, source->shape, source->size, &def, &plan, &b->error);
        create[i] = bench_cpu() - start;
    }
    done = done && !kiln_plan_environment(plan, &environment, &b->error);
    // An execution is short, so each run takes the fastest of 20 executions.
    for (int i = 0; i < b->runs && done; i++) {
        execute[i] = HUGE_VAL;
        for (int k = 0; k < 20 && done; k++) {
            double start = bench_cpu();
            done = !kiln_plan_execute(plan, source, &environment, &b->error);
            execute[i] = fmin(execute[i], bench_cpu() - start);
        }
    }
    for (int l = 1; l < map->level_count && done; l++) {
        bench_figures f;
        done = bench_check_level(b, context, source, map, l, &f);
        worst.rms = fmax(worst.rms, f.rms);
        worst.largest = fmax(worst.largest, f.largest);
    }
    if (done) {
        char name[64];
        bench_times c = bench_sum_up(create, b->runs), e = bench_sum_up(execute, b->runs);
        printf("  tolerance %g: degree %d, RMS error %.1e, largest error %.1e\n", tolerance,
               kiln_spectrum_degree(kiln_plan_spectrum(plan)), worst.rms, worst.largest);
        snprintf(name, sizeof name, "plan create, %g", tolerance);
        bench_row(b, name, "s", c);
        printf("  %-46s %10.3f ms\n", "creating the plan", 1e3 * c.median);
        snprintf(name, sizeof name, "plan execute, %g", tolerance);
        bench_row(b, name, "s", e);
        bench_aim("executing the plan, CPU time", 1e3 * e.median, "ms", 2);
        snprintf(name, sizeof name, "plan over fft, %g", tolerance);
        bench_value(b, name, "ratio", e.minimum / fft);
        printf("  %-46s %10.2f\n", "the same / time of the Fourier transform", e.minimum / fft);
    }
    kiln_environment_free(&environment);
    kiln_plan_destroy(plan);
    return done;
}

bool bench_probe(bench *b)
{
    static const double tolerances[] = {1.5e-4, 1e-3, 1e-2};
    kiln_context *context = NULL;
    kiln_context_def one = {.thread_count = 1};
    kiln_map source = {0};
    bool done =
        !kiln_context_create(&one, &context, &b->error) && bench_city(b, context, 128, &source);
    double fft = bench_fft_seconds(), peak = done ? bench_peak_flops(context) : 0;
    printf(
        "  yardsticks: a Fourier transform of %d complex doubles takes %.3f ms; one core does %.1f "
        "thousand million\n  multiplications and additions a second (%s)\n",
        BENCH_FFT_LENGTH, 1e3 * fft, 1e-9 * peak, done ? kiln_context_cpu(context) : "");
    bench_value(b, "fft", "s", fft);
    bench_value(b, "peak", "flops", peak);
    for (int i = 0; i < 3 && done; i++)
        done = probe_at(b, context, &source, tolerances[i], fft);
    kiln_map_free(&source);
    kiln_context_destroy(context);
    return done;
}

// ----------------------------------------------------------------------- threads, instruction sets

static bool measure_context(bench *b, const kiln_context_def *def, const char *name,
                            unsigned long long *hash, bool *same)
{
    kiln_context *context = NULL;
    kiln_map source = {0}, map = {0};
    double wall[BENCH_MAX_RUNS], cpu[BENCH_MAX_RUNS];
    char row[64];
    bool done =
        !kiln_context_create(def, &context, &b->error) && bench_city(b, context, 512, &source);
    for (int i = 0; i < b->runs && done; i++) {
        kiln_map_free(&map);
        double start = bench_wall(), start_cpu = bench_cpu();
        done = bake_once(b, context, &source, NULL, &map, NULL);
        wall[i] = bench_wall() - start;
        cpu[i] = bench_cpu() - start_cpu;
    }
    if (done) {
        unsigned long long own = bench_hash(&map);
        *same &= !*hash || own == *hash;
        *hash = own;
        bench_times w = bench_sum_up(wall, b->runs), c = bench_sum_up(cpu, b->runs);
        printf("  %-12s%9.1f ms%9.1f ms CPU   %016llx\n", name, 1e3 * w.median, 1e3 * c.median,
               own);
        snprintf(row, sizeof row, "%s wall", name);
        bench_row(b, row, "s", w);
        snprintf(row, sizeof row, "%s cpu", name);
        bench_row(b, row, "s", c);
    }
    kiln_map_free(&map);
    kiln_map_free(&source);
    kiln_context_destroy(context);
    return done;
}

bool bench_threads(bench *b)
{
    unsigned long long hash = 0;
    bool done = true, same = true;
    for (int n = 1; n <= 2 && done; n++) {
        kiln_context_def def = {.thread_count = n};
        done = measure_context(b, &def, n == 1 ? "1 thread" : "2 threads", &hash, &same);
    }
    if (done)
        bench_bar(b, "all results have the same bits (1: yes)", same, "", 1, true);
    return done;
}

bool bench_instructions(bench *b)
{
    static const char *const names[] = {"scalar", "sse2", "avx2", "avx512"};
    unsigned long long hash = 0;
    bool done = true, same = true;
    for (int k = 0; k < 4 && done; k++) {
        kiln_context_def def = {.thread_count = 1, .cpu = (enum kiln_cpu)(KILN_CPU_SCALAR + k)};
        kiln_context *context = NULL;
        if (kiln_context_create(&def, &context, &b->error))
            return false;
        bool has = !strcmp(kiln_context_cpu(context), names[k]);
        kiln_context_destroy(context);
        if (has)
            done = measure_context(b, &def, names[k], &hash, &same);
        else
            printf("  %-12s this machine does not have it\n", names[k]);
    }
    if (done)
        bench_bar(b, "all results have the same bits (1: yes)", same, "", 1, true);
    return done;
}

// ------------------------------------------------------------------------------------------- files

// Returns the seconds that reading every texel from memory once takes. No function that uses every
// texel can be faster.
static double read_all(const kiln_map *map)
{
    double best = HUGE_VAL;
    volatile float sink;
    size_t count = 3 * kiln_map_texels(map, 0);
    for (int run = 0; run < 5; run++) {
        float lanes[64] = {0};
        double start = bench_cpu();
        for (size_t i = 0; i + 64 <= count; i += 64)
            for (size_t k = 0; k < 64; k++)
                lanes[k] += map->level[0][i + k];
        float sum = 0;
        for (int k = 0; k < 64; k++)
            sum += lanes[k];
        sink = sum;
        best = fmin(best, bench_cpu() - start);
    }
    (void)sink; // keeps the compiler from removing the loop
    return best;
}

bool bench_files(bench *b)
{
    enum { READ, BAKE, WRITE, PASS, STAGES };
    static const char *const names[STAGES] = {"read", "bake", "write", "bake while reading"};
    double times[STAGES][BENCH_MAX_RUNS], floor_time = 0;
    char path[1024], output[1024];
    kiln_context *context = NULL;
    snprintf(path, sizeof path, "%s/city2k.exr", b->inputs);
    snprintf(output, sizeof output, "%s/files.ktx2", b->inputs);
    if (kiln_context_create(NULL, &context, &b->error))
        return false;
    bool done = true;
    for (int i = 0; i < b->runs && done; i++) {
        kiln_map source = {0};
        kiln_environment made = {0};
        double t[STAGES + 1];
        t[0] = bench_cpu();
        done = !kiln_map_load(context, path, NULL, &source, &b->error);
        t[1] = bench_cpu();
        done = done && !kiln_bake(context, &source, NULL, &made, &b->error);
        t[2] = bench_cpu();
        kiln_save_def def = {.sh = &made.sh};
        done = done && !kiln_map_save(context, &made.levels, output, &def, NULL, &b->error);
        t[3] = bench_cpu();
        kiln_environment passed = {0};
        done = done && !kiln_bake_file(context, path, NULL, NULL, NULL, &passed, &b->error);
        t[4] = bench_cpu();
        kiln_environment_free(&passed);
        for (int k = 0; k < STAGES && done; k++)
            times[k][i] = t[k + 1] - t[k];
        if (done && i == 0)
            floor_time = read_all(&source);
        kiln_environment_free(&made);
        kiln_map_free(&source);
    }
    remove(output);
    if (done) {
        bench_times sums[STAGES];
        for (int k = 0; k < STAGES; k++) {
            sums[k] = bench_sum_up(times[k], b->runs);
            printf("  %-46s %10.2f ms CPU\n", names[k], 1e3 * sums[k].median);
            bench_row(b, names[k], "s", sums[k]);
        }
        double files = sums[READ].median + sums[WRITE].median;
        printf("  %-46s %10.2f ms CPU, the bake takes %.0f times as long\n",
               "reading every texel from memory once", 1e3 * floor_time,
               sums[BAKE].median / floor_time);
        bench_value(b, "floor", "s", floor_time);
        double ratio = (sums[PASS].median + sums[WRITE].median) / files;
        bench_value(b, "whole over files", "ratio", ratio);
        bench_aim("(bake while reading + write) / (read + write)", ratio, "", 1.5);
    }
    kiln_context_destroy(context);
    return done;
}

// ----------------------------------------------------------------------------------------- scaling

// The terms of the model of a bake's time: number of texels read, number of texels written, and the
// third power of the spectrum's degree.
enum { TERMS = 3 };
typedef struct sample {
    double terms[TERMS], seconds;
} sample;

// Fits the model of a bake's time to samples: sets cost[] to the seconds for a unit of each term,
// none negative, that give the least relative errors. Solves the normal equations for one unknown
// after another, over and over.
static void fit(const sample *s, int count, double cost[TERMS])
{
    double matrix[TERMS][TERMS] = {{0}}, right[TERMS] = {0};
    for (int i = 0; i < count; i++)
        for (int j = 0; j < TERMS; j++) {
            double x = s[i].terms[j] / s[i].seconds;
            right[j] += x;
            for (int k = 0; k < TERMS; k++)
                matrix[j][k] += x * s[i].terms[k] / s[i].seconds;
        }
    for (int j = 0; j < TERMS; j++)
        cost[j] = 0;
    for (int round = 0; round < 10000; round++)
        for (int j = 0; j < TERMS; j++) {
            double rest = right[j];
            for (int k = 0; k < TERMS; k++)
                rest -= k == j ? 0 : matrix[j][k] * cost[k];
            cost[j] = fmax(0, rest / matrix[j][j]);
        }
}

// Returns the slope of the logarithm of measured seconds over the logarithm of the modelled time.
// The slope is 1 if the measured time grows as the model does.
static double exponent(const sample *s, int count, const double cost[TERMS])
{
    double x = 0, y = 0, xx = 0, xy = 0;
    for (int i = 0; i < count; i++) {
        double sum = 0;
        for (int k = 0; k < TERMS; k++)
            sum += cost[k] * s[i].terms[k];
        double u = log(sum), v = log(s[i].seconds);
        x += u, y += v, xx += u * u, xy += u * v;
    }
    return (count * xy - x * y) / (count * xx - x * x);
}

bool bench_scaling(bench *b)
{
    static const int inputs[] = {512, 1024, 2048, 4096}, faces[] = {128, 256, 512, 1024};
    sample samples[LONGEST];
    int count = 0;
    kiln_context *context = NULL;
    if (kiln_context_create(NULL, &context, &b->error))
        return false;
    printf("  milliseconds of CPU time and (degree of the spectrum), by panorama and size of the "
           "faces\n  %-12s",
           "input");
    for (int f = 0; f < 4; f++)
        printf("%16d", faces[f]);
    bool done = true;
    for (int i = 0; i < 4 && done; i++) {
        kiln_map source = {0};
        done = bench_city(b, context, inputs[i], &source);
        printf("\n  %4d x %-5d", 2 * inputs[i], inputs[i]);
        for (int f = 0; f < 4 && done; f++) {
            kiln_prefilter_def def = {.size = faces[f]};
            double times[BENCH_MAX_RUNS];
            int degree = 0;
            for (int k = 0; k < b->runs && done; k++) {
                kiln_map map = {0};
                double start = bench_cpu();
                done = bake_once(b, context, &source, &def, &map, &degree);
                times[k] = bench_cpu() - start;
                kiln_map_free(&map);
            }
            if (!done)
                break;
            bench_times t = bench_sum_up(times, b->runs);
            printf("%9.1f (%4d)", 1e3 * t.median, degree);
            fflush(stdout);
            char row[64];
            snprintf(row, sizeof row, "%dx%d to %d", 2 * inputs[i], inputs[i], faces[f]);
            bench_row(b, row, "s", t);
            samples[count++] = (sample){
                {2.0 * inputs[i] * inputs[i], 8.0 * faces[f] * faces[f], pow(degree, 3)}, t.median};
        }
        kiln_map_free(&source);
    }
    puts("");
    if (done) {
        double cost[TERMS];
        fit(samples, count, cost);
        printf("  fitted: %.2f ns for each texel read + %.2f ns for each texel written + %.3f ns x "
               "degree^3\n",
               1e9 * cost[0], 1e9 * cost[1], 1e9 * cost[2]);
        bench_value(b, "texel read", "s", cost[0]);
        bench_value(b, "texel written", "s", cost[1]);
        bench_value(b, "degree cubed", "s", cost[2]);
        double slope = exponent(samples, count, cost);
        bench_value(b, "exponent", "", slope);
        bench_bar(b, "exponent of the time over the fitted time", slope, "", 1.05, false);
    }
    kiln_context_destroy(context);
    return done;
}

// ------------------------------------------------------------------------------------------- fixed

// A bake that does the same work on every machine: no file, one thread, AVX2. bench/run.sh counts
// its instructions.
bool bench_fixed(bench *b)
{
    kiln_context_def one = {.thread_count = 1, .cpu = KILN_CPU_AVX2};
    kiln_prefilter_def def = {.size = 64, .level_count = 7};
    kiln_context *context = NULL;
    kiln_map source = {0}, map = {0};
    bool done = !kiln_context_create(&one, &context, &b->error) &&
                !kiln_map_create(context, KILN_SHAPE_PANORAMA, 256, 1, &source, &b->error);
    unsigned seed = 1;
    for (size_t i = 0; done && i < 3 * kiln_map_texels(&source, 0); i++) {
        seed = seed * 1664525U + 1013904223U;
        source.level[0][i] = (float)(seed >> 8) * 0x1p-24F;
    }
    done = done && bake_once(b, context, &source, &def, &map, NULL);
    if (done)
        printf("  %s, %016llx\n", kiln_context_cpu(context), bench_hash(&map));
    kiln_map_free(&map);
    kiln_map_free(&source);
    kiln_context_destroy(context);
    return done;
}

// The case tables. In: the four masking functions. Out: time and largest error of a 128 x 128 table
// of the albedo E by kiln, and by importance sampling with 1024 samples that is vectorised and
// optimised as far as possible; also the time of 512 x 512 tables. All on one thread.
#include "bench.h"

#include <kiln/brdf.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

enum { SAMPLES = 1024, SIZE = 128, LANES = 32 };

static const char *const names[] = {"smith", "smith-uncorrelated", "schlick-k2", "schlick-text"};

// ------------------------------------------------------------------------------------- the sampler

// The samples of importance sampling at one roughness: the components x and z of the half vectors,
// which are all that the integrand uses, and 1 / z.
typedef struct samples {
    float azimuth[SAMPLES],
        // Hammersley points: the cosine of the azimuth, and the second coordinate
        xi[SAMPLES];
    float x[SAMPLES], z[SAMPLES], inverse[SAMPLES];
} samples;

typedef struct sampler {
    kiln_g g;
    float alpha2, k;
} sampler;

static void samples_start(samples *s)
{
    for (uint32_t i = 0; i < SAMPLES; i++) {
        uint32_t b = i;
        b = (b << 16) | (b >> 16);
        b = ((b & 0x55555555u) << 1) | ((b & 0xaaaaaaaau) >> 1);
        b = ((b & 0x33333333u) << 2) | ((b & 0xccccccccu) >> 2);
        b = ((b & 0x0f0f0f0fu) << 4) | ((b & 0xf0f0f0f0u) >> 4);
        b = ((b & 0x00ff00ffu) << 8) | ((b & 0xff00ff00u) >> 8);
        s->xi[i] = (float)((double)b / 4294967296.0);
        s->azimuth[i] = (float)cos(6.28318530717958648 * i / SAMPLES);
    }
}

static inline __attribute__((always_inline)) void samples_set(samples *s, float alpha2)
{
    for (int i = 0; i < SAMPLES; i++) {
        float rest = 1 - s->xi[i], d = rest + alpha2 * s->xi[i];
        s->z[i] = sqrtf(rest / d);
        s->x[i] = sqrtf(alpha2 * s->xi[i] / d) * s->azimuth[i];
        s->inverse[i] = 1 / s->z[i];
    }
}

// Estimates the albedo E at one cosine n.v as the mean of G (v.h) / ((n.v) (n.h)) over the samples.
// Factors that do not depend on the sample are taken out of the loop.
static inline __attribute__((always_inline)) float energy(const sampler *m, const samples *s,
                                                          float nov)
{
    float sine = sqrtf((1 - nov) * (1 + nov)), sum[LANES] = {0};
    float alpha2 = m->alpha2, slope = 1 - alpha2, root = sqrtf(alpha2 + slope * nov * nov),
          k = m->k;
    float front = m->g == KILN_G_SMITH                ? 2
                  : m->g == KILN_G_SMITH_UNCORRELATED ? 4 / (nov + root)
                                                      : 1 / (nov * (1 - k) + k);
    for (int i = 0; i < SAMPLES; i += LANES)
        for (int j = 0; j < LANES; j++) {
            float voh = sine * s->x[i + j] + nov * s->z[i + j], nol = 2 * voh * s->z[i + j] - nov;
            float bottom =
                m->g == KILN_G_SMITH ? nol * root + nov * sqrtf(alpha2 + slope * nol * nol)
                : m->g == KILN_G_SMITH_UNCORRELATED ? nol + sqrtf(alpha2 + slope * nol * nol)
                                                    : nol * (1 - k) + k;
            float term = nol * voh * s->inverse[i + j] / bottom;
            sum[j] += nol > 0 ? term : 0;
        }
    float total = 0;
    for (int j = 0; j < LANES; j++)
        total += sum[j];
    return total * front / SAMPLES;
}

static inline __attribute__((always_inline)) void fill(kiln_g g, samples *s, float *e)
{
    for (int y = 0; y < SIZE; y++) {
        float roughness = ((float)y + 0.5f) / SIZE, alpha = roughness * roughness;
        sampler m = {g, alpha * alpha,
                     g == KILN_G_SCHLICK_K2 ? alpha / 2 : (roughness + 1) * (roughness + 1) / 8};
        samples_set(s, m.alpha2);
        for (int x = 0; x < SIZE; x++)
            *e++ = energy(&m, s, ((float)x + 0.5f) / SIZE);
    }
}

// Calls fill() with a constant masking g, so that the compiler removes the tests of g from the
// loops.
static inline __attribute__((always_inline)) void fill_each(kiln_g g, samples *s, float *e)
{
    switch (g) {
    case KILN_G_SMITH:
        fill(KILN_G_SMITH, s, e);
        break;
    case KILN_G_SMITH_UNCORRELATED:
        fill(KILN_G_SMITH_UNCORRELATED, s, e);
        break;
    case KILN_G_SCHLICK_K2:
        fill(KILN_G_SCHLICK_K2, s, e);
        break;
    default:
        fill(KILN_G_SCHLICK_TEXT, s, e);
        break;
    }
}

static void fill_plain(kiln_g g, samples *s, float *e)
{
    fill_each(g, s, e);
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) static void fill_avx2(kiln_g g, samples *s, float *e)
{
    fill_each(g, s, e);
}

#if defined(__clang__)
#define WIDE "avx512f,avx512vl,avx512dq"
#else
#define WIDE "avx512f,avx512vl,avx512dq,prefer-vector-width=512"
#endif
__attribute__((target(WIDE))) static void fill_avx512(kiln_g g, samples *s, float *e)
{
    fill_each(g, s, e);
}
#endif

typedef void fill_function(kiln_g g, samples *s, float *e);

static fill_function *fill_for(kiln_context *context)
{
    fill_function *best = fill_plain;
#if defined(__x86_64__)
    if (!strcmp(kiln_context_cpu(context), "avx2"))
        best = fill_avx2;
    if (!strcmp(kiln_context_cpu(context), "avx512"))
        best = fill_avx512;
#else
    (void)context;
#endif
    return best;
}

// ---------------------------------------------------------------------------------------- the case

static double largest_error(kiln_g g, const float *e)
{
    kiln_model model = {.g = g};
    double worst = 0;
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            double exact = kiln_energy(&model, (y + 0.5) / SIZE, (x + 0.5) / SIZE);
            worst = fmax(worst, fabs((double)e[y * SIZE + x] - exact));
        }
    return worst;
}

// Sets seconds[] to the times of a table, each the fastest of `repeats`, because one computation is
// short.
static bool time_table(bench *b, kiln_context *context, const kiln_table_def *def, int repeats,
                       double *seconds, kiln_table *table)
{
    bool done = true;
    for (int i = 0; i < b->runs && done; i++) {
        seconds[i] = HUGE_VAL;
        for (int k = 0; k < repeats && done; k++) {
            kiln_table_free(table);
            double start = bench_cpu();
            done = !kiln_table_create(context, def, table, &b->error);
            seconds[i] = fmin(seconds[i], bench_cpu() - start);
        }
    }
    return done;
}

static bool beside_sampling(bench *b, kiln_context *context, kiln_g g, samples *s)
{
    static float sampled[SIZE * SIZE];
    double ours[BENCH_MAX_RUNS], theirs[BENCH_MAX_RUNS];
    kiln_table table = {0};
    kiln_table_def def = {.model.g = g};
    fill_function *run = fill_for(context);
    for (int i = 0; i < b->runs; i++) {
        theirs[i] = HUGE_VAL;
        for (int k = 0; k < 10; k++) {
            double start = bench_cpu();
            run(g, s, sampled);
            theirs[i] = fmin(theirs[i], bench_cpu() - start);
        }
    }
    bool done = time_table(b, context, &def, 30, ours, &table) && table.image.pixels;
    if (done) {
        char name[64];
        bench_times exact = bench_sum_up(ours, b->runs), sampling = bench_sum_up(theirs, b->runs);
        double error = largest_error(g, table.image.pixels), noise = largest_error(g, sampled);
        printf("  %s: by kiln %.3f ms, largest error %.1e; by 1024 samples %.3f ms, largest error "
               "%.1e\n",
               names[g], 1e3 * exact.median, error, 1e3 * sampling.median, noise);
        snprintf(name, sizeof name, "%s exact", names[g]);
        bench_row(b, name, "s", exact);
        snprintf(name, sizeof name, "%s sampled", names[g]);
        bench_row(b, name, "s", sampling);
        bench_bar(b, "time of sampling / time of kiln", sampling.median / exact.median, "", 8,
                  true);
        bench_bar(b, "error of kiln / error of sampling", error / noise, "", 1e-4, false);
    }
    kiln_table_free(&table);
    return done;
}

static bool large(bench *b, kiln_context *context, kiln_table_kind kind, const char *name,
                  double bar)
{
    double seconds[BENCH_MAX_RUNS];
    kiln_table table = {0};
    kiln_table_def def = {.kind = kind, .width = 512, .height = 512};
    bool done = time_table(b, context, &def, 3, seconds, &table);
    if (done) {
        bench_times times = bench_sum_up(seconds, b->runs);
        bench_row(b, name, "s", times);
        bench_bar(b, name, times.median, "s", bar, false);
    }
    kiln_table_free(&table);
    return done;
}

bool bench_tables(bench *b)
{
    static samples s;
    kiln_context *context = NULL;
    kiln_context_def one = {.thread_count = 1};
    bool done = !kiln_context_create(&one, &context, &b->error);
    samples_start(&s);
    for (int g = 0; g < 4 && done; g++)
        done = beside_sampling(b, context, (kiln_g)g, &s);
    done = done && large(b, context, KILN_TABLE_E, "E, 512 x 512", 0.15) &&
           large(b, context, KILN_TABLE_DFG, "A and B, 512 x 512", 1);
    kiln_context_destroy(context);
    return done;
}

// Yardsticks: what the machine does in the moment of a measurement, so that times from machines of
// different speed and load can be compared. Out: the time of a Fourier transform that is written
// here, and the rate of arithmetic of one core.
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LENGTH = BENCH_FFT_LENGTH, TRIES = 20 };

// Transforms `from`, interleaved complex numbers, by passes of radix 2 between two arrays
// (Stockham's order). `roots` holds exp(-2 pi i k / LENGTH) for k < LENGTH / 2. Returns the array
// with the result.
static double *transform(double *from, double *to, const double *roots)
{
    for (int stride = 1, half = LENGTH / 2; half >= 1; stride *= 2, half /= 2) {
        for (int p = 0; p < half; p++) {
            const double *root = roots + 2 * (size_t)stride * (size_t)p;
            double re = root[0], im = root[1];
            const double *a = from + 2 * (size_t)stride * (size_t)p;
            const double *b = a + 2 * (size_t)stride * (size_t)half;
            double *sum = to + 4 * (size_t)stride * (size_t)p, *turned = sum + 2 * (size_t)stride;
            for (int q = 0; q < 2 * stride; q += 2) {
                double x = a[q] - b[q], y = a[q + 1] - b[q + 1];
                sum[q] = a[q] + b[q];
                sum[q + 1] = a[q + 1] + b[q + 1];
                turned[q] = x * re - y * im;
                turned[q + 1] = x * im + y * re;
            }
        }
        double *other = from;
        from = to;
        to = other;
    }
    return from;
}

double bench_fft_seconds(void)
{
    double *data = malloc((size_t)5 * LENGTH * sizeof *data), best = HUGE_VAL;
    volatile double sink = 0;
    for (int i = 0; data && i < TRIES; i++) {
        double *work = data + (size_t)2 * LENGTH, *roots = work + (size_t)2 * LENGTH;
        for (size_t k = 0; k < LENGTH / 2; k++) {
            double angle = 2 * acos(-1) * (double)k / LENGTH;
            roots[2 * k] = cos(angle);
            roots[2 * k + 1] = -sin(angle);
        }
        for (int k = 0; k < 2 * LENGTH; k++)
            data[k] = k % 7 - 3;
        double start = bench_cpu();
        sink = *transform(data, work, roots);
        best = fmin(best, bench_cpu() - start);
    }
    (void)sink; // keeps the compiler from removing the transform
    free(data);
    return best;
}

// Multiplies and adds doubles in 16 independent chains of `LANES` lanes for `count` rounds, and
// returns a sum of the results. The file compiles this body for each width of vectors.
#define CHAINS 16
#define ARITHMETIC(name, lanes, attribute)                                                         \
    attribute static double name(int count)                                                        \
    {                                                                                              \
        typedef double vec __attribute__((vector_size(8 * (lanes))));                              \
        vec x[CHAINS], factor = (vec){0} + 0.999, term = (vec){0} + 0.001;                         \
        for (int k = 0; k < CHAINS; k++)                                                           \
            x[k] = (vec){0} + k;                                                                   \
        for (int i = 0; i < count; i++)                                                            \
            for (int k = 0; k < CHAINS; k++)                                                       \
                x[k] = x[k] * factor + term;                                                       \
        double sum = 0;                                                                            \
        for (int k = 0; k < CHAINS; k++)                                                           \
            for (int j = 0; j < (lanes); j++)                                                      \
                sum += x[k][j];                                                                    \
        return sum;                                                                                \
    }

ARITHMETIC(multiply_2, 2, )
#if defined(__x86_64__)
ARITHMETIC(multiply_4, 4, __attribute__((target("avx2"))))
ARITHMETIC(multiply_8, 8, __attribute__((target("avx512f"))))
#endif

double bench_peak_flops(kiln_context *context)
{
    enum { ROUNDS = 100000 };
    double (*arithmetic)(int) = multiply_2, best = HUGE_VAL;
    int lanes = 2;
#if defined(__x86_64__)
    const char *cpu = kiln_context_cpu(context);
    lanes = !strcmp(cpu, "avx512") ? 8 : !strcmp(cpu, "avx2") ? 4 : 2;
    arithmetic = lanes == 8 ? multiply_8 : lanes == 4 ? multiply_4 : multiply_2;
#else
    (void)context;
#endif
    volatile double sink = 0;
    for (int i = 0; i < TRIES; i++) {
        double start = bench_cpu();
        sink = arithmetic(ROUNDS);
        best = fmin(best, bench_cpu() - start);
    }
    (void)sink;
    return 2.0 * lanes * CHAINS * ROUNDS / best;
}

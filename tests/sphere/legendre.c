// Associated Legendre functions are orthonormal, the functions that each latitude ring leaves out
// hold nothing, and the kernels' sums over them are those of the plain recurrence.
#include "sphere/legendre.h"
#include "math/math.h"
#include "sphere/grid.h"
#include "sphere/kernels.h"

#include "kit/context.h"

enum { MOST = 1600 }; // the highest degree that is tested

// Writes q_l (legendre.h) for l = m .. degree at cos theta = x, where sin^m theta is `start`.
static void plain_functions(int degree, int m, double x, double start, const double *f, double *q)
{
    q[0] = start;
    for (int i = 1; i <= degree - m; i++)
        q[i] = 2 * x * q[i - 1] - (i > 1 ? f[i] * q[i - 2] : 0);
}

// Integrals of products over the sphere: orthonormal means 1 for a function with itself, 0 for two
// of the same order.
static void legendre_functions_are_orthonormal(void **state)
{
    (void)state;
    enum { DEGREE = 60, NODES = 64 };
    double nodes[NODES], weights[NODES], start = 0;
    ki_gauss_legendre(NODES, nodes, weights);
    for (int m = 0; m <= DEGREE; m++) {
        static double p[NODES][DEGREE + 1];
        double f[DEGREE + 1 + KI_LEGENDRE_PADDING], scale[DEGREE + 1 + KI_LEGENDRE_PADDING];
        ki_legendre_order(DEGREE, m, &start, f, scale);
        for (int i = 0; i < NODES; i++)
            plain_functions(DEGREE, m, nodes[i], pow(1 - nodes[i] * nodes[i], m / 2.0), f, p[i]);
        for (int a = 0; a <= DEGREE - m; a++)
            for (int b = 0; b <= DEGREE - m; b++) {
                double sum = 0;
                for (int i = 0; i < NODES; i++)
                    sum += weights[i] * p[i][a] * scale[a] * p[i][b] * scale[b];
                CHECK_NEAR(2 * KI_PI * sum, a == b ? 1 : 0, 1e-12);
            }
    }
}

// Functions that are left out must not matter: the largest |P_lm| among them stays below 1e-12 of
// what it reaches elsewhere (0.4 sqrt(degree)). Whole orders are left out on the rings of vectors
// near the poles, and on the others the first functions of an order.
static void skipped_functions_hold_nothing(void **state)
{
    (void)state;
    static const int degrees[] = {9, 64, 364, MOST};
    static const ki_ring_excess excesses[] = {KI_FEW_RINGS, KI_MANY_RINGS};
    static double f[MOST + 1 + KI_LEGENDRE_PADDING], scale[MOST + 1 + KI_LEGENDRE_PADDING],
        q[MOST + 1];
    for (int n = 0; n < 8; n++) {
        int degree = degrees[n / 2];
        size_t skipped = 0;
        ki_rings rings;
        assert_true(ki_rings_create_grid(context, degree, excesses[n % 2], &rings));
        size_t vectors = (size_t)rings.vector_count;
        double most = 0, start = 0;
        for (int m = 0; m <= degree; m++) {
            ki_legendre_order(degree, m, &start, f, scale);
            if (m % (1 + degree / 60))
                continue;
            for (size_t g = 0; g < vectors; g++) {
                int skip = rings.skip[(size_t)m * vectors + g];
                int count = (int)g < rings.first[m] ? degree - m + 1 : 2 * skip;
                size_t k = 8 * g + 7; // the ring of the vector that is nearest the equator
                assert_int_equal(skip % 2, 0);
                assert_true(g == 0 || skip <= rings.skip[(size_t)m * vectors + g - 1]);
                plain_functions(degree, m, rings.twice_cos[k] / 2,
                                rings.start[(size_t)m * 8 * vectors + k], f, q);
                for (int i = 0; i < count; i++)
                    most = fmax(most, fabs(q[i] * scale[i]));
                skipped += (size_t)count;
            }
        }
        CHECK_BELOW(most, 1e-12);
        assert_true(degree < 64 || skipped > 0);
        ki_rings_destroy(&rings);
    }
}

// At a pole only order 0 is not 0, and none of its functions may be left out.
static void rings_at_a_pole_keep_order_0(void **state)
{
    (void)state;
    static const double theta[] = {0, 1e-9};
    for (int pairs = 1; pairs <= 2; pairs++) {
        ki_rings rings;
        assert_true(ki_rings_create(context, theta, pairs, 100, &rings));
        assert_int_equal(rings.vector_count, 2);
        assert_int_equal(rings.first[0], 0);
        assert_int_equal(rings.first[100], 2);
        for (int m = 0; m <= 12; m++)
            for (int g = 0; g < 2; g++)
                assert_int_equal(rings.skip[2 * m + g], 0);
        ki_rings_destroy(&rings);
    }
}

// Random numbers from -1 to 1.
static double *noise(size_t count)
{
    double *values = malloc(count * sizeof *values);
    uint32_t seed = 1;
    for (size_t i = 0; i < count; i++) {
        seed = seed * 1664525 + 1013904223;
        values[i] = (double)seed / 2147483648.0 - 1;
    }
    return values;
}

// Sums of all P_lm with random coefficients on all rings, and sums over all rings of P_lm times random
// data, against the plain recurrence, in units of their root mean square. Rounding errors of the
// recurrences grow like the square of the degree near the poles.
static void sums_are_those_of_the_plain_recurrence(void **state)
{
    (void)state;
    static const int degrees[] = {8, 9, 10, 11, 64, 412, MOST};
    static double f[MOST + 1 + KI_LEGENDRE_PADDING], scale[MOST + 1 + KI_LEGENDRE_PADDING],
        q[MOST + 1];
    const ki_kernels *kernels = ki_sphere_kernels(context);
    for (size_t n = 0; n < sizeof degrees / sizeof *degrees; n++) {
        int degree = degrees[n];
        double bound = 4e-16 * (degree + 1) * (degree + 1);
        ki_legendre legendre;
        ki_rings rings;
        assert_true(ki_legendre_create(context, degree, &legendre));
        assert_true(ki_rings_create_grid(context, degree, KI_MANY_RINGS, &rings));
        size_t vectors = (size_t)rings.vector_count, length = (size_t)degree + 2;
        double *b = noise(6 * length), *data = noise(96 * vectors), *scratch = noise(24 * vectors);
        double *joined = malloc(6 * length * sizeof *joined), *out = malloc(192 * sizeof *out);
        double *ready = malloc(96 * vectors * sizeof *ready), start = 0;
        double *sums = malloc(12 * length * sizeof *sums),
               *want = malloc(6 * length * sizeof *want);
        for (int m = 0; m <= degree; m++) {
            ki_legendre_order(degree, m, &start, f, scale);
            if (m > 3 && m % (1 + degree / 7) && m < degree - 3)
                continue;
            int count = degree - m + 1;
            size_t row = ki_legendre_row(&legendre, m), at = (size_t)m * vectors;
            for (int i = 0; i < count + count % 2; i++)
                for (int c = 0; c < 6; c++)
                    joined[6 * i + c] = i < count ? b[6 * i + c] * scale[i] : 0;
            ki_legendre_join_odd(degree, m, joined);
            for (size_t g = 0; g < vectors; g++)
                for (size_t c = 0; c < 12; c++)
                    for (size_t j = 0; j < 8; j++)
                        ready[96 * g + 8 * c + j] =
                            data[96 * g + 8 * c + j] * (c < 6 ? 1 : rings.twice_cos[8 * g + j]);
            double worst = 0, squares = 0;
            memset(want, 0, 6 * length * sizeof *want);
            for (size_t g = 0; g < vectors; g++) {
                if (g % 2 == 0)
                    kernels->synthesize(legendre.steps + row, count, rings.twice_cos + 8 * g,
                                        rings.start + 8 * (at + g), joined, rings.skip[at + g + 1],
                                        out, out + 96);
                for (size_t j = 0; j < 8; j++) {
                    double direct[12] = {0};
                    plain_functions(degree, m, rings.twice_cos[8 * g + j] / 2,
                                    rings.start[8 * (at + g) + j], f, q);
                    for (int i = 0; i < count; i++)
                        for (int c = 0; c < 6; c++) {
                            int odd = i % 2 * 6;
                            direct[odd + c] += q[i] * scale[i] * b[6 * i + c];
                            want[6 * i + c] +=
                                q[i] * scale[i] * data[96 * g + 8 * (size_t)(odd + c) + j];
                        }
                    for (size_t c = 0; c < 12 && g + 1 > (size_t)rings.first[m]; c++) {
                        worst = fmax(worst, fabs(out[96 * (g % 2) + 8 * c + j] - direct[c]));
                        squares += direct[c] * direct[c] / (double)(96 * vectors);
                    }
                }
            }
            CHECK_BELOW(worst, bound * sqrt(squares));
            kernels->analyze(legendre.steps + row, count, rings.twice_cos, rings.start + 8 * at,
                             ready, rings.skip + at, rings.first[m], rings.vector_count, scratch,
                             sums);
            ki_legendre_part_odd(degree, m, sums);
            worst = squares = 0;
            for (int i = 0; i < 6 * count; i++) {
                worst = fmax(worst, fabs(sums[i] * scale[i / 6] - want[i]));
                squares += want[i] * want[i] / (6 * count);
            }
            CHECK_BELOW(worst, bound * sqrt(squares));
        }
        free(b), free(data), free(scratch), free(joined), free(out), free(ready), free(sums);
        free(want);
        ki_rings_destroy(&rings);
        ki_legendre_destroy(&legendre);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(legendre_functions_are_orthonormal),
        cmocka_unit_test(skipped_functions_hold_nothing),
        cmocka_unit_test(rings_at_a_pole_keep_order_0),
        cmocka_unit_test(sums_are_those_of_the_plain_recurrence),
    };
    return cmocka_run_group_tests_name("Legendre functions", tests, set_up, tear_down);
}

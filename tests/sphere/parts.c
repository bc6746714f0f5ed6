// The engine's parts, each against its definition.

#include "image/image.h"
#include "math/math.h"
#include "sphere/fft.h"
#include "sphere/grid.h"
#include "sphere/legendre.h"
#include "sphere/lobe.h"
#include "sphere/sh.h"
#include "sphere/zonal.h"

#include "kit/context.h"

static void fft_is_the_transform(void **state)
{
    (void)state;
    static const int lengths[] = {1,  2,  3,  4,  5,   6,   7,   8,   9,   10,  11,  12,  13,
                                  15, 16, 18, 20, 24,  30,  32,  35,  48,  49,  60,  64,  77,
                                  96, 97, 98, 99, 100, 120, 128, 144, 194, 250, 256, 1000};
    const ki_kernels *kernels = ki_sphere_kernels(context);
    for (size_t n = 0; n < sizeof lengths / sizeof *lengths; n++) {
        int length = lengths[n];
        size_t count = 16 * (size_t)length;
        ki_fft fft;
        assert_true(ki_fft_create(context, length, &fft));
        double *data = calloc(2 * count, sizeof *data), *copy = calloc(count, sizeof *data);
        uint64_t seed = (uint64_t)length;
        for (size_t i = 0; i < count; i++)
            copy[i] = data[i] = random_between(&seed, -1, 1);
        const double *out = kernels->fft(&fft, data, data + count);
        for (int k = 0; k < length; k += 1 + length / 37)
            for (int lane = 0; lane < 8; lane++) {
                double re = 0, im = 0;
                for (int j = 0; j < length; j++) {
                    double angle = -2 * KI_PI * (double)((int64_t)j * k % length) / length;
                    double c = cos(angle), s = sin(angle);
                    double xr = copy[16 * j + lane], xi = copy[16 * j + 8 + lane];
                    re += xr * c - xi * s;
                    im += xr * s + xi * c;
                }
                CHECK_NEAR(out[16 * k + lane], re, 2e-15 * length);
                CHECK_NEAR(out[16 * k + 8 + lane], im, 2e-15 * length);
            }
        free(data);
        free(copy);
        ki_fft_destroy(&fft);
    }
}

// Integrals of products over the sphere: orthonormal means 1 for a function with itself, 0 for two
// of the same order.
static void legendre_functions_are_orthonormal(void **state)
{
    (void)state;
    enum { DEGREE = 60, NODES = 64 };
    ki_legendre legendre;
    assert_true(ki_legendre_create(context, DEGREE, &legendre));
    double nodes[NODES], weights[NODES];
    ki_gauss_legendre(NODES, nodes, weights);
    for (int m = 0; m <= DEGREE; m += 7) {
        static double p[DEGREE + 1][NODES];
        const double *f = legendre.f + ki_legendre_row(&legendre, m);
        const double *scale = legendre.scale + ki_legendre_row(&legendre, m);
        for (int i = 0; i < NODES; i++) {
            double q = pow(1 - nodes[i] * nodes[i], m / 2.0), before = 0;
            for (int l = m; l <= DEGREE; l++) {
                p[l][i] = q * scale[l - m];
                double next = 2 * nodes[i] * q - f[l - m + 1] * before;
                before = q;
                q = next;
            }
        }
        for (int a = m; a <= DEGREE; a++)
            for (int b = m; b <= DEGREE; b++) {
                double sum = 0;
                for (int i = 0; i < NODES; i++)
                    sum += weights[i] * p[a][i] * p[b][i];
                CHECK_NEAR(2 * KI_PI * sum, a == b ? 1 : 0, 1e-12);
            }
    }
    ki_legendre_destroy(&legendre);
}

// Skipped orders must not matter: the largest |P_lm| on the rings left out stays below 1e-12 of what
// it reaches elsewhere (about sqrt(degree)).
static void skipped_rings_hold_nothing(void **state)
{
    (void)state;
    static const int degrees[] = {9, 64, 364, 1600};
    for (int n = 0; n < 4; n++) {
        int degree = degrees[n];
        ki_rings rings;
        ki_legendre legendre;
        assert_true(ki_rings_create_grid(context, degree, &rings));
        assert_true(ki_legendre_create(context, degree, &legendre));
        double most = 0;
        for (int m = 0; m <= degree; m += 1 + degree / 60) {
            const double *f = legendre.f + ki_legendre_row(&legendre, m);
            const double *scale = legendre.scale + ki_legendre_row(&legendre, m);
            if (rings.first[m] == 0)
                continue;
            int k = 8 * rings.first[m] - 1; // the ring left out that is nearest the equator
            double x = rings.twice_cos[k];
            double q = rings.start[(size_t)m * 8 * (size_t)rings.vector_count + (size_t)k];
            double before = 0;
            for (int l = m; l <= degree; l++) {
                most = fmax(most, fabs(q * scale[l - m]));
                double next = x * q - f[l - m + 1] * before;
                before = q;
                q = next;
            }
        }
        CHECK_BELOW(most, 1e-12);
        ki_rings_destroy(&rings);
        ki_legendre_destroy(&legendre);
    }
}

static void taps_keep_constants_and_follow_waves(void **state)
{
    (void)state;
    enum { DEGREE = 200 };
    static double density[DEGREE + 1], taps[KI_TAPS * (KI_TAP_STEPS + 1)];
    ki_model_density(DEGREE, density);
    double step = KI_PI / 308, worst_low = 0, worst_middle = 0;
    ki_taps_design(step, density, DEGREE, taps);
    for (int n = 0; n <= 1000; n++) {
        double w[KI_TAPS], sum = 0, fraction = n / 1000.0;
        ki_taps_at(taps, fraction, w);
        for (int i = 0; i < KI_TAPS; i++)
            sum += w[i];
        CHECK_NEAR(sum, 1, 1e-12);
        for (int l = 1; l <= 100; l++) {
            double re = -cos(l * fraction * step), im = -sin(l * fraction * step);
            for (int i = 0; i < KI_TAPS; i++) {
                re += w[i] * cos(l * (i - 3) * step);
                im += w[i] * sin(l * (i - 3) * step);
            }
            double *worst = l <= 20 ? &worst_low : &worst_middle;
            *worst = fmax(*worst, sqrt(re * re + im * im));
        }
    }
    CHECK_BELOW(worst_low, 3e-6);    // up to a tenth of the degree
    CHECK_BELOW(worst_middle, 5e-4); // half of it, where GGX has fallen to e^-5
}

// Closed forms: Lambert's A_l / pi (Ramamoorthi and Hanrahan 2001, eq. 8), and alpha = 1.
static void lambert_has_its_closed_form(void **state)
{
    (void)state;
    static const double wanted[] = {1, 2.0 / 3, 0.25, 0, -1.0 / 24, 0, 1.0 / 64};
    kiln_lobe lobes[] = {kiln_lobe_lambert(), kiln_lobe_ggx(1), kiln_lobe_phong(1)};
    for (int i = 0; i < 3; i++) {
        ki_zonal zonal = {.lobe = lobes[i]};
        ki_zonal_spectrum spectrum;
        CHECK_OK(ki_zonal_analyze(context, &zonal, 0, 200, &spectrum, &error));
        CHECK_NEAR(spectrum.integral, KI_PI, 1e-13);
        for (int l = 0; l <= 6; l++)
            CHECK_NEAR(spectrum.k[l], wanted[l], 1e-14);
        ki_zonal_free(&spectrum);
    }
}

// A lobe's value is the sum of its series.
static void zonal_series_gives_the_lobe_back(void **state)
{
    (void)state;
    static const double alphas[] = {0.01, 0.0156, 0.04, 0.1};
    for (int i = 0; i < 4; i++) {
        ki_zonal zonal = {.lobe = kiln_lobe_ggx(alphas[i])};
        ki_zonal_spectrum spectrum;
        CHECK_OK(ki_zonal_analyze(context, &zonal, 1e-7, 1600, &spectrum, &error));
        CHECK_BELOW(spectrum.rest, 1e-5);
        for (int step = 0; step < 77; step++) {
            double theta = 0.013 * step, x = cos(theta), p0 = 1, p1 = x, sum = 1 / (4 * KI_PI);
            for (int l = 1; l <= spectrum.degree; l++) {
                sum += (2 * l + 1) / (4 * KI_PI) * spectrum.k[l] * p1;
                double p2 = ((2 * l + 1) * x * p1 - l * p0) / (l + 1);
                p0 = p1;
                p1 = p2;
            }
            double half = sin(theta / 2), value = ki_zonal_weight(&zonal, 2 * half * half);
            CHECK_NEAR(sum * spectrum.integral, value, 1e-4 * sqrt(alphas[i]));
        }
        ki_zonal_free(&spectrum);
    }
}

static void zonal_tail_is_what_it_says(void **state)
{
    (void)state;
    ki_zonal zonal = {.lobe = kiln_lobe_ggx(0.05)};
    ki_zonal_spectrum rough, fine;
    CHECK_OK(ki_zonal_analyze(context, &zonal, 1e-3, 1600, &rough, &error));
    CHECK_OK(ki_zonal_analyze(context, &zonal, 1e-7, 1600, &fine, &error));
    double beyond = 0, all = 0;
    for (int l = 0; l <= fine.degree; l++) {
        double part = (2 * l + 1) * fine.k[l] * fine.k[l];
        all += part;
        beyond += l > rough.degree ? part : 0;
    }
    CHECK_NEAR(sqrt(beyond / all), rough.rest, 1e-6);
    CHECK_BELOW(rough.rest, 1e-3);
    ki_zonal_free(&rough);
    ki_zonal_free(&fine);
}

static void sh_basis_is_orthonormal(void **state)
{
    (void)state;
    double nodes[12], weights[12];
    ki_gauss_legendre(12, nodes, weights);
    static double gram[25][25];
    for (int j = 0; j < 12; j++)
        for (int i = 0; i < 24; i++) {
            double s = sqrt(1 - nodes[j] * nodes[j]), y[25], phi = 2 * KI_PI * i / 24;
            ki_sh_basis((double[3]){s * cos(phi), s * sin(phi), nodes[j]}, y);
            for (int a = 0; a < 25; a++)
                for (int b = 0; b < 25; b++)
                    gram[a][b] += y[a] * y[b] * weights[j] * 2 * KI_PI / 24;
        }
    for (int a = 0; a < 25; a++)
        for (int b = 0; b < 25; b++)
            CHECK_NEAR(gram[a][b], a == b ? 1 : 0, 1e-13);
}

static void lobes_out_of_range_are_refused(void **state)
{
    (void)state;
    kiln_lobe bad[] = {kiln_lobe_ggx(-0.1),  kiln_lobe_ggx(1.5),   kiln_lobe_ggx((double)NAN),
                       kiln_lobe_charlie(0), kiln_lobe_phong(0.5), kiln_lobe_custom(NULL, NULL, 1)};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(ki_lobe_check(&bad[i], &error), KILN_ERROR_ARGUMENT);
        assert_true(strlen(error.message) > 10);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fft_is_the_transform),
        cmocka_unit_test(legendre_functions_are_orthonormal),
        cmocka_unit_test(skipped_rings_hold_nothing),
        cmocka_unit_test(taps_keep_constants_and_follow_waves),
        cmocka_unit_test(lambert_has_its_closed_form),
        cmocka_unit_test(zonal_series_gives_the_lobe_back),
        cmocka_unit_test(zonal_tail_is_what_it_says),
        cmocka_unit_test(sh_basis_is_orthonormal),
        cmocka_unit_test(lobes_out_of_range_are_refused),
    };
    return cmocka_run_group_tests_name("sphere parts", tests, set_up, tear_down);
}

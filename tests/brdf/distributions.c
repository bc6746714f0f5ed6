// Distributions D and maskings G: D integrates to 1, G is a symmetric share with its published
// values, and the specular lobe is reciprocal.
#include "kit/kit.h"
#include "kit/quadrature.h"

#include <float.h>
#include <kiln/brdf.h>

enum { DISTRIBUTIONS = KILN_D_BECKMANN + 1 };

static const kiln_g all_g[] = {KILN_G_SMITH, KILN_G_SMITH_UNCORRELATED, KILN_G_SCHLICK_K2,
                               KILN_G_SCHLICK_TEXT};

typedef struct lobe {
    kiln_d d;
    double roughness;
} lobe;

// The integrand of int D (n.h) dh over x in [0, 1], after tan^2 theta = T = alpha^2 x / (1 - x),
// with (n.h) dh = dphi dT / (2 (1 + T)^2).
static double d_over_x(void *data, double x)
{
    const lobe *l = data;
    double a2 = pow(l->roughness, 4), t = a2 * x / (1 - x);
    return pi * kiln_brdf_d(l->d, l->roughness, 1 / sqrt(1 + t)) / ((1 + t) * (1 + t)) * a2 /
           ((1 - x) * (1 - x));
}

static void distributions_integrate_to_one(void **state)
{
    (void)state;
    for (int i = 0; i < DISTRIBUTIONS; i++)
        for (int r = 2; r <= 100; r++) {
            lobe l = {i ? KILN_D_BECKMANN : KILN_D_GGX, r / 100.0};
            // D's argument noh is rounded: 1 - noh has an error of 1e-16, and the lobe's width in 1
            // - noh is alpha^2 / 2.
            CHECK_NEAR(integrate(d_over_x, &l, 0, 1, 8), 1, 1e-12 + 1e-15 / pow(l.roughness, 4));
        }
}

static void mirrors_are_the_limit(void **state)
{
    (void)state;
    for (int i = 0; i < DISTRIBUTIONS; i++) {
        kiln_d d = i ? KILN_D_BECKMANN : KILN_D_GGX;
        assert_true(kiln_brdf_d(d, 0, 1) == HUGE_VAL && kiln_brdf_d(d, 0, 0.999999) == 0);
        CHECK_NEAR(kiln_brdf_d(d, 1e-30, 1) * pi * 1e-120, 1, 1e-12);
        CHECK_NEAR(kiln_brdf_d(d, 0.3, 1) * pi * 0.0081, 1, 1e-14);
    }
    CHECK_NEAR(kiln_brdf_d(KILN_D_GGX, 1e-3, 0.5), 1e-12 / pi / 0.5625, 1e-22);
}

static void shadowing_is_a_symmetric_share(void **state)
{
    (void)state;
    const double rounding = 8 * DBL_EPSILON;
    for (int d = 0; d < DISTRIBUTIONS; d++)
        for (int g = 0; g < 4; g++) {
            kiln_model m = {d ? KILN_D_BECKMANN : KILN_D_GGX, all_g[g]};
            for (int r = 0; r <= 20; r++)
                for (int i = 0; i <= 20; i++)
                    for (int j = 0; j <= i; j++) {
                        double rough = r / 20.0, v = i / 20.0, l = j / 20.0;
                        double here = kiln_brdf_g(&m, rough, v, l);
                        assert_true(here >= 0 && here <= 1);
                        assert_true(here == kiln_brdf_g(&m, rough, l, v));
                        // G falls with roughness and towards grazing angles.
                        assert_true(kiln_brdf_g(&m, rough + 0.05, v, l) <= here + rounding);
                        assert_true(kiln_brdf_g(&m, rough, v - 0.05, l) <= here + rounding);
                        // Height-correlated masking is weaker than uncorrelated masking.
                        kiln_model u = {m.d, KILN_G_SMITH_UNCORRELATED};
                        if (m.g == KILN_G_SMITH)
                            assert_true(kiln_brdf_g(&u, rough, v, l) <= here + rounding);
                    }
            double mirror = m.g == KILN_G_SCHLICK_TEXT ? 0 : 1;
            CHECK_NEAR(kiln_brdf_g(&m, 0, 0, 0.5), mirror, 0);
            CHECK_NEAR(kiln_brdf_g(&m, 0.5, 0, 0.5), 0, 0);
            CHECK_NEAR(kiln_brdf_g(&m, 0.5, 1, 1), 1, 1e-15);
        }
    // Schlick's G1 = nox / (nox (1 - k) + k) with the two k.
    kiln_model k2 = {.g = KILN_G_SCHLICK_K2}, text = {.g = KILN_G_SCHLICK_TEXT};
    CHECK_NEAR(kiln_brdf_g(&k2, 0.6, 0.25, 1), 0.25 / (0.25 * 0.82 + 0.18), 1e-15);
    CHECK_NEAR(kiln_brdf_g(&text, 0.6, 0.25, 1), 0.25 / (0.25 * 0.68 + 0.32), 1e-15);
    // Smith's G for GGX at 60 degrees and alpha = 1, where Lambda = (sqrt(1 + 3) - 1) / 2.
    kiln_model hc = {0}, un = {.g = KILN_G_SMITH_UNCORRELATED};
    CHECK_NEAR(kiln_brdf_g(&hc, 1, 0.5, 0.5), 0.5, 1e-15);
    CHECK_NEAR(kiln_brdf_g(&un, 1, 0.5, 0.5), 4 / 9.0, 1e-15);
}

static void specular_is_reciprocal_and_finite(void **state)
{
    (void)state;
    uint64_t random = 12345;
    for (int d = 0; d < DISTRIBUTIONS; d++)
        for (int g = 0; g < 4; g++) {
            kiln_model m = {d ? KILN_D_BECKMANN : KILN_D_GGX, all_g[g]};
            for (int i = 0; i < 500; i++) {
                double r = random_number(&random), v = random_number(&random),
                       l = random_number(&random);
                double h = random_number(&random), f = kiln_brdf_specular(&m, r, v, l, h);
                assert_true(f == kiln_brdf_specular(&m, r, l, v, h));
                double d_g = kiln_brdf_d(m.d, r, h) * kiln_brdf_g(&m, r, v, l);
                // Products below DBL_MIN are rounded to multiples of the smallest double.
                CHECK_NEAR(f * (4 * v * l), d_g, 1e-14 * d_g + 4 * DBL_TRUE_MIN);
            }
            // The specular lobe is continuous at n.v = 0.
            double at = kiln_brdf_specular(&m, 0.5, 0, 0.7, 0.9);
            assert_true(isfinite(at) && at > 0);
            CHECK_NEAR(kiln_brdf_specular(&m, 0.5, 1e-9, 0.7, 0.9) / at, 1, 1e-7);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distributions_integrate_to_one),
        cmocka_unit_test(mirrors_are_the_limit),
        cmocka_unit_test(shadowing_is_a_symmetric_share),
        cmocka_unit_test(specular_is_reciprocal_and_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

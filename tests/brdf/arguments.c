// Functions of the reflection models take every number, also numbers out of range and not-a-number.
#include "kit/kit.h"

#include <float.h>
#include <kiln/brdf.h>

enum { DISTRIBUTIONS = KILN_D_BECKMANN + 1 };

static const kiln_g all_g[] = {KILN_G_SMITH, KILN_G_SMITH_UNCORRELATED, KILN_G_SCHLICK_K2,
                               KILN_G_SCHLICK_TEXT};

static const double wild[] = {-HUGE_VAL, -1, -0.0, 5e-324, 1e-200,   1e-75,
                              0.5,       1,  2,    1e300,  HUGE_VAL, (double)NAN};

enum { WILD = sizeof wild / sizeof *wild };

static void nothing_is_not_a_number(void **state)
{
    (void)state;
    for (int a = 0; a < WILD; a++)
        for (int b = 0; b < WILD; b++)
            for (int c = 0; c < WILD; c++) {
                double x = wild[a], y = wild[b], z = wild[c], n, k;
                for (int m = 0; m < 4 * DISTRIBUTIONS; m++) {
                    kiln_model model = {m / 4 ? KILN_D_BECKMANN : KILN_D_GGX, all_g[m % 4]};
                    double g = kiln_brdf_g(&model, x, y, z);
                    assert_true(g >= 0 && g <= 1);
                    assert_true(kiln_brdf_d(model.d, x, y) >= 0);
                    for (int h = 0; h < WILD; h++)
                        assert_true(kiln_brdf_specular(&model, x, y, z, wild[h]) >= 0);
                }
                double f = kiln_fresnel_conductor(x, y, z);
                assert_true(f >= 0 && f <= 1);
                f = kiln_fresnel_dielectric(x, y);
                assert_true(f >= 0 && f <= 1);
                kiln_gulbrandsen(x, y, &n, &k);
                assert_true(isfinite(n) && isfinite(k));
                assert_true(kiln_kulla_conty(x, y, z) >= 0);
                f = kiln_kulla_conty_fresnel(KILN_F_ADD_ASSIGNMENT, x, y);
                assert_true(f >= 0 && f <= 1);
                assert_true(isfinite(kiln_turquin(x, y)));
                kiln_fdez_aguera(x, y, z, &n, &k);
                assert_true(n >= 0 && k >= 0 && n + k <= 1 + DBL_EPSILON);
            }
}

static void integrals_take_any_number(void **state)
{
    (void)state;
    for (int a = 0; a < WILD; a++)
        for (int b = 0; b < WILD; b++) {
            double x = wild[a], y = wild[b], ab[2];
            for (int m = 0; m < 4 * DISTRIBUTIONS; m++) {
                kiln_model model = {m / 4 ? KILN_D_BECKMANN : KILN_D_GGX, all_g[m % 4]};
                double e = kiln_energy(&model, x, y);
                assert_true(e >= 0 && e <= 1 + 1e-8);
                kiln_energy_split(&model, x, y, ab);
                assert_true(ab[0] >= 0 && ab[1] >= 0);
                CHECK_NEAR(ab[0] + ab[1], e, 1e-15);
            }
            for (int k = 0; k < 2; k++)
                assert_true(kiln_sheen_albedo((kiln_sheen)k, x, y) >= 0);
            for (int c = 0; c < WILD; c++) {
                kiln_glass(&(kiln_model){0}, x, y, wild[c], ab);
                assert_true(ab[0] >= 0 && ab[1] >= 0 && ab[0] + ab[1] <= 1 + 2e-6);
            }
            double f = kiln_fresnel_conductor_average(x, y);
            assert_true(f >= 0 && f <= 1);
        }
    double rt[2], limit[2];
    kiln_glass_average(&(kiln_model){0}, 0.5, -7, rt);
    kiln_glass_average(&(kiln_model){0}, 0.5, 1.0 / 16, limit);
    assert_memory_equal(rt, limit, sizeof rt);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_not_a_number),
        cmocka_unit_test(integrals_take_any_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

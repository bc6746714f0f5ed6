// Compensations of lost energy in the white furnace, where a surface that absorbs nothing is
// invisible.
#include "kit/kit.h"
#include "kit/quadrature.h"

#include <kiln/brdf.h>

// An arbitrary albedo E(mu) that is not constant.
static double albedo(double mu)
{
    return 0.4 + 0.5 * mu - 0.3 * mu * mu * mu;
}

static double albedo_average(void *data, double mu)
{
    (void)data;
    return 2 * mu * albedo(mu);
}

typedef struct pair {
    double mu_o, e_average;
} pair;

static double added_light(void *data, double mu)
{
    const pair *p = data;
    return 2 * pi * mu * kiln_kulla_conty(albedo(p->mu_o), albedo(mu), p->e_average);
}

// The cosine integral of Kulla and Conty's lobe over the light is 1 - E(mu_o), for any albedo E.
// mu_o is the cosine of the view.
static void kulla_conty_closes_the_furnace(void **state)
{
    (void)state;
    pair p = {0, integrate(albedo_average, NULL, 0, 1, 1)};
    for (int i = 0; i <= 20; i++) {
        p.mu_o = i / 20.0;
        CHECK_NEAR(integrate(added_light, &p, 0, 1, 1), 1 - albedo(p.mu_o), 1e-14);
        for (int j = 0; j <= 20; j++)
            assert_true(kiln_kulla_conty(albedo(i / 20.0), albedo(j / 20.0), p.e_average) ==
                        kiln_kulla_conty(albedo(j / 20.0), albedo(i / 20.0), p.e_average));
    }
    CHECK_NEAR(kiln_kulla_conty(1, 1, 1), 0, 0);
    CHECK_NEAR(kiln_kulla_conty(1 - 1e-12, 1 - 1e-12, 1 - 1e-12), 1e-12 / pi, 1e-16);
}

// The factors that colour Kulla and Conty's lobe are sums of the light of each bounce.
static void f_add_sums_the_bounces(void **state)
{
    (void)state;
    for (int i = 0; i <= 10; i++)
        for (int j = 1; j <= 10; j++) {
            double f = i / 10.0, e = j / 10.0, first = f * e, rest = 0, light = f * (1 - e);
            for (int bounce = 2; bounce < 1000; bounce++) {
                rest += light * f * e;
                light *= f * (1 - e);
            }
            double second = kiln_kulla_conty_fresnel(KILN_F_ADD_SECOND, f, e);
            double taught = kiln_kulla_conty_fresnel(KILN_F_ADD_ASSIGNMENT, f, e);
            CHECK_NEAR(second * (1 - e), rest, 1e-14);
            CHECK_NEAR(taught, first + rest, 1e-14);
            if (f == 1)
                assert_true(second == 1 && taught == 1);
        }
    CHECK_NEAR(kiln_kulla_conty_fresnel(KILN_F_ADD_SECOND, 1, 0), 1, 0);
}

static void furnaces_close_at_f0_of_one(void **state)
{
    (void)state;
    for (int i = 1; i <= 20; i++) {
        double e = i / 20.0, b = e * e / 7, single, multiple;
        CHECK_NEAR(e * kiln_turquin(1, e), 1, 1e-15);
        CHECK_NEAR(kiln_turquin(0, e), 1, 0);
        kiln_fdez_aguera(1, e - b, b, &single, &multiple);
        CHECK_NEAR(single, e, 1e-15);
        CHECK_NEAR(single + multiple, 1, 1e-15);
        kiln_fdez_aguera(0.5, e - b, b, &single, &multiple);
        double f = 11 / 21.0, m = 1 - e;
        CHECK_NEAR(single, 0.5 * (e - b) + b, 1e-15);
        CHECK_NEAR(multiple, single * f * m / (1 - f * m), 1e-15);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kulla_conty_closes_the_furnace),
        cmocka_unit_test(f_add_sums_the_bounces),
        cmocka_unit_test(furnaces_close_at_f0_of_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

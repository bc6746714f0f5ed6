// Fresnel terms F: their values at both ends, metals by their measured indices, averages against
// quadrature, and the errors of fits.
#include "kit/kit.h"
#include "kit/quadrature.h"

#include <kiln/brdf.h>

typedef struct index {
    double n, k, split;
} index;

static double dielectric_mu(void *data, double mu)
{
    return 2 * mu * kiln_fresnel_dielectric(((index *)data)->n, mu);
}

static double conductor_mu(void *data, double mu)
{
    const index *i = data;
    return 2 * mu * kiln_fresnel_conductor(i->n, i->k, mu);
}

static double f82_mu(void *data, double mu)
{
    const index *i = data;
    return 2 * mu * kiln_fresnel_f82(i->n, i->k, mu);
}

static double schlick_mu(void *data, double mu)
{
    return 2 * mu * kiln_fresnel_schlick(((index *)data)->n, mu);
}

// The integral of f over [0, 1], where f has a kink at `split`: panels from both ends towards
// `split` shrink by a factor of 4 each.
static double graded(double (*f)(void *data, double x), void *data, double split)
{
    double sum = 0, left = split, right = 1 - split;
    for (int i = 0; i < 24; i++) {
        sum += integrate(f, data, split - left, split - left / 4, 1);
        sum += integrate(f, data, split + right / 4, split + right, 1);
        left /= 4;
        right /= 4;
    }
    return sum;
}

static void fresnel_at_its_ends(void **state)
{
    (void)state;
    static const double iors[] = {0.2, 0.7, 0.999, 1.0001, 1.33, 1.5, 2.4, 40};
    for (int i = 0; i < 8; i++) {
        double n = iors[i], f0 = (n - 1) * (n - 1) / ((n + 1) * (n + 1));
        CHECK_NEAR(kiln_fresnel_dielectric(n, 1), f0, 1e-15);
        CHECK_NEAR(kiln_fresnel_dielectric(n, 0), 1, 1e-15);
        CHECK_NEAR(kiln_fresnel_schlick(f0, 1), f0, 0);
        CHECK_NEAR(kiln_fresnel_schlick(f0, 0), 1, 0);
        CHECK_NEAR(kiln_fresnel_conductor(n, 3, 1),
                   ((n - 1) * (n - 1) + 9) / ((n + 1) * (n + 1) + 9), 1e-15);
        CHECK_NEAR(kiln_fresnel_conductor(n, 3, 0), 1, 0);
        // F is 1 beyond the critical angle.
        if (n < 1) {
            CHECK_NEAR(kiln_fresnel_dielectric(n, sqrt(1 - n * n) - 1e-9), 1, 0);
            assert_true(kiln_fresnel_dielectric(n, sqrt(1 - n * n) + 1e-3) < 1);
        }
        // At Brewster's angle, tan theta = n, half of the light is reflected by R_s only.
        double rs = (1 - n * n) / (1 + n * n);
        CHECK_NEAR(kiln_fresnel_dielectric(n, 1 / sqrt(1 + n * n)), rs * rs / 2, 4e-15);
        // F is the same for a ray and, from the other side, for the refracted ray.
        for (int j = 1; j <= 10; j++) {
            double c = j / 10.0, s2 = (1 - c * c) / (n * n);
            if (s2 < 1)
                CHECK_NEAR(kiln_fresnel_dielectric(1 / n, sqrt(1 - s2)),
                           kiln_fresnel_dielectric(n, c), 1e-11);
            CHECK_NEAR(kiln_fresnel_conductor(n, 0, c), kiln_fresnel_dielectric(n, c), 4e-15);
        }
    }
    for (int j = 0; j <= 10; j++)
        assert_true(kiln_fresnel_dielectric(1, j / 10.0) == 0 &&
                    kiln_fresnel_conductor(1, 0, j / 10.0) == 0);
}

static void gulbrandsen_gives_the_reflectivity_back(void **state)
{
    (void)state;
    for (int i = 0; i <= 999; i++)
        for (int j = 0; j <= 20; j++) {
            double r = i / 1000.0, g = j / 20.0, n, k;
            kiln_gulbrandsen(r, g, &n, &k);
            CHECK_NEAR(kiln_fresnel_conductor(n, k, 1), r, 1e-13);
            double root = sqrt(r), n_max = (1 + root) / (1 - root);
            CHECK_NEAR(n, g * (1 - r) / (1 + r) + (1 - g) * n_max, 1e-13 * n_max);
            CHECK_NEAR(k * k * (1 - r), r * (n + 1) * (n + 1) - (n - 1) * (n - 1),
                       1e-13 * n_max * n_max);
        }
}

// The Fresnel term of metals is f0 at voh = 1, f82 at voh = 1/7 and 1 at voh = 0. It equals
// Schlick's if f82 is Schlick's value, and stays in [0, 1].
static void metals_dip_at_82_degrees(void **state)
{
    (void)state;
    for (int i = 0; i <= 10; i++)
        for (int j = 0; j <= 10; j++) {
            double f0 = i / 10.0, f82 = j / 10.0;
            double schlick = kiln_fresnel_schlick(f0, 1.0 / 7);
            CHECK_NEAR(kiln_fresnel_f82(f0, f82, 1), f0, 0);
            CHECK_NEAR(kiln_fresnel_f82(f0, f82, 0), 1, 0);
            CHECK_NEAR(kiln_fresnel_f82(f0, f82, 1.0 / 7), f82, 1e-14);
            for (int k = 0; k <= 64; k++) {
                double f = kiln_fresnel_f82(f0, f82, k / 64.0);
                assert_true(f >= 0 && f <= 1);
                CHECK_NEAR(kiln_fresnel_f82(f0, schlick, k / 64.0),
                           kiln_fresnel_schlick(f0, k / 64.0), 1e-14);
            }
            index metal = {f0, f82, 0};
            if (f0 > 0.19 && f82 >= f0 && f82 <= schlick)
                CHECK_NEAR(kiln_fresnel_f82_average(f0, f82), graded(f82_mu, &metal, 0), 1e-14);
        }
}

static void averages_agree_with_quadrature(void **state)
{
    (void)state;
    double worst = 0;
    for (int i = 0; i <= 20; i++) {
        index f = {i / 20.0, 0, 0};
        CHECK_NEAR(kiln_fresnel_schlick_average(f.n), graded(schlick_mu, &f, 0), 1e-14);
    }
    for (int i = 0; i < 400; i++) {
        index f = {i < 200 ? (i + 0.5) / 200 : 1 + pow(10, (i - 380) / 20.0), 0, 0};
        double split = f.n < 1 ? sqrt(1 - f.n * f.n) : 0;
        double off = kiln_fresnel_dielectric_average(f.n) - graded(dielectric_mu, &f, split);
        worst = fmax(worst, fabs(off));
    }
    CHECK_BELOW(worst, 1e-13);
    CHECK_NEAR(kiln_fresnel_dielectric_average(1.5), 0.09177795934235121, 1e-15);
    CHECK_NEAR(kiln_fresnel_dielectric_average(0.5), 0.79014915926740151, 1e-15);
    CHECK_NEAR(kiln_fresnel_dielectric_average(1), 0, 0);
    CHECK_NEAR(kiln_fresnel_dielectric_average(0), 1, 0);
    CHECK_NEAR(kiln_fresnel_dielectric_average(HUGE_VAL), 1, 1e-7);
    for (int i = 0; i <= 30; i++)
        for (int j = 0; j <= 12; j++) {
            index f = {0.1 * i, j ? pow(10, j / 2.0 - 5) : 0, 0};
            double split = f.n < 1 ? sqrt(1 - f.n * f.n) : 0;
            CHECK_NEAR(kiln_fresnel_conductor_average(f.n, f.k), graded(conductor_mu, &f, split),
                       1e-12);
        }
    // Small n: light from the denser side leaves through a narrow cone only. Small k: the average
    // is near that of a dielectric.
    for (int i = 0; i <= 40; i++)
        for (int j = 0; j <= 6; j++) {
            index f = {pow(10, -i / 10.0), j ? pow(10, j - 10) : 0, 0};
            double off = kiln_fresnel_conductor_average(f.n, f.k);
            off -= kiln_fresnel_dielectric_average(f.n);
            // Absorption changes the average by less than a few k.
            CHECK_NEAR(off, 0, 1e-12 + 8 * f.k);
        }
}

// The fits have the errors that kiln/brdf.h and docs/theory/fresnel.md state.
static void fits_err_as_documented(void **state)
{
    (void)state;
    double above = 0, below = 0, metal = 0, mean = 0;
    for (int i = 0; i <= 20000; i++) {
        double t = i / 20000.0, n = pow(400, t);
        above = fmax(above, fabs(kiln_fresnel_dielectric_average_fit(n) -
                                 kiln_fresnel_dielectric_average(n)));
        below = fmax(below, fabs(kiln_fresnel_dielectric_average_fit(t) -
                                 kiln_fresnel_dielectric_average(t)));
    }
    for (int i = 0; i < 100; i++)
        for (int j = 0; j <= 50; j++) {
            double n, k, r = i / 100.0, g = j / 50.0;
            kiln_gulbrandsen(r, g, &n, &k);
            double off =
                kiln_fresnel_conductor_average_fit(r, g) - kiln_fresnel_conductor_average(n, k);
            metal = fmax(metal, fabs(off));
            mean += off * off / (100 * 51);
        }
    printf("Imageworks' fits: ior above 1 %.5f, below 1 %.5f, conductors %.4f, rms %.4f\n", above,
           below, metal, sqrt(mean));
    CHECK_NEAR(above, 0.00652, 5e-6);
    CHECK_NEAR(below, 0.00288, 5e-6);
    CHECK_NEAR(metal, 0.1013, 5e-5);
    CHECK_NEAR(sqrt(mean), 0.0136, 5e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fresnel_at_its_ends),
        cmocka_unit_test(gulbrandsen_gives_the_reflectivity_back),
        cmocka_unit_test(metals_dip_at_82_degrees),
        cmocka_unit_test(averages_agree_with_quadrature),
        cmocka_unit_test(fits_err_as_documented),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

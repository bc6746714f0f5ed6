// The distributions D, the maskings G, the Fresnel terms F with their averages, and the
// compensations of lost energy obey their laws and have their published values.
#include "kit/kit.h"
#include "kit/quadrature.h"

#include <float.h>
#include <kiln/brdf.h>

enum { DISTRIBUTIONS = KILN_D_BECKMANN + 1 };

static const kiln_g all_g[] = {KILN_G_SMITH, KILN_G_SMITH_UNCORRELATED, KILN_G_SCHLICK_K2,
                               KILN_G_SCHLICK_TEXT};

// ------------------------------------------------------------------------------------------- D, G

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

// ---------------------------------------------------------------------------------------------- F

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

// ----------------------------------------------------------------------------------- compensation

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
        cmocka_unit_test(distributions_integrate_to_one),
        cmocka_unit_test(mirrors_are_the_limit),
        cmocka_unit_test(shadowing_is_a_symmetric_share),
        cmocka_unit_test(specular_is_reciprocal_and_finite),
        cmocka_unit_test(fresnel_at_its_ends),
        cmocka_unit_test(gulbrandsen_gives_the_reflectivity_back),
        cmocka_unit_test(metals_dip_at_82_degrees),
        cmocka_unit_test(averages_agree_with_quadrature),
        cmocka_unit_test(fits_err_as_documented),
        cmocka_unit_test(kulla_conty_closes_the_furnace),
        cmocka_unit_test(f_add_sums_the_bounces),
        cmocka_unit_test(furnaces_close_at_f0_of_one),
        cmocka_unit_test(nothing_is_not_a_number),
        cmocka_unit_test(integrals_take_any_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

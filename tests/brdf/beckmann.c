// Beckmann's distribution: D and Lambda obey their laws, and A and B agree with integrals over half
// vectors.
#include "kit/kit.h"
#include "kit/quadrature.h"

#include "brdf/beckmann.h"

static double lambda(double alpha, double cosine)
{
    double a = cosine / (alpha * sqrt((1 - cosine) * (1 + cosine)));
    return a > 20 ? 0 : (exp(-a * a) / (a * sqrt(pi)) - erfc(a)) / 2;
}

// The projected areas of all microfacets sum to the area of the surface, int D (n.h) dh = 1. The
// projected areas of the microfacets that v sees sum to the surface's, int D G1(v) max(v.h, 0) dh =
// n.v. Heitz 2014.
static void normals_are_normalized(void **unused)
{
    (void)unused;
    for (int a = 0; a < 8; a++)
        for (int b = 0; b < 7; b++) {
            double alpha = 0.02 + 0.14 * a, nov = 0.03 + 0.16 * b;
            double area = 0, seen = 0, sin_v = sqrt(1 - nov * nov);
            double theta[HALF_NODES], w[HALF_NODES], phi[HALF_NODES], u[HALF_NODES];
            // theta is cut where D has become small, and where v.h < 0 at some azimuths.
            double cut1 = fmin(4 * alpha, 1), cut2 = asin(nov);
            double cuts[] = {0, fmin(cut1, cut2), fmax(cut1, cut2), HALF_PI};
            for (int part = 0; part < 3; part++) {
                half_rule(cuts[part], cuts[part + 1], theta, w);
                for (int i = 0; i < HALF_NODES; i++) {
                    double c = cos(theta[i]), s = sin(theta[i]);
                    double d = ki_beckmann_d(alpha, c) * s * w[i];
                    area += 2 * pi * d * c;
                    double least = -nov * c / (sin_v * s);
                    half_rule(0, acos(fmin(1, fmax(-1, least))), phi, u);
                    for (int j = 0; j < HALF_NODES; j++)
                        seen += 2 * d * u[j] * fmax(0, nov * c + sin_v * s * cos(phi[j]));
                }
            }
            CHECK_NEAR(area, 1, 1e-10);
            CHECK_NEAR(seen / (1 + ki_beckmann_lambda(alpha, nov)), nov, 1e-10);
        }
}

static void lambda_is_exact(void **unused)
{
    (void)unused;
    for (int i = 0; i <= 24; i++)
        for (int j = 1; j <= 60; j++) {
            double alpha = pow(10, -i / 8.0), cosine = pow(10, -j / 10.0);
            double wanted = lambda(alpha, cosine);
            CHECK_NEAR(ki_beckmann_lambda(alpha, cosine), wanted, 1e-14 * (1 + wanted));
        }
    CHECK_NEAR(ki_beckmann_lambda(0.5, 1), 0, 0);
    CHECK_NEAR(ki_beckmann_lambda(0, 0.5), 0, 0);
    assert_true(ki_beckmann_lambda(0.5, 0) > 1e300);
    CHECK_NEAR(ki_beckmann_d(0.5, 0), 0, 0);
    CHECK_NEAR(ki_beckmann_d(0.5, 1), 4 / pi, 1e-15);
}

typedef struct setting {
    kiln_g g;
    double roughness, nov;
} setting;

static double shadowing(const setting *s, double nol)
{
    double alpha = s->roughness * s->roughness, k = alpha / 2;
    if (s->g == KILN_G_SMITH)
        return 1 / (1 + lambda(alpha, s->nov) + lambda(alpha, nol));
    if (s->g == KILN_G_SMITH_UNCORRELATED)
        return 1 / ((1 + lambda(alpha, s->nov)) * (1 + lambda(alpha, nol)));
    if (s->g == KILN_G_SCHLICK_TEXT)
        k = (s->roughness + 1) * (s->roughness + 1) / 8;
    return s->nov / (s->nov * (1 - k) + k) * nol / (nol * (1 - k) + k);
}

// The integrands of E, x[0] = D G (v.h) / (n.v), and of B, x[1] = x[0] (1 - v.h)^5.
static void facet(const void *user, const half *h, double *x)
{
    const setting *s = user;
    double slope = h->sin_h / (h->noh * s->roughness * s->roughness), alpha = s->roughness;
    alpha *= alpha;
    double d = exp(-slope * slope) / (pi * alpha * alpha * pow(h->noh, 4));
    x[0] = d * shadowing(s, h->nol) * h->voh / s->nov;
    x[1] = x[0] * pow(1 - fmin(h->voh, 1), 5);
}

static double deviation(const setting *s)
{
    double sums[2] = {0}, ab[2];
    half_integrate(s->nov, s->roughness * s->roughness, facet, s, 2, sums);
    ki_beckmann_energy(&(kiln_model){KILN_D_BECKMANN, s->g}, s->roughness, s->nov, ab);
    return fmax(fabs(ab[0] + ab[1] - sums[0]), fabs(ab[1] - sums[1]));
}

static void energy_agrees_with_brute_force(void **unused)
{
    (void)unused;
    static const double roughness[] = {0.03, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1};
    static const double nov[] = {1e-3, 0.01, 0.04, 0.1, 0.25, 0.5, 0.8, 0.97, 1};
    double worst = 0;
    setting at = {0};
    for (int g = 0; g < 4; g++)
        for (int i = 0; i < 8; i++)
            for (int j = 0; j < 9; j++) {
                setting s = {(kiln_g)g, roughness[i], nov[j]};
                double error = deviation(&s);
                if (error > worst)
                    worst = error, at = s;
            }
    uint64_t seed = 1;
    for (int i = 0; i < 60; i++) { // random settings
        double x[2];
        for (int k = 0; k < 2; k++)
            x[k] = random_number(&seed);
        setting s = {(kiln_g)(i % 4), 0.02 + 0.98 * x[0], 1e-4 + 0.9999 * x[1] * x[1]};
        double error = deviation(&s);
        if (error > worst)
            worst = error, at = s;
    }
    printf("worst %g at G %d, roughness %g, n.v %g\n", worst, at.g, at.roughness, at.nov);
    CHECK_BELOW(worst, 1e-8);
}

// A and B are positive, and E = A + B is at most 1. At roughness 0 and at n.v = 0 they are the
// limits. Arguments out of range are clamped.
static void corners(void **unused)
{
    (void)unused;
    double ab[2], last[2];
    for (int g = 0; g < 4; g++) {
        kiln_model model = {KILN_D_BECKMANN, (kiln_g)g};
        for (int i = 0; i <= 16; i++)
            for (int j = 0; j <= 16; j++) {
                ki_beckmann_energy(&model, i / 16.0, j / 16.0, ab);
                assert_true(ab[0] >= 0 && ab[1] >= 0 && ab[0] + ab[1] <= 1 + 1e-8);
            }
        for (int i = 0; i <= 4; i++) { // a mirror
            double nov = i / 4.0, g1 = nov / (nov * (1 - 1.0 / 8) + 1.0 / 8);
            double visible = g == KILN_G_SCHLICK_TEXT ? g1 * g1 : 1;
            ki_beckmann_energy(&model, 0, nov, ab);
            CHECK_NEAR(ab[0] + ab[1], visible, 1e-15);
            CHECK_NEAR(ab[1], visible * pow(1 - nov, 5), 1e-15);
        }
        ki_beckmann_energy(&model, 0.6, 0, ab); // n.v = 0 gives the limit
        ki_beckmann_energy(&model, 0.6, 1e-7, last);
        CHECK_NEAR(ab[0], last[0], 1e-5);
        CHECK_NEAR(ab[1], last[1], 1e-5);
        ki_beckmann_energy(&model, -1, 2, ab);
        ki_beckmann_energy(&model, 0, 1, last);
        assert_memory_equal(ab, last, sizeof ab);
        ki_beckmann_energy(&model, 7, -1, ab);
        ki_beckmann_energy(&model, 1, 0, last);
        assert_memory_equal(ab, last, sizeof ab);
    }
    // E of a narrow lobe at n.v = 1 is precise.
    for (int i = 1; i <= 20; i++) {
        ki_beckmann_energy(&(kiln_model){.d = KILN_D_BECKMANN}, 1e-4 * i, 1, ab);
        CHECK_NEAR(ab[0] + ab[1], 1, 1e-11);
    }
    // At low roughness and n.v = 0.7 hardly a slope is steep enough to mask light: E is 1 with
    // Smith's G.
    ki_beckmann_energy(&(kiln_model){.d = KILN_D_BECKMANN}, 0.1, 0.7, ab);
    CHECK_NEAR(ab[0] + ab[1], 1, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lambda_is_exact),
        cmocka_unit_test(normals_are_normalized),
        cmocka_unit_test(energy_agrees_with_brute_force),
        cmocka_unit_test(corners),
    };
    return cmocka_run_group_tests_name("beckmann", tests, NULL, NULL);
}

// Charlie sheen: D is normalised, masking has its published values, and the albedo agrees with
// integrals over half vectors, over light directions, and with closed forms.
#include "kit/kit.h"
#include "kit/quadrature.h"

#include "brdf/sheen.h"

// D is normalised: int D (n.h) dh = 1. Estevez and Kulla 2017.
static void normals_are_normalized(void **unused)
{
    (void)unused;
    for (int a = 1; a <= 100; a += 9) {
        double theta[HALF_NODES], w[HALF_NODES], area = 0;
        half_rule(0, HALF_PI, theta, w);
        for (int i = 0; i < HALF_NODES; i++)
            area += 2 * pi * w[i] * ki_sheen_d(a / 100.0, cos(theta[i])) * sin(theta[i]) *
                    cos(theta[i]);
        CHECK_NEAR(area, 1, 1e-11);
    }
}

// Lambda by the formula and the coefficients of the extension KHR_materials_sheen, evaluated with
// libm.
static double khronos_lambda(double alpha, double x)
{
    double w = (1 - alpha) * (1 - alpha), l[2];
    for (int i = 0; i < 2; i++) {
        double y = i ? 0.5 : x < 0.5 ? x : 1 - x;
        double a = 21.5473 + (25.3245 - 21.5473) * w, b = 3.82987 + (3.32435 - 3.82987) * w;
        double c = 0.19823 + (0.16801 - 0.19823) * w, d = -1.97760 + (1.97760 - 1.27393) * w;
        double e = -4.32054 + (4.32054 - 4.85967) * w;
        l[i] = a / (1 + b * pow(y, c)) + d * y + e;
    }
    return exp(x < 0.5 ? l[0] : 2 * l[1] - l[0]);
}

typedef struct setting {
    kiln_sheen sheen;
    double roughness, nov;
} setting;

static double visibility(const setting *s, double nol)
{
    double alpha = s->roughness * s->roughness;
    if (s->sheen == KILN_SHEEN_ASHIKHMIN)
        return 1 / (4 * (nol + s->nov - nol * s->nov));
    return 1 /
           (4 * nol * s->nov * (1 + khronos_lambda(alpha, nol) + khronos_lambda(alpha, s->nov)));
}

static void visibility_is_the_published(void **unused)
{
    (void)unused;
    for (int i = 0; i < 1000; i++) {
        setting s = {(kiln_sheen)(i % 2), 0.1 + (i % 7) * 0.15, 0.01 + (i % 10) * 0.11};
        double nol = 0.001 + i * 0.000998, wanted = visibility(&s, nol);
        double value = ki_sheen_visibility(s.sheen, s.roughness * s.roughness, s.nov, nol);
        CHECK_NEAR(value, wanted, 1e-13 * wanted);
    }
}

// The integrand of the albedo over half vectors, D V (n.l) 4 (v.h).
static void fibre(const void *user, const half *h, double *x)
{
    const setting *s = user;
    double p = 1 / (s->roughness * s->roughness);
    double d = (2 + p) * pow(h->sin_h, p) / (2 * pi);
    x[0] = d * visibility(s, h->nol) * h->nol * 4 * h->voh;
}

static double half_albedo(const setting *s)
{
    double sum = 0, width = HALF_PI - 8 * s->roughness; // D is near 0 for smaller theta
    half_integrate(s->nov, width > 0 ? width : 1, fibre, s, 1, &sum);
    return sum;
}

// The albedo as an integral of D V (n.l) over light directions, cut at the n.l where the integrand
// is not smooth.
static double light_albedo(const setting *s)
{
    double p = 1 / (s->roughness * s->roughness), sin_v = sqrt(1 - s->nov * s->nov), sum = 0;
    double cuts[] = {0, fmin(s->nov, 0.5), fmax(s->nov, 0.5), 1};
    for (int part = 0; part < 3; part++) {
        double nol[HALF_NODES], w[HALF_NODES], phi[HALF_NODES], u[HALF_NODES];
        half_rule(cuts[part], cuts[part + 1], nol, w);
        half_rule(0, pi, phi, u);
        for (int i = 0; i < HALF_NODES; i++)
            for (int j = 0; j < HALF_NODES; j++) {
                double sin_l = sqrt(1 - nol[i] * nol[i]), x = sin_v - sin_l * cos(phi[j]);
                double y = sin_l * sin(phi[j]), z = s->nov + nol[i];
                double sin2_h = (x * x + y * y) / (x * x + y * y + z * z);
                sum += w[i] * u[j] * pow(sin2_h, p / 2) * visibility(s, nol[i]) * nol[i];
            }
    }
    return 2 * sum * (2 + p) / (2 * pi);
}

static void check(double (*brute)(const setting *s), kiln_sheen kind, double bound)
{
    static const double roughness[] = {0.01, 0.03, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1};
    static const double nov[] = {1e-4, 1e-3, 0.01, 0.04, 0.1, 0.25, 0.5, 0.501, 0.8, 0.97, 1};
    double worst = 0;
    setting at = {0};
    uint64_t seed = 1;
    for (int i = 0; i < 9 * 11 + 40; i++) {
        double x[2];
        for (int k = 0; k < 2; k++)
            x[k] = random_number(&seed);
        setting s = {kind, 0.01 + 0.99 * x[0], 1e-4 + 0.9999 * x[1] * x[1]};
        if (i < 9 * 11)
            s = (setting){kind, roughness[i % 9], nov[i / 9]};
        double wanted = brute(&s), value = kiln_sheen_albedo(s.sheen, s.roughness, s.nov);
        double error = fabs(value - wanted) / fmax(1, wanted);
        if (error > worst)
            worst = error, at = s;
    }
    printf("worst %g at roughness %g, n.v %g\n", worst, at.roughness, at.nov);
    CHECK_BELOW(worst, bound);
}

static void albedo_agrees_with_brute_force(void **unused)
{
    (void)unused;
    check(half_albedo, KILN_SHEEN_ASHIKHMIN, 1e-9);
    check(light_albedo, KILN_SHEEN_ESTEVEZ, 1e-7);
}

// The albedo with Estevez and Kulla's masking agrees with an integral over half vectors, which
// shares no code with the integral over light directions. It is less precise, because the masking
// is not smooth at n.l = 1/2 and 1, and the integral over half vectors is not cut there.
static void fit_agrees_over_the_half_vector(void **unused)
{
    (void)unused;
    for (int i = 0; i < 40; i++) {
        setting s = {KILN_SHEEN_ESTEVEZ, 0.15 + (i % 8) * 0.12, 0.003 + (i % 5) * 0.2};
        double wanted = half_albedo(&s);
        CHECK_NEAR(kiln_sheen_albedo(s.sheen, s.roughness, s.nov), wanted, 2e-6 * fmax(1, wanted));
    }
}

// With Ashikhmin's masking and p = 1/alpha, the albedo has closed forms at both ends of n.v. At n.v
// = 1 it is 2^(-p/2) / (p + 4). At n.v = 0 it is (2 + p) / (2 sqrt pi) Gamma((p + 3) / 2) /
// Gamma((p + 4) / 2), which is far above 1 for smooth cloth.
static void ends_are_analytic(void **unused)
{
    (void)unused;
    for (int i = 1; i <= 20; i++) {
        double r = i / 20.0, p = 1 / (r * r);
        double grazing = (2 + p) / (2 * sqrt(pi)) * exp(lgamma((p + 3) / 2) - lgamma((p + 4) / 2));
        CHECK_NEAR(kiln_sheen_albedo(KILN_SHEEN_ASHIKHMIN, r, 1), pow(2, -p / 2) / (p + 4), 1e-12);
        CHECK_NEAR(kiln_sheen_albedo(KILN_SHEEN_ASHIKHMIN, r, 0), grazing, 2e-9 * grazing);
    }
}

static void arguments_are_clamped(void **unused)
{
    (void)unused;
    for (int kind = 0; kind < 2; kind++) {
        kiln_sheen sheen = (kiln_sheen)kind;
        double least = kind == KILN_SHEEN_ESTEVEZ ? 1e-4 : 0;
        CHECK_NEAR(kiln_sheen_albedo(sheen, 0, 0.02), kiln_sheen_albedo(sheen, 0.01, 0.02), 0);
        CHECK_NEAR(kiln_sheen_albedo(sheen, 9, 7), kiln_sheen_albedo(sheen, 1, 1), 0);
        CHECK_NEAR(kiln_sheen_albedo(sheen, 1, -1), kiln_sheen_albedo(sheen, 1, least), 0);
        // As roughness tends to 0, the albedo tends to 0 except at grazing angles.
        CHECK_NEAR(kiln_sheen_albedo(sheen, 0, 0.2), 0, 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normals_are_normalized),
        cmocka_unit_test(visibility_is_the_published),
        cmocka_unit_test(albedo_agrees_with_brute_force),
        cmocka_unit_test(fit_agrees_over_the_half_vector),
        cmocka_unit_test(ends_are_analytic),
        cmocka_unit_test(arguments_are_clamped),
    };
    return cmocka_run_group_tests_name("sheen", tests, NULL, NULL);
}

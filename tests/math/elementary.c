// Elementary functions, error functions and the beta function agree with libm, up to the ends of
// their ranges.
#include "kit/kit.h"

#include "math/math.h"

#include <float.h>

static uint64_t seed = 1;

// The error of `value` in units of the last place of `wanted`.
static double ulps(double value, long double wanted)
{
    int exponent;
    (void)frexpl(wanted, &exponent);
    long double unit = fmaxl(ldexpl(1, exponent - 53), (long double)DBL_TRUE_MIN);
    return (double)(fabsl((long double)value - wanted) / unit);
}

static void elementary_functions_agree_with_libm(void **unused)
{
    (void)unused;
    double sine = 0, circle = 0, exponent = 0, logarithm = 0, power = 0, angle = 0, arc = 0;
    for (int i = 0; i < 400000; i++) {
        double x = random_between(&seed, -1e4, 1e4), s, c;
        ki_sincos(x, &s, &c);
        circle = fmax(circle, fabs(s * s + c * c - 1));
        long double wide = (long double)x;
        sine = fmax(sine, fmax(fabs(s - (double)sinl(wide)), fabs(c - (double)cosl(wide))));
        x = random_between(&seed, -700, 700);
        exponent = fmax(exponent, ulps(ki_exp(x), expl((long double)x)));
        x = i % 2 ? random_between(&seed, 0.5, 2) : exp(random_between(&seed, -700, 700));
        logarithm = fmax(logarithm, ulps(ki_log(x), logl((long double)x)));
        double base = random_between(&seed, 1e-3, 2), to = random_between(&seed, -50, 50);
        long double a = (long double)base, b = (long double)to;
        power = fmax(power, (double)(fabsl((long double)ki_pow(base, to) / powl(a, b) - 1) /
                                     (1 + fabsl(b * logl(a)))));
        double y = random_between(&seed, -1, 1), z = random_between(&seed, -1, 1);
        wide = (long double)y;
        angle = fmax(angle, ulps(ki_atan2(y, z), atan2l(wide, (long double)z)));
        arc = fmax(arc, fabs(ki_asin(y) - (double)asinl(wide)));
        arc = fmax(arc, fabs(ki_acos(y) - (double)acosl(wide)));
    }
    CHECK_BELOW(sine, 2e-16);
    CHECK_BELOW(circle, 5e-16);
    CHECK_BELOW(exponent, 2);
    CHECK_BELOW(logarithm, 2);
    CHECK_BELOW(power, 4e-16);
    CHECK_BELOW(angle, 3);
    CHECK_BELOW(arc, 7e-16);
}

static void error_functions_agree_with_libm(void **unused)
{
    (void)unused;
    double error = 0, scaled = 0;
    for (int i = 0; i < 200000; i++) {
        double x = i % 2 ? random_between(&seed, -1, 1) : random_between(&seed, -7, 7);
        error = fmax(error, ulps(ki_erf(x), erfl((long double)x)));
        x = i % 2 ? random_between(&seed, 0, 2) : random_between(&seed, 0, 60);
        long double wide = (long double)x;
        scaled = fmax(scaled, ulps(ki_erfcx(x), expl(wide * wide) * erfcl(wide)));
    }
    CHECK_BELOW(error, 2);
    CHECK_BELOW(scaled, 5);
    // The limits: erf x is 2 x / sqrt(pi) for small x, and erfcx x is 1 / (x sqrt(pi)) for large x.
    CHECK_NEAR(ki_erf(1e-300) / 1e-300, 1.1283791670955126, 3e-16);
    CHECK_NEAR(ki_erfcx(0), 1, 3e-16);
    CHECK_NEAR(ki_erfcx(1e200) * 1e200, 0.56418958354775629, 3e-16);
    CHECK_NEAR(ki_erf(40), 1, 0);
}

static void beta_agrees_with_libm(void **unused)
{
    (void)unused;
    double small = 0, great = 0;
    for (int i = 0; i < 100000; i++) {
        double a = 1 + exp(random_between(&seed, -8, 3)), b = 1 + exp(random_between(&seed, -8, 3));
        long double wide = (long double)a + (long double)b;
        long double wanted =
            expl(lgammal((long double)a) + lgammal((long double)b) - lgammal(wide));
        small = fmax(small, fabs(ki_beta(a, b) / (double)wanted - 1));
        CHECK_NEAR(ki_beta(a, b), ki_beta(b, a), 0);
        // B(a, n) = (n - 1)! / (a (a + 1) ... (a + n - 1)).
        a = exp(random_between(&seed, 0, 20));
        great = fmax(great, fabs(ki_beta(a, 3) * a * (a + 1) * (a + 2) / 2 - 1));
    }
    CHECK_BELOW(small, 1e-12);
    CHECK_BELOW(great, 1e-12);
    CHECK_NEAR(ki_beta(1, 1), 1, 1e-12);
}

static void ends_of_the_ranges(void **unused)
{
    (void)unused;
    CHECK_NEAR(ki_exp(0), 1, 0);
    CHECK_NEAR(ki_exp(-800), 0, 0);
    assert_true(ki_exp(1000) <= DBL_MAX && ki_exp(-740) > 0);
    CHECK_NEAR(ki_log(1), 0, 0);
    CHECK_BELOW(ulps(ki_log(DBL_TRUE_MIN), logl((long double)DBL_TRUE_MIN)), 2);
    CHECK_NEAR(ki_pow(0, 2), 0, 0);
    CHECK_NEAR(ki_pow(5, 0), 1, 0);
    CHECK_NEAR(ki_atan2(0, -1), KI_PI, 0);
    CHECK_NEAR(ki_acos(1), 0, 0);
    CHECK_NEAR(ki_sin(0), 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(elementary_functions_agree_with_libm),
        cmocka_unit_test(error_functions_agree_with_libm),
        cmocka_unit_test(beta_agrees_with_libm),
        cmocka_unit_test(ends_of_the_ranges),
    };
    return cmocka_run_group_tests_name("math", tests, NULL, NULL);
}

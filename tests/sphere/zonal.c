// Zonal series of lobes: closed forms, the sum of a series, the size of its tail, and lobes out of
// range.
#include "sphere/zonal.h"
#include "math/math.h"
#include "sphere/lobe.h"

#include "kit/context.h"

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
        CHECK_BELOW(spectrum.truncation, 1e-5);
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
    CHECK_NEAR(sqrt(beyond / all), rough.truncation, 1e-6);
    CHECK_BELOW(rough.truncation, 1e-3);
    ki_zonal_free(&rough);
    ki_zonal_free(&fine);
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
        cmocka_unit_test(lambert_has_its_closed_form),
        cmocka_unit_test(zonal_series_gives_the_lobe_back),
        cmocka_unit_test(zonal_tail_is_what_it_says),
        cmocka_unit_test(lobes_out_of_range_are_refused),
    };
    return cmocka_run_group_tests_name("sphere parts", tests, set_up, tear_down);
}

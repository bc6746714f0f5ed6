// The basis of spherical harmonics is orthonormal, and harmonics that are filtered are those of a
// spectrum.
#include "math/math.h"
#include "sphere/sh.h"

#include "kit/context.h"

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

static void filtered_harmonics_are_the_spectrums(void **state)
{
    (void)state;
    kiln_map source = scene_panorama(context, 32, 8);
    kiln_spectrum *spectrum;
    kiln_sh all, wanted, made;
    CHECK_OK(kiln_spectrum_analyze(context, &source, 8, &spectrum, &error));
    CHECK_OK(kiln_map_sh(context, &source, 5, 12, &all, &error));
    for (int bands = 1; bands <= 5; bands++)
        for (int kind = 0; kind < 4; kind++) {
            double window = kind & 2 ? 3.5 : 0;
            CHECK_OK(kiln_spectrum_sh(spectrum, bands, kind & 1, window, 12, &wanted, &error));
            CHECK_OK(kiln_sh_filter(&all, bands, kind & 1, window, &made, &error));
            assert_int_equal(made.bands, bands);
            assert_int_equal(made.irradiance, kind & 1);
            for (int k = 0; k < bands * bands; k++)
                for (int c = 0; c < 3; c++)
                    CHECK_NEAR(made.c[k][c], wanted.c[k][c], 0);
        }
    // What was filtered is not filtered again, and there are no more bands than there were.
    CHECK_OK(kiln_sh_filter(&all, 3, true, 0, &made, &error));
    assert_int_equal(kiln_sh_filter(&made, 3, true, 0, &wanted, &error), KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "3 bands of irradiance");
    CHECK_OK(kiln_sh_filter(&all, 2, false, 0, &made, &error));
    assert_int_equal(kiln_sh_filter(&made, 3, false, 0, &wanted, &error), KILN_ERROR_ARGUMENT);
    assert_int_equal(wanted.bands, 0);
    kiln_spectrum_destroy(spectrum);
    kiln_map_free(&source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sh_basis_is_orthonormal),
        cmocka_unit_test(filtered_harmonics_are_the_spectrums),
    };
    return cmocka_run_group_tests_name("sphere parts", tests, set_up, tear_down);
}

// What must hold for every environment.
#include "bake/reference.h"
#include "math/math.h"
#include "sphere/sh.h"

#include "kit/context.h"

// GGX at all pairs of sizes, the other lobes at the smallest; test_sphere_lobes has their large
// sizes.
static void white_furnace_stays_white(void **state)
{
    (void)state;
    static const int sizes[] = {1, 2, 3, 16, 33, 50, 128};
    static const int faces[] = {1, 5, 64, 100};
    for (int s = 0; s < 7; s++)
        for (int f = 0; f < 4; f++)
            CHECK_BELOW(filtered_furnace_error(context, sizes[s], faces[f], KILN_LOBE_GGX), 1e-6);
    for (int lobe = 1; lobe < 4; lobe++)
        CHECK_BELOW(filtered_furnace_error(context, 1, 5, (enum kiln_lobe_kind)lobe), 1e-6);
}

// The mean over all directions does not change: a lobe only moves light. Panorama rows are
// integrated by Fejer's rule, exact for these smooth results.
static void every_level_keeps_the_mean(void **state)
{
    (void)state;
    kiln_map in = scene_panorama(context, 96, 3), out;
    double wanted[3] = {0};
    for (int y = 0; y < 96; y++)
        for (int x = 0; x < 192; x++)
            for (int c = 0; c < 3; c++)
                wanted[c] += (double)in.level[0][3 * (192 * y + x) + c] *
                             (cos(y * KI_PI / 96) - cos((y + 1) * KI_PI / 96)) / 384;
    static const float roughness[] = {0.3f, 0.6f, 1};
    for (int r = 0; r < 3; r++) {
        enum { ROWS = 512 };
        kiln_prefilter_def def = {.shape = KILN_SHAPE_PANORAMA,
                                  .size = ROWS,
                                  .level_count = 1,
                                  .roughness = &roughness[r]};
        CHECK_OK(kiln_prefilter(context, &in, &def, &out, &error));
        double mean[3] = {0};
        for (int y = 0; y < ROWS; y++) {
            double theta = (y + 0.5) * KI_PI / ROWS, weight = 1;
            for (int k = 1; k < ROWS / 2; k++)
                weight -= 2 * cos(2 * k * theta) / (4.0 * k * k - 1);
            for (int x = 0; x < 2 * ROWS; x++)
                for (int c = 0; c < 3; c++)
                    mean[c] +=
                        weight / ROWS / (2 * ROWS) *
                        (double)out.level[0][3 * ((size_t)y * 2 * ROWS + (size_t)x) + (size_t)c];
        }
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(mean[c] / wanted[c], 1, 2e-6);
        kiln_map_free(&out);
    }
    kiln_map_free(&in);
}

// Rolling the panorama by columns is the same as turning the result.
static void rotation_rotates(void **state)
{
    (void)state;
    kiln_map in = scene_panorama(context, 64, 5), rolled = scene_panorama(context, 64, 5), a, b;
    for (int shift = 1; shift < 128; shift += 38) {
        for (size_t y = 0; y < 64; y++)
            for (size_t x = 0; x < 128; x++)
                memcpy(rolled.level[0] + 3 * (128 * y + x),
                       in.level[0] + 3 * (128 * y + (x + (size_t)shift) % 128), 12);
        kiln_prefilter_def def = {.size = 32, .rotation = shift * 360.0 / 128};
        CHECK_OK(kiln_prefilter(context, &in, &def, &a, &error));
        def.rotation = 0;
        CHECK_OK(kiln_prefilter(context, &rolled, &def, &b, &error));
        for (int l = 0; l < a.level_count; l++)
            CHECK_BELOW(largest_difference(&a, &b, l, 1e-3), 3e-6);
        kiln_map_free(&a);
        kiln_map_free(&b);
    }
    kiln_map_free(&in);
    kiln_map_free(&rolled);
}

// A quarter turn permutes the side faces.
static void quarter_turn_permutes_faces(void **state)
{
    (void)state;
    kiln_map in = scene_panorama(context, 64, 9), a, b;
    kiln_prefilter_def def = {.size = 16};
    CHECK_OK(kiln_prefilter(context, &in, &def, &a, &error));
    def.rotation = 90;
    CHECK_OK(kiln_prefilter(context, &in, &def, &b, &error));
    // u grows by a quarter: what -Z (u = 1/2) shows is what +X (u = 3/4) showed, and so on.
    static const int shown[6] = {4, 5, -1, -1, 1, 0};
    for (int l = 0; l < a.level_count; l++) {
        int n = kiln_map_level_size(&a, l);
        for (int face = 0; face < 6; face++)
            for (int i = 0; shown[face] >= 0 && i < 3 * n * n; i++) {
                double was = (double)a.level[l][3 * n * n * shown[face] + i];
                CHECK_NEAR((double)b.level[l][3 * n * n * face + i], was, 3e-6 * was + 1e-6);
            }
    }
    kiln_map_free(&a);
    kiln_map_free(&b);
    kiln_map_free(&in);
}

static void mirrored_in_is_mirrored_out(void **state)
{
    (void)state;
    kiln_map in = scene_panorama(context, 40, 11), a, b;
    kiln_prefilter_def def = {.size = 16};
    CHECK_OK(kiln_prefilter(context, &in, &def, &a, &error));
    kiln_map_mirror(&in);
    CHECK_OK(kiln_prefilter(context, &in, &def, &b, &error));
    kiln_map_mirror(&b);
    for (int l = 0; l < a.level_count; l++)
        CHECK_BELOW(largest_difference(&a, &b, l, 1e-3), 3e-6);
    kiln_map_free(&a);
    kiln_map_free(&b);
    kiln_map_free(&in);
}

static void alpha_one_is_lambert(void **state)
{
    (void)state;
    static const float one = 1;
    kiln_map in = scene_panorama(context, 64, 1), a, b;
    kiln_prefilter_def def = {.size = 24, .level_count = 1, .roughness = &one};
    CHECK_OK(kiln_prefilter(context, &in, &def, &a, &error));
    def.lobe = KILN_LOBE_LAMBERT;
    CHECK_OK(kiln_prefilter(context, &in, &def, &b, &error));
    CHECK_BELOW(largest_difference(&a, &b, 0, 0), 2e-7);
    kiln_map_free(&a);
    kiln_map_free(&b);
    kiln_map_free(&in);
}

static double gauss_lobe(void *user, double cos_theta)
{
    double width = *(double *)user;
    return exp((cos_theta - 1) / (width * width));
}

// The caller's own lobe.
static void a_custom_lobe_matches_brute_force(void **state)
{
    (void)state;
    kiln_map in = scene_panorama(context, 128, 21);
    double width = 0.3;
    kiln_lobe lobe = kiln_lobe_custom(gauss_lobe, &width, width);
    kiln_spectrum *spectrum;
    kiln_map out;
    CHECK_OK(kiln_spectrum_analyze(context, &in, 0, &spectrum, &error));
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 32, 2, &out, &error));
    CHECK_OK(kiln_spectrum_filter(context, spectrum, &lobe, 33.3, &out, 1, &error));
    scene_errors e = scene_compare(context, &in, &out, 1, &lobe, 33.3, 64);
    CHECK_BELOW(e.rms, 1e-4);
    CHECK_BELOW(e.most, 2e-3);
    // A lobe that is too narrow for a spectrum of degree 256 is refused, not approximated.
    lobe = kiln_lobe_ggx(0.004);
    assert_int_equal(kiln_spectrum_filter(context, spectrum, &lobe, 0, &out, 0, &error),
                     KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "256");
    kiln_spectrum_destroy(spectrum);
    kiln_map_free(&out);
    kiln_map_free(&in);
}

// Coefficients against the sum over texels, each cut in 48 x 48.
static void sh_matches_brute_force(void **state)
{
    (void)state;
    enum { SIZE = 24, CUT = 48 };
    kiln_map in = scene_panorama(context, SIZE, 6);
    kiln_spectrum *spectrum;
    kiln_sh sh;
    CHECK_OK(kiln_spectrum_analyze(context, &in, 0, &spectrum, &error));
    CHECK_OK(kiln_spectrum_sh(spectrum, 5, false, 0, 0, &sh, &error));
    double wanted[25][3] = {{0}};
    for (int y = 0; y < SIZE * CUT; y++)
        for (int x = 0; x < 2 * SIZE * CUT; x++) {
            int texel = 2 * SIZE * (y / CUT) + x / CUT;
            const float *rgb = in.level[0] + 3 * (size_t)texel;
            double step = KI_PI / (SIZE * CUT), theta = (y + 0.5) * step, phi = (x + 0.5) * step;
            double area = step * (cos(y * step) - cos((y + 1) * step));
            double d[3] = {-sin(theta) * sin(phi), cos(theta), sin(theta) * cos(phi)};
            double basis[25];
            ki_sh_basis(d, basis);
            for (int k = 0; k < 25; k++)
                for (int c = 0; c < 3; c++)
                    wanted[k][c] += basis[k] * area * (double)rgb[c];
        }
    for (int k = 0; k < 25; k++)
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(sh.c[k][c], wanted[k][c], 2e-5 * wanted[0][c]);

    // Radiance to irradiance, and Hanning's window, band by band.
    static const double lobe[] = {3.14159265358979, 2.0943951023932, 0.785398163397448, 0,
                                  -0.130899693899575};
    kiln_sh irradiance, windowed;
    CHECK_OK(kiln_spectrum_sh(spectrum, 5, true, 0, 0, &irradiance, &error));
    CHECK_OK(kiln_spectrum_sh(spectrum, 5, false, 3, 0, &windowed, &error));
    for (int l = 0, k = 0; l < 5; l++)
        for (; k < (l + 1) * (l + 1); k++)
            for (int c = 0; c < 3; c++) {
                CHECK_NEAR(irradiance.c[k][c], sh.c[k][c] * lobe[l], 1e-11 * fabs(sh.c[k][c]));
                CHECK_NEAR(windowed.c[k][c], l < 3 ? sh.c[k][c] * (1 + cos(KI_PI * l / 3)) / 2 : 0,
                           1e-11 * fabs(sh.c[k][c]));
            }
    // Turned: the series in d is the unturned one in the turned direction.
    kiln_sh turned;
    CHECK_OK(kiln_spectrum_sh(spectrum, 5, false, 0, 90, &turned, &error));
    double a[3], b[3];
    kiln_sh_evaluate(&turned, (double[3]){0.48, 0.6, -0.64}, a);
    kiln_sh_evaluate(&sh, (double[3]){0.64, 0.6, 0.48}, b); // -Z shows what +X did
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(a[c], b[c], 1e-9 * fabs(b[c]));
    kiln_spectrum_destroy(spectrum);
    kiln_map_free(&in);
}

static void power_is_that_of_the_environment(void **state)
{
    (void)state;
    kiln_map in = scene_panorama(context, 48, 8);
    kiln_spectrum *spectrum;
    kiln_sh sh;
    CHECK_OK(kiln_spectrum_analyze(context, &in, 64, &spectrum, &error));
    assert_int_equal(kiln_spectrum_degree(spectrum), 64);
    static double power[65][3];
    CHECK_OK(kiln_spectrum_power(spectrum, power, &error));
    CHECK_OK(kiln_spectrum_sh(spectrum, 5, false, 0, 0, &sh, &error));
    for (int l = 0, k = 0; l < 5; l++) {
        double sum = 0;
        for (; k < (l + 1) * (l + 1); k++)
            sum += sh.c[k][1] * sh.c[k][1];
        CHECK_NEAR(sum / power[l][1], 1, 1e-6);
    }
    kiln_spectrum_destroy(spectrum);
    kiln_map_free(&in);
}

// A sun on black: above its degree a spectrum has the power of the sun, which a spectrum of that
// degree has.
static void suns_have_power_above_the_degree(void **state)
{
    (void)state;
    kiln_map in = make_panorama(context, 48);
    for (int c = 0; c < 3; c++)
        texel_at(&in, 31, 13)[c] = 1e5F * (float)(c + 1);
    kiln_spectrum *low, *high;
    CHECK_OK(kiln_spectrum_analyze(context, &in, 40, &low, &error));
    CHECK_OK(kiln_spectrum_analyze(context, &in, 96, &high, &error));
    static double calm[2][97][3], all[2][97][3];
    CHECK_OK(ki_spectrum_power(low, 96, calm[0], all[0], &error));
    CHECK_OK(ki_spectrum_power(high, 96, calm[1], all[1], &error));
    double solid = 2 * pi / 96 * 2 * sin(pi * 13.5 / 48) * sin(pi / 96);
    CHECK_NEAR(all[0][0][1] / (4 * pi * pow(2e5 * solid / (4 * pi), 2)), 1, 1e-6);
    for (int l = 0; l <= 96; l++)
        for (int c = 0; c < 3; c++) {
            CHECK_NEAR(all[0][l][c] / all[1][l][c], 1, 1e-9);
            assert_true(calm[0][l][c] <= 1e-12 * all[0][l][c]);
        }
    kiln_spectrum_destroy(low);
    kiln_spectrum_destroy(high);
    kiln_map_free(&in);
}

static void bad_arguments_give_sentences(void **state)
{
    (void)state;
    kiln_map in = scene_panorama(context, 8, 1), out;
    static const float wild = 1.5f;
    kiln_prefilter_def defs[] = {{.size = -1},
                                 {.size = 40000},
                                 {.size = 16, .level_count = 9},
                                 {.size = 16, .level_count = 1, .roughness = &wild},
                                 {.size = 16, .lobe = KILN_LOBE_CUSTOM},
                                 {.size = 16, .rotation = HUGE_VAL}};
    for (size_t i = 0; i < sizeof defs / sizeof *defs; i++) {
        assert_int_equal(kiln_prefilter(context, &in, &defs[i], &out, &error), KILN_ERROR_ARGUMENT);
        assert_true(strlen(error.message) > 10);
        assert_null(out.level[0]);
    }
    kiln_map_free(&in);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_furnace_stays_white),
        cmocka_unit_test(every_level_keeps_the_mean),
        cmocka_unit_test(rotation_rotates),
        cmocka_unit_test(quarter_turn_permutes_faces),
        cmocka_unit_test(mirrored_in_is_mirrored_out),
        cmocka_unit_test(alpha_one_is_lambert),
        cmocka_unit_test(a_custom_lobe_matches_brute_force),
        cmocka_unit_test(sh_matches_brute_force),
        cmocka_unit_test(power_is_that_of_the_environment),
        cmocka_unit_test(suns_have_power_above_the_degree),
        cmocka_unit_test(bad_arguments_give_sentences),
    };
    return cmocka_run_group_tests_name("sphere laws", tests, set_up, tear_down);
}

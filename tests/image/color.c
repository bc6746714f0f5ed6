// Conversion of colours to Rec. 709: published matrices, whites, and primaries that are none.
#include "kit/kit.h"
#include "kit/random.h"

#include "image/color.h"

#include <float.h>

static const ki_primaries acescg = {{0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767}};

static void check_matrix(const ki_matrix3 *a, const ki_matrix3 *wanted, double bound)
{
    for (int i = 0; i < 9; i++)
        CHECK_NEAR(a->m[i / 3][i % 3], wanted->m[i / 3][i % 3], bound);
}

// The matrices of the literature, to the digits in which they are printed: ACEScg to Rec. 709 with
// the Bradford transform, Rec. 2020 to Rec. 709 of ITU-R BT.2407, and XYZ to sRGB of IEC 61966-2-1.
static void published_matrices(void **unused)
{
    static const ki_matrix3 from_acescg = {{{1.70505, -0.62179, -0.08326},
                                            {-0.13026, 1.14080, -0.01055},
                                            {-0.02400, -0.12897, 1.15297}}};
    static const ki_matrix3 from_rec2020 = {
        {{1.6605, -0.5876, -0.0728}, {-0.1246, 1.1329, -0.0083}, {-0.0182, -0.1006, 1.1187}}};
    static const ki_matrix3 from_xyz = {
        {{3.2410, -1.5374, -0.4986}, {-0.9692, 1.8760, 0.0416}, {0.0556, -0.2040, 1.0570}}};
    // the columns rXYZ, gXYZ and bXYZ of the ICC profile of sRGB, which are relative to D50
    static const ki_matrix3 srgb_profile = {
        {{0.4360, 0.3851, 0.1431}, {0.2225, 0.7169, 0.0606}, {0.0139, 0.0971, 0.7141}}};
    static const ki_matrix3 one = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    ki_matrix3 a;
    (void)unused;
    assert_true(ki_rec709_from_rgb(&acescg, NULL, &a));
    check_matrix(&a, &from_acescg, 2e-5);
    assert_true(ki_rec709_from_rgb(&ki_rec2020, NULL, &a));
    check_matrix(&a, &from_rec2020, 6e-5);
    assert_true(ki_rec709_from_xyz(ki_rec709.xy + 6, &a));
    check_matrix(&a, &from_xyz, 3e-4);
    assert_true(ki_rec709_from_xyz(ki_white_d50, &a));
    a = ki_matrix_multiply(&a, &srgb_profile);
    check_matrix(&a, &one, 5e-4);
}

// Rec. 709 itself, also as rounded by a file, is left alone to the last bit.
static void rec709_is_the_identity(void **unused)
{
    static const ki_matrix3 one = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    ki_primaries rounded = ki_rec709;
    ki_matrix3 a;
    (void)unused;
    assert_true(ki_rec709_from_rgb(&ki_rec709, NULL, &a));
    check_matrix(&a, &one, 0);
    for (int i = 0; i < 8; i++)
        rounded.xy[i] = (double)(float)rounded.xy[i] + (i % 2 ? 1e-4 : -1e-4);
    assert_true(ki_rec709_from_rgb(&rounded, rounded.xy + 6, &a));
    check_matrix(&a, &one, 0);
    // The tolerance is not wide enough to hide a conversion: the next step is not the identity.
    rounded.xy[0] = 0.65;
    assert_true(ki_rec709_from_rgb(&rounded, NULL, &a));
    assert_true(fabs(a.m[1][0]) > 1e-3);
}

// White stays white, whatever its chromaticity, and another neutral colour takes its place.
static void whites_are_adapted(void **unused)
{
    static const ki_primaries equal = {{0.64, 0.33, 0.29, 0.60, 0.15, 0.06, 1.0 / 3, 1.0 / 3}};
    const ki_primaries *all[] = {&acescg, &ki_rec2020, &ki_p3_d65, &equal};
    ki_matrix3 a;
    (void)unused;
    for (int p = 0; p < 4; p++) {
        assert_true(ki_rec709_from_rgb(all[p], NULL, &a));
        for (int i = 0; i < 3; i++)
            CHECK_NEAR(a.m[i][0] + a.m[i][1] + a.m[i][2], 1, 1e-14);
    }
    // A red that is named as neutral comes out with three equal channels.
    const double neutral[2] = {0.45, 0.35};
    double xyz[3] = {neutral[0] / neutral[1], 1, 0.2 / neutral[1]}, out[3];
    assert_true(ki_rec709_from_xyz(neutral, &a));
    for (int i = 0; i < 3; i++) {
        out[i] = a.m[i][0] * xyz[0] + a.m[i][1] * xyz[1] + a.m[i][2] * xyz[2];
        CHECK_NEAR(out[i], 1, 1e-13);
    }
    // With the white of the primaries as the neutral colour nothing changes.
    ki_matrix3 same;
    assert_true(ki_rec709_from_rgb(&acescg, NULL, &a));
    assert_true(ki_rec709_from_rgb(&acescg, acescg.xy + 6, &same));
    check_matrix(&a, &same, 0);
}

static void what_is_no_set_of_primaries_is_refused(void **unused)
{
    static const ki_primaries bad[] = {
        {{0}},
        {{0.3, 0.3, 0.4, 0.4, 0.5, 0.5, 0.4, 0.4}},            // on one line
        {{0.64, 0.33, 0.64, 0.33, 0.15, 0.06, 0.3127, 0.329}}, // two alike
        {{0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.7, 0.29}},     // white outside
        {{0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0}},     // white without luminance
        {{(double)NAN, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.329}},
        {{0.64, 0.33, 0.30, (double)INFINITY, 0.15, 0.06, 0.3127, 0.329}},
    };
    static const double bad_whites[][2] = {
        {0.3, 0}, {(double)NAN, 0.3}, {0.3, -1}, {(double)INFINITY, 0.3}};
    ki_matrix3 a;
    (void)unused;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        a.m[1][1] = 7;
        assert_false(ki_rec709_from_rgb(&bad[i], NULL, &a));
        assert_true(a.m[1][1] == 0);
    }
    for (size_t i = 0; i < sizeof bad_whites / sizeof *bad_whites; i++) {
        assert_false(ki_rec709_from_xyz(bad_whites[i], &a));
        assert_false(ki_rec709_from_rgb(&ki_rec2020, bad_whites[i], &a));
    }
}

// A picture is converted texel by texel; a texel with a value that is not finite is left for the
// loader, which counts and replaces such values.
static void pictures_are_converted(void **unused)
{
    float pixels[4 * 3] = {1, 1, 1, 0.5F, 0.25F, 0.125F, INFINITY, 1, 2, NAN, 1, 2};
    kiln_image image = {2, 2, 3, pixels, NULL};
    ki_matrix3 a;
    kiln_context *context;
    kiln_error error;
    (void)unused;
    CHECK_OK(kiln_context_create(NULL, &context, &error));
    assert_true(ki_rec709_from_rgb(&acescg, NULL, &a));
    assert_true(ki_image_transform(context, &a, &image));
    for (int c = 0; c < 3; c++) {
        CHECK_NEAR((double)pixels[c], 1, 1e-7);
        CHECK_NEAR((double)pixels[3 + c], a.m[c][0] / 2 + a.m[c][1] / 4 + a.m[c][2] / 8, 1e-7);
    }
    assert_true(isinf(pixels[6]) && pixels[7] == 1 && pixels[8] == 2);
    assert_true(isnan(pixels[9]) && pixels[10] == 1 && pixels[11] == 2);
    kiln_context_destroy(context);
}

// Rows of 150 texels have 18 groups of eight that the library multiplies at once, and a rest. Every
// texel has the bits of the three sums in double precision, also next to texels with a channel that
// is infinite or not a number, which stay, and to products beyond the largest float, which become
// it.
static void every_texel_has_the_bits_of_its_sums(void **unused)
{
    enum { WIDTH = 150, HEIGHT = 4, COUNT = WIDTH * HEIGHT };
    static float pixels[3 * COUNT], before[3 * COUNT];
    kiln_image image = {WIDTH, HEIGHT, 3, pixels, NULL};
    uint64_t random = 5;
    ki_matrix3 a;
    kiln_context *context;
    kiln_error error;
    int clamped = 0;
    (void)unused;
    for (int i = 0; i < 3 * COUNT; i++)
        pixels[i] = (float)random_between(&random, -1, 9);
    pixels[3 * (WIDTH + 5) + 2] = INFINITY;
    pixels[3 * (2 * WIDTH - 1)] = -INFINITY;
    pixels[3 * (2 * WIDTH + 127) + 1] = NAN;
    pixels[3 * (3 * WIDTH + 64)] = FLT_MAX;
    pixels[3 * (3 * WIDTH + 149)] = -FLT_MAX;
    memcpy(before, pixels, sizeof before);
    CHECK_OK(kiln_context_create(NULL, &context, &error));
    assert_true(ki_rec709_from_rgb(&acescg, NULL, &a));
    assert_true(ki_image_transform(context, &a, &image));
    for (int i = 0; i < COUNT; i++) {
        const float *in = before + 3 * i, *out = pixels + 3 * i;
        if (!isfinite(in[0]) || !isfinite(in[1]) || !isfinite(in[2])) {
            assert_memory_equal(out, in, 3 * sizeof *out);
            continue;
        }
        for (int c = 0; c < 3; c++) {
            double sum =
                a.m[c][0] * (double)in[0] + a.m[c][1] * (double)in[1] + a.m[c][2] * (double)in[2];
            double most = (double)FLT_MAX, wanted = sum > most ? most : sum < -most ? -most : sum;
            clamped += wanted != sum;
            assert_true(out[c] == (float)wanted);
        }
    }
    assert_int_equal(clamped, 2);
    kiln_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(published_matrices),
        cmocka_unit_test(rec709_is_the_identity),
        cmocka_unit_test(whites_are_adapted),
        cmocka_unit_test(what_is_no_set_of_primaries_is_refused),
        cmocka_unit_test(pictures_are_converted),
        cmocka_unit_test(every_texel_has_the_bits_of_its_sums),
    };
    return cmocka_run_group_tests_name("color", tests, NULL, NULL);
}

// The assignment's methods estimate the integrals that they are meant to, and err where
// docs/theory/assignment.md says that they do.
#include <kiln/course.h>

#include "kit/context.h"

static kiln_image make(kiln_assignment_method method, const kiln_assignment_def *def)
{
    kiln_image table;
    CHECK_OK(kiln_assignment_energy(context, method, def, &table, &error));
    return table;
}

static kiln_image make_exact(int size, kiln_assignment_g g)
{
    kiln_table table;
    kiln_table_def def = {
        .model = {.g = kiln_assignment_masking(g)}, .width = size, .height = size, .flip = true};
    CHECK_OK(kiln_table_create(context, &def, &table, &error));
    return table.image;
}

static kiln_difference compare(const kiln_image *table, const kiln_image *exact)
{
    kiln_difference difference;
    CHECK_OK(kiln_assignment_compare(context, table, exact, &difference, NULL, &error));
    return difference;
}

static double row_mean(const kiln_image *table, int row)
{
    double sum = 0;
    for (int x = 0; x < table->width; x++)
        sum += (double)table->pixels[row * table->width + x];
    return sum / table->width;
}

// What every error is measured against, to the ten digits known beforehand.
static void exact_is_exact(void **state)
{
    (void)state;
    static const double wanted[][4] = {// roughness, mu, k of the text, k of the figures
                                       {.05, .01, .0060856150, .7928232340},
                                       {.25, .1, .1963985825, .6823584692},
                                       {.5, .5, .5852642069, .7470809150},
                                       {.75, .5, .5080071844, .5799818067},
                                       {1, .1, .5579142172, .5579142172}};
    static const double average[][3] = {{.25, .7832275764, .9453994702},
                                        {.5, .6798469390, .8017224932},
                                        {1, .3766346112, .3766346112}};
    kiln_model text = {.g = KILN_G_SCHLICK_TEXT}, figures = {.g = KILN_G_SCHLICK_K2};
    for (int i = 0; i < 5; i++) {
        CHECK_NEAR(kiln_energy(&text, wanted[i][0], wanted[i][1]), wanted[i][2], 6e-11);
        CHECK_NEAR(kiln_energy(&figures, wanted[i][0], wanted[i][1]), wanted[i][3], 6e-11);
    }
    for (int i = 0; i < 3; i++) {
        CHECK_NEAR(kiln_energy_average(&text, average[i][0]), average[i][1], 6e-11);
        CHECK_NEAR(kiln_energy_average(&figures, average[i][0]), average[i][2], 6e-11);
    }
    CHECK_NEAR(kiln_energy(&figures, 1, 1), 1 - log(2), 1e-12);
    CHECK_NEAR(kiln_energy_average(&text, 1), 4 * (1 - log(2)) * (1 - log(2)), 1e-12);
    // A mirror loses nothing but by the k of the text.
    CHECK_NEAR(kiln_energy_average(&figures, 0), 1, 1e-12);
    CHECK_NEAR(kiln_energy_average(&text, 0), 0.84569, 1e-5);
}

// Random points err by the root of their number: a fourth at 16 times as many. Hammersley's err
// less, by N^-0.68 (Smith's G) to N^-0.87 (the text's), though the worst texel, at grazing angles,
// by the root too.
static void importance_converges(void **state)
{
    (void)state;
    enum { SIZE = 16, STEPS = 3 };
    for (int g = 0; g <= KILN_ASSIGNMENT_G_UNCORRELATED; g++) {
        kiln_image exact = make_exact(SIZE, (kiln_assignment_g)g);
        double rms[STEPS], max[STEPS];
        for (int k = 0; k < STEPS; k++) {
            kiln_assignment_def def = {
                .size = SIZE, .sample_count = 64 << (4 * k), .g = (kiln_assignment_g)g};
            kiln_image table = make(KILN_ASSIGNMENT_IMPORTANCE, &def);
            kiln_difference difference = compare(&table, &exact);
            rms[k] = difference.rms;
            max[k] = difference.max;
            kiln_image_free(&table);
        }
        for (int k = 1; k < STEPS; k++) {
            CHECK_BELOW(rms[k], rms[k - 1] / 4.5);
            CHECK_BELOW(max[k], max[k - 1] / 4);
        }
        CHECK_BELOW(rms[STEPS - 1], 5e-4);
        kiln_image_free(&exact);
    }
}

// The assignment's own: 128 x 128, 1024 samples.
static void default_errs_as_documented(void **state)
{
    (void)state;
    static const double bounds[2][2] = {{0.011, 0.0015}, {0.0031, 0.00073}};
    for (int i = 0; i < 2; i++) {
        kiln_assignment_g g = i ? KILN_ASSIGNMENT_G_TEXT : KILN_ASSIGNMENT_G_FIGURES;
        kiln_assignment_def def = {.g = g};
        kiln_image exact = make_exact(128, g), table = make(KILN_ASSIGNMENT_IMPORTANCE, &def);
        assert_int_equal(table.width, 128);
        assert_int_equal(table.height, 128);
        assert_int_equal(table.channels, 1);
        CHECK_BELOW(compare(&table, &exact).max, bounds[i][0]);
        CHECK_BELOW(compare(&table, &exact).rms, bounds[i][1]);
        kiln_image_free(&table);
        kiln_image_free(&exact);
    }
}

// Bonus 2 is bonus 1 in two sums.
static void split_sum_adds_up(void **state)
{
    (void)state;
    for (int g = 0; g <= KILN_ASSIGNMENT_G_UNCORRELATED; g++) {
        kiln_assignment_def def = {.size = 32, .g = (kiln_assignment_g)g};
        kiln_image e = make(KILN_ASSIGNMENT_IMPORTANCE, &def);
        kiln_image ab = make(KILN_ASSIGNMENT_SPLIT_SUM, &def);
        CHECK_BELOW(compare(&ab, &e).max, 1e-6);
        kiln_image_free(&ab);
        kiln_image_free(&e);
    }
}

// Over independent runs the mean is the integral, within the standard error that the runs show.
// Below roughness 0.3 a rare hit holds so much that a few runs show nothing of the kind.
static void monte_carlo_is_unbiased(void **state)
{
    (void)state;
    enum { SIZE = 10, RUNS = 100, ROWS = 7 };
    for (int g = KILN_ASSIGNMENT_G_FIGURES; g <= KILN_ASSIGNMENT_G_TEXT; g++) {
        kiln_image exact = make_exact(SIZE, (kiln_assignment_g)g);
        double sum[SIZE * SIZE] = {0}, square[SIZE * SIZE] = {0}, z2 = 0;
        for (int run = 0; run < RUNS; run++) {
            kiln_assignment_def def = {.size = SIZE,
                                       .sample_count = 256,
                                       .g = (kiln_assignment_g)g,
                                       .unclamped = true,
                                       .seed = (uint64_t)run << 32};
            kiln_image table = make(KILN_ASSIGNMENT_MONTE_CARLO, &def);
            for (int i = 0; i < SIZE * SIZE; i++) {
                double off = (double)table.pixels[i] - (double)exact.pixels[i];
                sum[i] += off;
                square[i] += off * off;
            }
            kiln_image_free(&table);
        }
        for (int i = 0; i < ROWS * SIZE; i++) {
            double mean = sum[i] / RUNS, variance = (square[i] / RUNS - mean * mean) / (RUNS - 1);
            assert_true(variance > 0);
            CHECK_BELOW(fabs(mean), 4 * sqrt(variance));
            z2 += mean * mean / variance / (ROWS * SIZE);
        }
        // 70 texels: the mean square of their deviations is 1 +- 0.17.
        CHECK_NEAR(z2, 1, 0.5);
        kiln_image_free(&exact);
    }
}

// The strata do what they are for: less noise than as many independent samples would have, whose
// variance is that of the integrand.
static void strata_lower_the_noise(void **state)
{
    (void)state;
    enum { SIZE = 4, RUNS = 200, SAMPLES = 64 };
    double variance[2] = {0};
    for (int run = 0; run < 2 * RUNS; run++) {
        // One sample a run has one stratum.
        int samples = run % 2 ? SAMPLES : 1;
        kiln_assignment_def def = {
            .size = SIZE, .sample_count = samples, .seed = (uint64_t)run << 32};
        kiln_image table = make(KILN_ASSIGNMENT_MONTE_CARLO, &def);
        double off = (double)table.pixels[SIZE - 1] -
                     kiln_energy(&(kiln_model){.g = KILN_G_SCHLICK_K2}, 0.875, 0.875);
        variance[run % 2] += off * off / RUNS;
        kiln_image_free(&table);
    }
    CHECK_BELOW(variance[1], variance[0] / SAMPLES / 4);
}

static void clamp_darkens_low_roughness_only(void **state)
{
    (void)state;
    enum { SIZE = 64 };
    kiln_assignment_def def = {.size = SIZE};
    kiln_image clamped = make(KILN_ASSIGNMENT_MONTE_CARLO, &def);
    def.unclamped = true;
    kiln_image free_ = make(KILN_ASSIGNMENT_MONTE_CARLO, &def);
    int lower = 0;
    for (int row = 0; row < SIZE; row++) {
        double roughness = (SIZE - row - 0.5) / SIZE;
        bool reached = pi * pow(roughness, 8) < 1e-4; // D's denominator at its peak
        for (int i = row * SIZE; i < (row + 1) * SIZE; i++) {
            if (!reached)
                assert_true(clamped.pixels[i] == free_.pixels[i]);
            assert_true(clamped.pixels[i] <= free_.pixels[i]);
            lower += clamped.pixels[i] < free_.pixels[i];
        }
    }
    assert_true(lower > 10 * SIZE);
    kiln_image_free(&free_);
    kiln_image_free(&clamped);
}

// More samples make the noise go, the band stays.
static void band_is_no_noise(void **state)
{
    (void)state;
    enum { SIZE = 16, ROW = SIZE - 3 }; // roughness 0.156
    kiln_assignment_def def = {.size = SIZE, .sample_count = 32768};
    kiln_image exact = make_exact(SIZE, KILN_ASSIGNMENT_G_FIGURES);
    kiln_image clamped = make(KILN_ASSIGNMENT_MONTE_CARLO, &def);
    def.unclamped = true;
    kiln_image free_ = make(KILN_ASSIGNMENT_MONTE_CARLO, &def);
    CHECK_NEAR(row_mean(&free_, ROW), row_mean(&exact, ROW), 0.05);
    CHECK_NEAR(row_mean(&clamped, ROW), 0.192, 0.005);
    CHECK_BELOW(row_mean(&clamped, SIZE - 1), 0.001);
    kiln_image_free(&free_);
    kiln_image_free(&clamped);
    kiln_image_free(&exact);
}

static void threads_do_not_matter(void **state)
{
    (void)state;
    kiln_context *other = make_context(5);
    for (int m = KILN_ASSIGNMENT_MONTE_CARLO; m <= KILN_ASSIGNMENT_SPLIT_SUM; m++) {
        kiln_assignment_def def = {.size = 33, .sample_count = 100};
        kiln_image a = make((kiln_assignment_method)m, &def), b;
        CHECK_OK(kiln_assignment_energy(other, (kiln_assignment_method)m, &def, &b, &error));
        assert_memory_equal(a.pixels, b.pixels, sizeof(float) * 33 * 33);
        kiln_image_free(&b);
        kiln_image_free(&a);
    }
    kiln_context_destroy(other);
}

static void refuse(kiln_assignment_method method, const kiln_assignment_def *def, const char *words)
{
    kiln_image table = {.width = 7};
    assert_int_equal(kiln_assignment_energy(context, method, def, &table, &error),
                     KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, words);
    assert_null(table.pixels);
    assert_int_equal(table.width, 0);
}

static void wrong_arguments_are_sentences(void **state)
{
    (void)state;
    refuse(KILN_ASSIGNMENT_IMPORTANCE, &(kiln_assignment_def){.size = 1}, "2 to 1024");
    refuse(KILN_ASSIGNMENT_IMPORTANCE, &(kiln_assignment_def){.size = 1025}, "is 1025");
    refuse(KILN_ASSIGNMENT_IMPORTANCE, &(kiln_assignment_def){.sample_count = -1}, "is -1");
    refuse(KILN_ASSIGNMENT_IMPORTANCE, &(kiln_assignment_def){.sample_count = 1 << 21}, "1048576");
    refuse(KILN_ASSIGNMENT_IMPORTANCE, &(kiln_assignment_def){.g = (kiln_assignment_g)4}, "is 4");
    refuse((kiln_assignment_method)3, NULL, "method is 3");

    kiln_image a, b, average;
    kiln_difference d;
    CHECK_OK(kiln_image_create(context, 2, 3, 1, &a, &error));
    CHECK_OK(kiln_image_create(context, 2, 2, 1, &b, &error));
    assert_int_equal(kiln_assignment_compare(context, &a, &b, &d, NULL, &error),
                     KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "2 x 3");
    a.channels = 3;
    assert_int_equal(kiln_assignment_average(context, &a, &average, &error), KILN_ERROR_ARGUMENT);
    assert_null(average.pixels);
    a.channels = 1;
    kiln_image_free(&a);
    kiln_image_free(&b);
}

// Memory that runs out and work that is stopped leave nothing.
static void failing_leaves_nothing(void **state)
{
    (void)state;
    kiln_assignment_def def = {.size = 64, .sample_count = 16};
    int refused = 0;
    for (int count = 1; count < 100; count++) {
        failing f;
        kiln_context *small = failing_context(&f);
        kiln_image table = {0};
        f.fail_at = f.calls + count;
        f.and_later = true;
        kiln_result result =
            kiln_assignment_energy(small, KILN_ASSIGNMENT_IMPORTANCE, &def, &table, &error);
        if (result) {
            assert_int_equal(result, KILN_ERROR_MEMORY);
            assert_null(table.pixels);
            refused++;
        }
        size_t held, peak;
        kiln_image_free(&table);
        kiln_context_memory(small, &held, &peak);
        assert_int_equal(held, 0);
        kiln_context_destroy(small);
        if (!result)
            break;
    }
    assert_true(refused >= 2);

    countdown c = {.left = 2};
    kiln_context *stopped = NULL;
    kiln_image table;
    CHECK_OK(kiln_context_create(
        &(kiln_context_def){.progress = count_down, .progress_user = &c, .thread_count = 1},
        &stopped, &error));
    assert_int_equal(
        kiln_assignment_energy(stopped, KILN_ASSIGNMENT_IMPORTANCE, &def, &table, &error),
        KILN_ERROR_CANCELLED);
    assert_null(table.pixels);
    kiln_context_destroy(stopped);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_is_exact),
        cmocka_unit_test(importance_converges),
        cmocka_unit_test(default_errs_as_documented),
        cmocka_unit_test(split_sum_adds_up),
        cmocka_unit_test(monte_carlo_is_unbiased),
        cmocka_unit_test(strata_lower_the_noise),
        cmocka_unit_test(clamp_darkens_low_roughness_only),
        cmocka_unit_test(band_is_no_noise),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(wrong_arguments_are_sentences),
        cmocka_unit_test(failing_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}

// kiln_check_sh on coefficients that kiln computed, as they are or with one planted fault each.
#include "engine/engine.h"

#include <kiln/check.h>

#include "blobs.h"

static kiln_map scene;
static kiln_sh exact;

static int begin(void **state)
{
    int failed = set_up(state);
    scene = blobs(false);
    return failed || kiln_map_sh(context, &scene, 5, 0, &exact, &error) != KILN_OK;
}

static int end(void **state)
{
    kiln_map_free(&scene);
    return tear_down(state);
}

static kiln_check_sh_report checked(const kiln_sh *sh, const char *engine)
{
    kiln_check_sh_report report;
    CHECK_OK(kiln_check_sh(context, &scene, sh, engine ? kiln_engine_find(engine) : NULL, &report,
                           &error));
    assert_int_equal(report.bands, sh->bands);
    return report;
}

static kiln_sh made(int bands, bool irradiance, double window)
{
    kiln_sh sh;
    CHECK_OK(kiln_sh_filter(&exact, bands, irradiance, window, &sh, &error));
    return sh;
}

// Checks that a report says `words` and no more than that beside the axes.
static void expect(const kiln_check_sh_report *report, const char *words, bool fault)
{
    const kiln_finding *last = &report->findings.finding[report->findings.count - 1];
    assert_in_range(report->findings.count, 1, 2);
    CHECK_SAYS(last->text, words);
    assert_int_equal(last->fault, fault);
    assert_int_equal(report->findings.fault_count, fault);
}

static void right_harmonics_are_right(void **state)
{
    (void)state;
    for (int bands = 1; bands <= KILN_MAX_BANDS; bands++)
        for (int way = 0; way < 3; way++) {
            kiln_sh sh = made(bands, way == 1, way == 2 ? 4 : 0);
            kiln_check_sh_report report = checked(&sh, "gltf");
            CHECK_BELOW(report.rms, 1e-9);
            assert_int_equal(report.findings.count, 0);
            for (int l = 0; l < bands && way == 0; l++)
                CHECK_NEAR(report.band[l], 1, 1e-9);
        }
}

static void axes_of_engines_are_right(void **state)
{
    (void)state;
    static const char *const names[] = {"three", "filament", "babylon"};
    kiln_sh sh = made(3, false, 0), turned;
    for (int i = 0; i < 3; i++) {
        ki_turn_sh(&sh, &ki_recipe_of(kiln_engine_find(names[i]))->axes, &turned);
        kiln_check_sh_report report = checked(&turned, names[i]);
        CHECK_BELOW(report.rms, 1e-9);
        assert_int_equal(report.findings.count, 0);
        report = checked(&turned, NULL);
        expect(&report, names[i], false);
    }
}

static void turns_are_named(void **state)
{
    (void)state;
    static const struct {
        ki_axes axes;
        const char *words;
    } rows[] = {{{{0, 1, 2}, {-1, 1, 1}}, "mirrored: left and right are swapped"},
                {{{2, 1, 0}, {1, 1, -1}}, "turned by 270 degrees about +Y"},
                {{{0, 1, 2}, {1, -1, 1}}, "upside down"},
                {{{0, 1, 2}, {-1, -1, 1}}, "Condon-Shortley"}};
    kiln_sh sh = made(3, false, 0), turned;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        ki_turn_sh(&sh, &rows[i].axes, &turned);
        kiln_check_sh_report report = checked(&turned, "gltf");
        expect(&report, rows[i].words, true);
    }
    // The sign (-1)^m itself, coefficient by coefficient.
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            sh.c[i][c] *= i == 1 || i == 3 || i == 5 || i == 7 ? -1 : 1;
    kiln_check_sh_report report = checked(&sh, "gltf");
    expect(&report, "Condon-Shortley", true);
}

static void multiply_bands(kiln_sh *sh, double one, double two)
{
    for (int i = 1; i < 9; i++)
        for (int c = 0; c < 3; c++)
            sh->c[i][c] *= i < 4 ? one : two;
}

static void weights_are_named(void **state)
{
    (void)state;
    kiln_sh twice = made(3, true, 0), radiance = made(3, false, 0), irradiance = made(3, true, 0);
    multiply_bands(&twice, 2.0 / 3, 0.25);
    kiln_check_sh_report report = checked(&twice, "gltf");
    expect(&report, "doubly weighted by the cosine lobe", true);
    radiance.irradiance = true;
    report = checked(&radiance, "gltf");
    expect(&report, "those of radiance, not of irradiance", true);
    irradiance.irradiance = false;
    report = checked(&irradiance, "gltf");
    expect(&report, "those of irradiance, not of radiance", true);
    CHECK_NEAR(report.band[1], 2 * pi / 3, 1e-9);
    multiply_bands(&irradiance, 0.7, 1.9);
    report = checked(&irradiance, "gltf");
    expect(&report, "unknown weights: band 1 is 0.4667 and band 2 is 0.475", true);
}

static void windows_are_named(void **state)
{
    (void)state;
    for (int irradiance = 0; irradiance < 2; irradiance++) {
        kiln_sh sh = made(3, irradiance, 4);
        sh.window = 0;
        kiln_check_sh_report report = checked(&sh, "gltf");
        expect(&report,
               "band 1 is reduced by 14.6 % and band 2 by 50 %, as by a Hanning window of width 4",
               false);
        CHECK_BELOW(0.03, report.rms);
    }
    // cmgen's window, sinc^4 of width 6.
    kiln_sh sh = made(3, false, 0);
    double one = sin(pi / 6) / (pi / 6), two = sin(pi / 3) / (pi / 3);
    multiply_bands(&sh, pow(one, 4), pow(two, 4));
    kiln_check_sh_report report = checked(&sh, "gltf");
    expect(&report, "sinc^4 window of width 6", false);
}

static void scales_are_named(void **state)
{
    (void)state;
    static const struct {
        double factor;
        const char *words;
    } rows[] = {
        {pi, "pi times too large"}, {1 / pi, "pi times too small"}, {1.5, "multiplied by 1.5"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        kiln_sh sh = made(3, false, 0);
        for (int i = 0; i < 9; i++)
            for (int c = 0; c < 3; c++)
                sh.c[i][c] *= rows[k].factor;
        kiln_check_sh_report report = checked(&sh, "gltf");
        expect(&report, rows[k].words, true);
    }
}

static void constants_are_named(void **state)
{
    (void)state;
    static const double k[9] = {0.282095, 0.488603, 0.488603, 0.488603, 1.092548,
                                1.092548, 0.315392, 1.092548, 0.546274};
    kiln_sh sh = made(3, false, 0);
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            sh.c[i][c] *= k[i];
    kiln_check_sh_report report = checked(&sh, "gltf");
    expect(&report, "multiplied by the constants of the basis functions", true);
}

static void arguments_are_checked(void **state)
{
    (void)state;
    kiln_check_sh_report report;
    kiln_sh sh = made(3, false, 0);
    sh.c[4][1] = NAN;
    assert_int_equal(kiln_check_sh(context, &scene, &sh, NULL, &report, &error),
                     KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "coefficient 4 is nan, it must be finite");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(right_harmonics_are_right), cmocka_unit_test(axes_of_engines_are_right),
        cmocka_unit_test(turns_are_named),           cmocka_unit_test(weights_are_named),
        cmocka_unit_test(windows_are_named),         cmocka_unit_test(scales_are_named),
        cmocka_unit_test(constants_are_named),       cmocka_unit_test(arguments_are_checked),
    };
    return cmocka_run_group_tests(tests, begin, end);
}

// What kiln_bake promises: levels, irradiance and harmonics are those of the functions that make
// each alone, whatever the source's shape, and a plan repeats them.
#include "kit/context.h"

static bool same_environment(const kiln_environment *a, const kiln_environment *b)
{
    return same_map(&a->levels, &b->levels) && same_map(&a->irradiance, &b->irradiance) &&
           !memcmp(&a->sh, &b->sh, sizeof a->sh) && a->lobe == b->lobe && a->degree == b->degree;
}

// A scene as a panorama of 32 rows, a cube of 16 or an octahedron of 32.
static kiln_map make_source(kiln_shape shape, uint32_t seed)
{
    kiln_map panorama = scene_panorama(context, 32, seed), map;
    if (shape == KILN_SHAPE_PANORAMA)
        return panorama;
    CHECK_OK(kiln_map_convert(context, &panorama, shape, shape == KILN_SHAPE_CUBE ? 16 : 32, 0,
                              &map, &error));
    kiln_map_free(&panorama);
    return map;
}

static void levels_and_harmonics_are_those_made_alone(void **state)
{
    (void)state;
    for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++) {
        kiln_map source = make_source((kiln_shape)shape, 5), levels;
        kiln_bake_def def = {.levels = {.size = 16, .rotation = 25}, .sh_bands = 5};
        kiln_environment made, bare;
        kiln_spectrum *spectrum;
        kiln_sh sh;
        CHECK_OK(kiln_bake(context, &source, &def, &made, &error));
        CHECK_OK(kiln_prefilter(context, &source, &def.levels, &levels, &error));
        assert_true(same_map(&made.levels, &levels));
        CHECK_OK(kiln_spectrum_analyze(context, &source, 0, &spectrum, &error));
        CHECK_OK(kiln_spectrum_sh(spectrum, 5, false, 0, 25, &sh, &error));
        for (int k = 0; k < 25; k++)
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(made.sh.c[k][c], sh.c[k][c], 1e-6 * fabs(sh.c[0][c]));
        // Whether irradiance is asked for changes nothing else.
        def.irradiance_size = KILN_NO_IRRADIANCE;
        CHECK_OK(kiln_bake(context, &source, &def, &bare, &error));
        assert_true(same_map(&made.levels, &bare.levels));
        assert_memory_equal(&made.sh, &bare.sh, sizeof bare.sh);
        assert_int_equal(bare.irradiance.size, 0);
        assert_null(bare.irradiance.level[0]);
        kiln_environment_free(&bare);
        kiln_spectrum_destroy(spectrum);
        kiln_environment_free(&made);
        kiln_map_free(&levels);
        kiln_map_free(&source);
    }
}

static void the_irradiance_is_the_integral_over_the_cosine(void **state)
{
    (void)state;
    for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++) {
        kiln_map panorama = scene_panorama(context, 32, 9),
                 source = make_source((kiln_shape)shape, 9);
        kiln_bake_def def = {.levels = {.size = 4}, .irradiance_size = 8};
        kiln_environment made;
        CHECK_OK(kiln_bake(context, &source, &def, &made, &error));
        assert_int_equal(made.irradiance.shape, KILN_SHAPE_CUBE);
        assert_int_equal(made.irradiance.size, 8);
        CHECK_NEAR((double)made.irradiance.roughness[0], 1, 0);
        kiln_lobe lambert = kiln_lobe_lambert();
        if (shape == KILN_SHAPE_PANORAMA) {
            scene_errors e =
                scene_compare(context, &panorama, &made.irradiance, 0, &lambert, 0, 40);
            CHECK_BELOW(e.rms, 1e-4);
            CHECK_BELOW(e.most, 2e-3);
        }
        // Three bands of the cosine lobe, 1/4 + x/2 + 5/32 (3 x^2 - 1), err most at x = 0, by 3/32:
        // of any environment that is 3/8 of its mean.
        kiln_sh diffuse;
        CHECK_OK(kiln_sh_filter(&made.sh, 3, true, 0, &diffuse, &error));
        for (size_t i = 0; i < kiln_map_texels(&made.irradiance, 0); i += 7) {
            double direction[3], value[3], mean = diffuse.c[0][0] * 0.28209479177387814 / pi;
            kiln_map_direction(&made.irradiance, 0, i, direction);
            kiln_sh_evaluate(&diffuse, direction, value);
            CHECK_NEAR(value[0] / pi, (double)made.irradiance.level[0][3 * i], 0.375 * mean);
        }
        kiln_environment_free(&made);
        kiln_map_free(&source);
        kiln_map_free(&panorama);
    }
}

static void white_stays_white(void **state)
{
    (void)state;
    kiln_map white;
    kiln_environment made;
    kiln_bake_def def = {.levels = {.size = 8}, .exposure = 1, .mirror = true};
    white = make_map(context, KILN_SHAPE_CUBE, 8, 1);
    fill_constant(&white, 1);
    CHECK_OK(kiln_bake(context, &white, &def, &made, &error));
    CHECK_NEAR((double)white.level[0][0], 1, 0); // the source is as it was
    assert_int_equal(made.irradiance.size, 64);
    for (size_t i = 0; i < 3 * kiln_map_texels(&made.irradiance, 0); i++)
        CHECK_NEAR((double)made.irradiance.level[0][i], 2, 2e-6);
    assert_int_equal(made.sh.bands, 3);
    for (int c = 0; c < 3; c++) {
        CHECK_NEAR(made.sh.c[0][c], 2 * sqrt(4 * pi), 2e-6);
        for (int k = 1; k < 9; k++)
            CHECK_NEAR(made.sh.c[k][c], 0, 1e-6);
    }
    kiln_environment_free(&made);
    kiln_map_free(&white);
}

static void the_source_is_mirrored_and_exposed_first(void **state)
{
    (void)state;
    for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++) {
        kiln_map source = make_source((kiln_shape)shape, 3),
                 changed = make_source((kiln_shape)shape, 3);
        kiln_bake_def def = {.levels = {.size = 8, .rotation = 40}, .irradiance_size = 4};
        kiln_environment wanted, made;
        kiln_map_mirror(&changed);
        kiln_map_expose(&changed, -1.5);
        CHECK_OK(kiln_bake(context, &changed, &def, &wanted, &error));
        def.mirror = true;
        def.exposure = -1.5;
        CHECK_OK(kiln_bake(context, &source, &def, &made, &error));
        assert_true(same_environment(&made, &wanted));
        kiln_environment_free(&wanted);
        kiln_environment_free(&made);
        kiln_map_free(&source);
        kiln_map_free(&changed);
    }
}

static void a_plan_makes_the_same_of_every_shape(void **state)
{
    (void)state;
    for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++) {
        kiln_map source[2] = {make_source((kiln_shape)shape, 1), make_source((kiln_shape)shape, 2)};
        kiln_bake_def def = {.levels = {.size = 16, .level_count = 3}, .exposure = 0.5};
        kiln_environment wanted[2], made;
        kiln_plan *plan;
        CHECK_OK(kiln_plan_create(context, (kiln_shape)shape, source[0].size, &def, &plan, &error));
        CHECK_OK(kiln_plan_environment(plan, &made, &error));
        for (int i = 0; i < 2; i++)
            CHECK_OK(kiln_bake(context, &source[i], &def, &wanted[i], &error));
        for (int i = 0; i < 4; i++) {
            CHECK_OK(kiln_plan_execute(plan, &source[i % 2], &made, &error));
            assert_true(same_environment(&made, &wanted[i % 2]));
        }
        source[0].shape = (kiln_shape)(shape % 3 + 1);
        assert_int_equal(kiln_plan_execute(plan, &source[0], &made, &error), KILN_ERROR_ARGUMENT);
        static const char *const said[] = {"", "panoramas of size 32", "cubes of size 16",
                                           "octahedra of size 32"};
        CHECK_SAYS(error.message, said[shape]);
        kiln_plan_destroy(plan);
        kiln_environment_free(&made);
        for (int i = 0; i < 2; i++) {
            kiln_environment_free(&wanted[i]);
            kiln_map_free(&source[i]);
        }
    }
}

static void an_engine_decides_its_levels(void **state)
{
    (void)state;
    kiln_map source = make_source(KILN_SHAPE_PANORAMA, 4), wanted;
    const kiln_engine *three = kiln_engine_find("three");
    float roughness[KILN_MAX_LEVELS];
    kiln_prefilter_def levels;
    kiln_bake_def def = {.levels = {.size = 32}, .engine = three, .tune = KILN_TUNE_NONE};
    kiln_environment made;
    CHECK_OK(kiln_bake(context, &source, &def, &made, &error));
    CHECK_OK(kiln_engine_levels(three, 32, 0, roughness, &levels, &error));
    CHECK_OK(kiln_prefilter(context, &source, &levels, &wanted, &error));
    assert_true(same_map(&made.levels, &wanted));
    kiln_map_free(&wanted);
    kiln_environment_free(&made);
    def.levels.lobe = KILN_LOBE_CHARLIE;
    assert_int_equal(kiln_bake(context, &source, &def, &made, &error), KILN_ERROR_ARGUMENT);
    assert_int_equal(made.levels.size, 0);
    kiln_bake_def no_engine = {.tune = KILN_TUNE_SOFT};
    assert_int_equal(kiln_bake(context, &source, &no_engine, &made, &error), KILN_ERROR_ARGUMENT);
    kiln_map_free(&source);
}

static void numbers_out_of_range_are_named(void **state)
{
    (void)state;
    kiln_map source = make_source(KILN_SHAPE_CUBE, 4);
    static const struct {
        kiln_bake_def def;
        const char *said;
    } wrong[] = {{{.irradiance_size = -2}, "irradiance_size is -2"},
                 {{.irradiance_size = KILN_MAX_SIZE + 1}, "irradiance_size is 32769"},
                 {{.sh_bands = 6}, "sh_bands is 6"},
                 {{.exposure = 1000}, "exposure is 1000 stops"},
                 {{.levels = {.size = -1}}, "size is -1"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        kiln_environment made = {.degree = 1};
        assert_int_equal(kiln_bake(context, &source, &wrong[i].def, &made, &error),
                         KILN_ERROR_ARGUMENT);
        CHECK_SAYS(error.message, wrong[i].said);
        assert_int_equal(made.degree, 0);
        assert_null(made.levels.level[0]);
    }
    kiln_map_free(&source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_and_harmonics_are_those_made_alone),
        cmocka_unit_test(the_irradiance_is_the_integral_over_the_cosine),
        cmocka_unit_test(white_stays_white),
        cmocka_unit_test(the_source_is_mirrored_and_exposed_first),
        cmocka_unit_test(a_plan_makes_the_same_of_every_shape),
        cmocka_unit_test(an_engine_decides_its_levels),
        cmocka_unit_test(numbers_out_of_range_are_named),
    };
    return cmocka_run_group_tests_name("environment", tests, set_up, tear_down);
}

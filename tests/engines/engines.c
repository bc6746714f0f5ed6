// Engines: their table, the levels that each loads and shows, and what an engine does not take.
#include <unistd.h>

#include "kit/context.h"

static void every_engine_is_found_and_makes_sense(void **state)
{
    (void)state;
    const kiln_engine *engine;
    int count = 0;
    for (; (engine = kiln_engine_at(count)) != NULL; count++) {
        float roughness[KILN_MAX_LEVELS];
        kiln_prefilter_def def;
        assert_ptr_equal(kiln_engine_find(engine->name), engine);
        assert_true(engine->title[0] && engine->files[0] && engine->mapping[0]);
        assert_true(!strncmp(engine->proof, "pixels of ", 10) ||
                    !strncmp(engine->proof, "source of ", 10) ||
                    !strncmp(engine->proof, "manual of ", 10));
        CHECK_OK(kiln_engine_levels(engine, 0, 0, roughness, &def, &error));
        assert_int_equal(def.size, engine->size);
        assert_int_equal(def.level_count, engine->level_count);
        assert_true(roughness[0] == 0);
        assert_true(roughness[def.level_count - 1] == 1 || def.level_count == 1);
        for (int k = 1; k < def.level_count; k++)
            assert_true(roughness[k] >= roughness[k - 1] && roughness[k] <= 1);
    }
    assert_true(count > 0);
    assert_null(kiln_engine_at(-1));
    assert_null(kiln_engine_find("frob"));
}

static void a_shader_reads_each_level_at_its_roughness(void **state)
{
    (void)state;
    for (int e = 0; kiln_engine_at(e); e++) {
        const kiln_engine *engine = kiln_engine_at(e);
        float roughness[KILN_MAX_LEVELS];
        kiln_prefilter_def def;
        CHECK_OK(kiln_engine_levels(engine, 0, 0, roughness, &def, &error));
        double last = kiln_engine_level(engine, 1, def.size, def.level_count);
        if (last < 0)
            continue;
        assert_true(last <= def.level_count - 1);
        for (int k = 1; k < def.level_count; k++)
            CHECK_NEAR(kiln_engine_level(engine, (double)roughness[k], def.size, def.level_count),
                       k < last ? k : last, 1e-5);
    }
    assert_true(kiln_engine_level(&(kiln_engine){0}, 0.5, 256, 5) < 0);
}

// Level k is 1 + k everywhere, so that what is shown tells the level.
static void what_is_shown_is_the_mix_of_two_levels(void **state)
{
    (void)state;
    kiln_map map;
    const double directions[2][3] = {{1, 0.9999, -0.3}, {-0.2, -3, 1}};
    double values[2][3];
    const kiln_engine *three = kiln_engine_find("three");
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 32, 5, &map, &error));
    for (int k = 0; k < 5; k++)
        for (size_t i = 0; i < 3 * kiln_map_texels(&map, k); i++)
            map.level[k][i] = (float)(1 + k);
    for (int i = 0; i <= 20; i++) {
        double r = i / 20.0;
        CHECK_OK(kiln_engine_show(context, three, &map, r, directions, 2, values, &error));
        for (int c = 0; c < 3; c++)
            for (int j = 0; j < 2; j++)
                CHECK_NEAR(values[j][c], 1 + kiln_engine_level(three, r, 32, 5), 1e-6);
    }
    assert_int_equal(kiln_engine_show(context, three, &map, 1.5, directions, 2, values, &error),
                     KILN_ERROR_ARGUMENT);
    kiln_map_free(&map);
}

// Levels of the smallest size are those that a cube of that size would have.
static void levels_may_stop_halving(void **state)
{
    (void)state;
    kiln_map source, map, alone;
    const float roughness[6] = {0, 0.3f, 0.5f, 0.6f, 0.8f, 1};
    kiln_prefilter_def def = {.size = 64, .level_count = 6, .smallest = 16, .roughness = roughness};
    source = make_noise(context, KILN_SHAPE_PANORAMA, 32, 1);
    CHECK_OK(kiln_prefilter(context, &source, &def, &map, &error));
    for (int k = 0; k < 6; k++) {
        int size = k < 2 ? 64 >> k : 16;
        assert_int_equal(kiln_map_level_size(&map, k), size);
        kiln_prefilter_def one = {.size = size, .level_count = 1, .roughness = roughness + k};
        CHECK_OK(kiln_prefilter(context, &source, &one, &alone, &error));
        for (size_t i = 0; i < 3 * kiln_map_texels(&alone, 0); i++)
            CHECK_NEAR((double)map.level[k][i], (double)alone.level[0][i], 2e-6);
        kiln_map_free(&alone);
    }
    assert_int_equal(kiln_map_save(context, &map, "x.ktx2", NULL, NULL, &error),
                     KILN_ERROR_ARGUMENT);
    assert_int_equal(kiln_map_save(context, &map, "x.dds", NULL, NULL, &error),
                     KILN_ERROR_ARGUMENT);
    kiln_map_free(&map);
    kiln_map_free(&source);
    def.smallest = 65;
    assert_int_equal(kiln_prefilter(context, &source, &def, &map, &error), KILN_ERROR_ARGUMENT);
}

static void what_an_engine_does_not_take_is_said(void **state)
{
    (void)state;
    const kiln_engine *three = kiln_engine_find("three");
    kiln_engine stranger = *three;
    kiln_map map, chain;
    kiln_sh sh = {.bands = 3};
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 32, 3, &map, &error));
    assert_int_equal(
        kiln_engine_save(context, &stranger, &map, &sh, KILN_FORMAT_AUTO, "x.ktx2", NULL, &error),
        KILN_ERROR_ARGUMENT);
    assert_int_equal(
        kiln_engine_save(context, three, &map, &sh, KILN_FORMAT_AUTO, "x.dds", NULL, &error),
        KILN_ERROR_ARGUMENT);
    assert_int_equal(
        kiln_engine_save(context, three, &map, NULL, KILN_FORMAT_AUTO, "x.ktx2", NULL, &error),
        KILN_ERROR_ARGUMENT);
    assert_int_equal(
        kiln_engine_save(context, three, &map, &sh, KILN_FORMAT_BC6H, "x.ktx2", NULL, &error),
        KILN_ERROR_ARGUMENT);
    assert_string_equal(error.message,
                        "three: format is bc6h, it must be rgb9e5 or rgba16f or uastc");
    const kiln_engine *flat = kiln_engine_find("three-cubeuv");
    assert_int_equal(
        kiln_engine_save(context, flat, &map, &sh, KILN_FORMAT_UASTC, "x.exr", NULL, &error),
        KILN_ERROR_ARGUMENT);
    assert_string_equal(error.message, "x.exr: three-cubeuv's file must end in .ktx2");
    assert_string_equal(kiln_engine_ending(flat, KILN_FORMAT_UASTC), "ktx2");
    assert_string_equal(kiln_engine_ending(flat, KILN_FORMAT_AUTO), "exr");
    assert_string_equal(kiln_engine_ending(three, KILN_FORMAT_UASTC), "ktx2");
    assert_null(kiln_engine_ending(&stranger, KILN_FORMAT_AUTO));
    const kiln_engine *filament = kiln_engine_find("filament");
    assert_int_equal(
        kiln_engine_save(context, filament, &map, &sh, KILN_FORMAT_RGB9E5, "x", NULL, &error),
        KILN_ERROR_ARGUMENT);
    assert_string_equal(error.message,
                        "filament: format is rgb9e5, it must be b10g11r11 or rgba16f");
    const kiln_engine *babylon = kiln_engine_find("babylon");
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 16, 5, &chain, &error));
    assert_int_equal(
        kiln_engine_save(context, babylon, &chain, &sh, KILN_FORMAT_RGB9E5, "x.env", NULL, &error),
        KILN_ERROR_ARGUMENT);
    assert_string_equal(error.message,
                        "babylon: the engine's files have one format only, leave the format out");
    kiln_map_free(&chain);
    map.shape = KILN_SHAPE_OCTAHEDRON;
    assert_int_equal(
        kiln_engine_save(context, three, &map, &sh, KILN_FORMAT_AUTO, "x.ktx2", NULL, &error),
        KILN_ERROR_ARGUMENT);
    map.shape = KILN_SHAPE_CUBE;
    assert_int_not_equal(access("x.ktx2", F_OK), 0);
    kiln_map_free(&map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_engine_is_found_and_makes_sense, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_shader_reads_each_level_at_its_roughness, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(what_is_shown_is_the_mix_of_two_levels, set_up, tear_down),
        cmocka_unit_test_setup_teardown(levels_may_stop_halving, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_an_engine_does_not_take_is_said, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

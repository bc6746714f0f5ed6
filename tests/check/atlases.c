// Files for engines that read flat pictures.
#include "engine/engine.h"

#include <kiln/check.h>

#include "blobs.h"

static kiln_map scene;

static int begin(void **state)
{
    int failed = set_up_folder(state);
    scene = blobs(false);
    return failed;
}

static int end(void **state)
{
    kiln_map_free(&scene);
    return tear_down_folder(state);
}

static kiln_check_levels_report checked(const kiln_map *map, const kiln_engine *engine)
{
    kiln_check_levels_report report;
    CHECK_OK(kiln_check_levels(context, &scene, map, &(kiln_check_levels_def){.engine = engine},
                               &report, NULL, &error));
    return report;
}

// Atlases are read as cubes of what the engine's shader reads: the levels have the roughness that
// the engine expects, and the engine shows no more error than it would of the cube that the atlas
// was made from, up to the interpolation.
static void atlases_are_right(void **state)
{
    (void)state;
    static const struct {
        const char *engine, *file;
        int size;
        double more;
    } rows[] = {{"three-cubeuv", "c.exr", 64, 0.02}, {"playcanvas", "p.png", 512, 0.02}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const kiln_engine *engine = kiln_engine_find(rows[i].engine);
        const kiln_bake_def def = {.levels = {.size = rows[i].size},
                                   .engine = engine,
                                   .tune = KILN_TUNE_NONE,
                                   .irradiance_size = KILN_NO_IRRADIANCE};
        kiln_environment made;
        kiln_map map;
        kiln_check_shown_report shown, wanted;
        CHECK_OK(kiln_bake(context, &scene, &def, &made, &error));
        CHECK_OK(kiln_engine_save(context, engine, &made.levels, &made.sh, KILN_FORMAT_AUTO,
                                  in_folder(rows[i].file), NULL, &error));
        CHECK_OK(kiln_levels_load(context, in_folder(rows[i].file), NULL, NULL, &map, &error));
        kiln_check_levels_report report = checked(&map, engine);
        for (int k = 0; k < report.findings.count; k++)
            if (report.findings.finding[k].fault)
                fail_msg("%s: %s", rows[i].engine, report.findings.finding[k].text);
        for (int k = 1; k < map.level_count; k++)
            CHECK_NEAR(fmax(0.2, report.level[k].found), fmax(0.2, report.level[k].roughness),
                       0.03);
        CHECK_OK(kiln_check_shown(context, &scene, &map, engine, &shown, &error));
        kiln_map file = {.shape = map.shape,
                         .size = map.size,
                         .level_count = map.level_count,
                         .smallest = map.smallest};
        CHECK_OK(ki_map_allocate(context, &file, &error));
        ki_turn_cube(&made.levels, &ki_recipe_of(engine)->axes, &file);
        CHECK_OK(kiln_check_shown(context, &scene, &file, engine, &wanted, &error));
        assert_int_equal(shown.direction_count, 192);
        CHECK_BELOW(shown.all, wanted.all + rows[i].more);
        kiln_map_free(&file);
        kiln_map_free(&map);
        kiln_environment_free(&made);
    }
}

// Under a source of 1, whose mean is 1, a cube of 2 is shown as 2 / (2 + 1) in place of 1 / (1 +
// 1): too bright by 1/6 of white on a display, and by 1 relative to the source.
static void displayed_errors_are_of_values_on_a_display(void **state)
{
    (void)state;
    kiln_map source, cube;
    kiln_check_shown_report shown;
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_PANORAMA, 16, 1, &source, &error));
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 16, 2, &cube, &error));
    for (size_t i = 0; i < 3 * kiln_map_texels(&source, 0); i++)
        source.level[0][i] = 1;
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < 3 * kiln_map_texels(&cube, k); i++)
            cube.level[k][i] = 2;
    CHECK_OK(kiln_check_shown(context, &source, &cube, kiln_engine_find("three"), &shown, &error));
    CHECK_NEAR(shown.all, 1, 1e-6);
    CHECK_NEAR(shown.displayed, 1.0 / 6, 1e-7);
    // Exact levels of a source of 1 are 1.
    CHECK_BELOW(shown.exact_all, 1e-6);
    CHECK_BELOW(shown.exact_displayed, 1e-6);
    kiln_map_free(&source);
    kiln_map_free(&cube);
}

// Levels are right within the tolerance, or where an engine shows less error of them than of exact
// levels; never with a fault.
static void levels_are_right_or_tuned(void **state)
{
    (void)state;
    kiln_check_levels_report levels = {.level_count = 1, .worst = 0.02};
    kiln_check_shown_report shown = {
        .all = 0.1, .displayed = 0.01, .exact_all = 0.1, .exact_displayed = 0.01};
    assert_true(kiln_check_right(&levels, NULL, 0.02));
    assert_false(kiln_check_right(&levels, NULL, 0.01));
    shown.direction_count = 192;
    assert_false(kiln_check_right(&levels, &shown, 0.01));
    shown.all = 0.098;
    assert_true(kiln_check_right(&levels, &shown, 0.01));
    shown.direction_count = 0; // nothing was measured
    assert_false(kiln_check_right(&levels, &shown, 0.01));
    shown = (kiln_check_shown_report){.all = 0.2,
                                      .displayed = 0.0098,
                                      .exact_all = 0.1,
                                      .exact_displayed = 0.01,
                                      .direction_count = 192};
    assert_true(kiln_check_right(&levels, &shown, 0.01));
    // Under a black source exact levels show no error, and nothing is better than they are.
    shown = (kiln_check_shown_report){.displayed = 1, .direction_count = 192};
    assert_false(kiln_check_right(&levels, &shown, 0.01));
    shown.exact_displayed = 2;
    levels.findings.fault_count = 1;
    assert_false(kiln_check_right(&levels, &shown, 0.01));
    assert_false(kiln_check_right(&levels, NULL, 1));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(atlases_are_right),
        cmocka_unit_test(displayed_errors_are_of_values_on_a_display),
        cmocka_unit_test(levels_are_right_or_tuned)};
    return cmocka_run_group_tests(tests, begin, end);
}

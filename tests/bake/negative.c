// Negative texels are data: filtered levels, irradiance and harmonics are those of the numbers as
// they stand, which sums over all texels give, and maps hold 0 where the sum is below zero.
#include "kit/context.h"

#include <kiln/course.h>

enum { SIZE = 32 };

// A lamp with deep negative texels beside it, as lossy compression leaves them, in a dim room with
// negative noise. `lamp` is the lamp's radiance, of any sign.
static kiln_map ringing(double lamp)
{
    kiln_map map = make_panorama(context, SIZE);
    fill_noise(&map, 5, -0.1, 0.3);
    for (int c = 0; c < 3; c++) {
        texel_at(&map, 20, 9)[c] = (float)lamp;
        texel_at(&map, 19, 9)[c] = (float)(-0.3 * lamp);
        texel_at(&map, 21, 10)[c] = (float)(-0.2 * lamp);
    }
    return map;
}

// Compares texels of a level, at most 64, with the brute-force sum where the sum is above zero, and
// else with 0. Returns the root mean square of the errors relative to that of the same sum over
// magnitudes, and adds the number of sums below zero to *below.
static double compare(const kiln_map *panorama, const kiln_map *map, int level, kiln_lobe lobe,
                      size_t *below)
{
    enum { MOST = 64 };
    size_t texels = kiln_map_texels(map, level), count = texels < MOST ? texels : MOST;
    double directions[MOST][3], values[2][MOST][3], square = 0, whole = 0;
    kiln_map magnitudes = make_panorama(context, SIZE);
    for (size_t i = 0; i < value_count(panorama, 0); i++)
        magnitudes.level[0][i] = fabsf(panorama->level[0][i]);
    for (size_t i = 0; i < count; i++)
        kiln_map_direction(map, level, i * texels / count, directions[i]);
    for (int k = 0; k < 2; k++)
        CHECK_OK(kiln_reference_filter(context, k ? &magnitudes : panorama, &lobe, 0,
                                       (const double(*)[3])directions, (int)count, values[k],
                                       &error));
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3; c++) {
            float got = map->level[level][3 * (i * texels / count) + c];
            double wanted = values[0][i][c], off = (double)got - fmax(wanted, 0);
            assert_true(got >= 0);
            square += off * off;
            whole += values[1][i][c] * values[1][i][c];
            *below += wanted < 0;
        }
    kiln_map_free(&magnitudes);
    return sqrt(square / whole);
}

static void levels_are_those_of_the_numbers(void **state)
{
    (void)state;
    const double lamps[] = {300, -300, 5};
    for (int i = 0; i < 3; i++) {
        kiln_map source = ringing(lamps[i]);
        kiln_environment made;
        kiln_bake_def def = {.levels = {.size = 16}, .irradiance_size = 8};
        CHECK_OK(kiln_bake(context, &source, &def, &made, &error));
        size_t below = 0;
        for (int level = 1; level < made.levels.level_count; level++) {
            double r = (double)made.levels.roughness[level];
            CHECK_BELOW(compare(&source, &made.levels, level, kiln_lobe_ggx(r * r), &below), 1e-4);
        }
        CHECK_BELOW(compare(&source, &made.irradiance, 0, kiln_lobe_lambert(), &below), 1e-4);
        assert_true(lamps[i] > 0 || below > 100); // the sums have both signs
        assert_int_equal(made.levels_cut.value_count,
                         3 * 6 * (16 * 16 + 8 * 8 + 4 * 4 + 2 * 2 + 1));
        assert_true(made.levels_cut.cut_count > 0);
        kiln_environment_free(&made);
        kiln_map_free(&source);
    }
}

// The integral over a texel of a panorama of the functions 1, y, z, x, with the solid angle's own
// integrals over theta and phi, times the constants of the orthonormal harmonics.
static void sum_harmonics(const kiln_map *map, double wanted[4][3])
{
    double step = pi / SIZE;
    memset(wanted, 0, sizeof(double[4][3]));
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < 2 * SIZE; x++) {
            double t0 = step * y, t1 = t0 + step, p0 = step * x - pi, p1 = p0 + step;
            double sine2 = (t1 - t0) / 2 - (sin(2 * t1) - sin(2 * t0)) / 4;
            double solid = (cos(t0) - cos(t1)) * step;
            double height = (cos(2 * t0) - cos(2 * t1)) / 4 * step;
            double across = sine2 * (cos(p0) - cos(p1)), along = -sine2 * (sin(p1) - sin(p0));
            const double f[4] = {sqrt(1 / (4 * pi)) * solid, sqrt(3 / (4 * pi)) * height,
                                 sqrt(3 / (4 * pi)) * along, sqrt(3 / (4 * pi)) * across};
            for (int k = 0; k < 4; k++)
                for (int c = 0; c < 3; c++)
                    wanted[k][c] += f[k] * (double)texel_at(map, x, y)[c];
        }
}

static void harmonics_are_those_of_the_numbers(void **state)
{
    (void)state;
    kiln_map source = ringing(-600);
    kiln_sh sh;
    double wanted[4][3];
    CHECK_OK(kiln_map_sh(context, &source, 2, 0, &sh, &error));
    sum_harmonics(&source, wanted);
    for (int k = 0; k < 4; k++)
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(sh.c[k][c], wanted[k][c], 1e-5 * fabs(wanted[0][c]));
    assert_true(sh.c[0][0] < 0); // harmonics are never cut off
    kiln_map_free(&source);
}

// A level of the whole is the difference of the levels of its positive and of its negative texels.
static void the_textbook_is_linear_too(void **state)
{
    (void)state;
    kiln_map source = ringing(300), parts[2], levels[3];
    kiln_textbook_def def = {
        .shape = KILN_SHAPE_CUBE, .size = 8, .level_count = 3, .sample_count = 64};
    for (int i = 0; i < 2; i++) {
        parts[i] = make_panorama(context, SIZE);
        for (size_t k = 0; k < value_count(&source, 0); k++)
            parts[i].level[0][k] = fmaxf(i ? -source.level[0][k] : source.level[0][k], 0);
        CHECK_OK(kiln_textbook_prefilter(context, &parts[i], &def, &levels[i], &error));
    }
    CHECK_OK(kiln_textbook_prefilter(context, &source, &def, &levels[2], &error));
    size_t below = 0;
    for (int level = 0; level < 3; level++)
        for (size_t k = 0; k < value_count(&levels[2], level); k++) {
            double plus = (double)levels[0].level[level][k],
                   minus = (double)levels[1].level[level][k];
            CHECK_NEAR((double)levels[2].level[level][k], plus - minus, 1e-5 * (plus + minus));
            below += levels[2].level[level][k] < 0;
        }
    assert_true(below > 0);
    // The step that bakes end with.
    kiln_cut cut;
    kiln_map_cut_negative(context, &levels[2], &cut);
    assert_int_equal(cut.cut_count, below);
    for (int level = 0; level < 3; level++)
        for (size_t k = 0; k < value_count(&levels[2], level); k++)
            assert_true(levels[2].level[level][k] >= 0);
    for (int i = 0; i < 3; i++)
        kiln_map_free(&levels[i]);
    for (int i = 0; i < 2; i++)
        kiln_map_free(&parts[i]);
    kiln_map_free(&source);
}

// The share that is cut off is a sum over the values times the solid angles of their texels.
static void what_is_cut_off_is_weighed(void **state)
{
    (void)state;
    kiln_map map = make_map(context, KILN_SHAPE_PANORAMA, 4, 2);
    fill_constant(&map, 1);
    for (size_t i = 0; i < value_count(&map, 1); i++)
        map.level[1][i] = 2;
    for (int c = 0; c < 3; c++)
        texel_at(&map, 2, 1)[c] = -4;
    kiln_cut cut;
    kiln_map_cut_negative(context, &map, &cut);
    // Texels of 4 rows weigh sin(pi / 8) and sin(3 pi / 8), those of 2 rows sin(pi / 4).
    double thin = sin(pi / 8), wide = sin(3 * pi / 8);
    double above = 8 * 2 * (thin + wide) - wide + 2 * 2 * 4 * sin(pi / 4);
    assert_int_equal(cut.value_count, 3 * (32 + 8));
    assert_int_equal(cut.cut_count, 3);
    CHECK_NEAR(cut.share, 4 * wide / above, 1e-12);
    CHECK_NEAR((double)texel_at(&map, 2, 1)[0], 0, 0);
    kiln_map_free(&map);
}

static void tuned_levels_hold_nothing_negative(void **state)
{
    (void)state;
    const double lamps[] = {300, -300};
    for (int i = 0; i < 2; i++) {
        kiln_map source = ringing(lamps[i]);
        kiln_environment made;
        kiln_bake_def def = {.levels = {.size = 8, .tune_for = kiln_engine_find("three")},
                             .irradiance_size = KILN_NO_IRRADIANCE};
        CHECK_OK(kiln_bake(context, &source, &def, &made, &error));
        for (int level = 0; level < made.levels.level_count; level++)
            for (size_t k = 0; k < value_count(&made.levels, level); k++)
                assert_true(made.levels.level[level][k] >= 0 && made.levels.level[level][k] <= 300);
        assert_true(made.levels_cut.cut_count > 0); // of the mirror image
        kiln_environment_free(&made);
        kiln_map_free(&source);
    }
}

// Only rounding makes values below zero of a source that has none.
static void little_is_cut_off_of_other_sources(void **state)
{
    (void)state;
    kiln_map source = scene_panorama(context, SIZE, 3);
    kiln_environment made;
    CHECK_OK(kiln_bake(context, &source, NULL, &made, &error));
    CHECK_BELOW(made.levels_cut.share, 1e-6);
    CHECK_BELOW(made.irradiance_cut.share, 1e-6);
    kiln_environment_free(&made);
    kiln_map_free(&source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_are_those_of_the_numbers),
        cmocka_unit_test(harmonics_are_those_of_the_numbers),
        cmocka_unit_test(the_textbook_is_linear_too),
        cmocka_unit_test(what_is_cut_off_is_weighed),
        cmocka_unit_test(tuned_levels_hold_nothing_negative),
        cmocka_unit_test(little_is_cut_off_of_other_sources),
    };
    return cmocka_run_group_tests_name("negative", tests, set_up, tear_down);
}

// A cube and harmonics turned to an engine's axes hold the same light, and a cube is read smoothly
// across edges.
#include "engine/engine.h"

#include "kit/context.h"

// Radiance with no symmetry at all.
static double radiance(const double d[3], int c)
{
    return 2 + d[0] + 0.5 * d[1] * d[2] - 0.25 * d[c] * d[c] + 0.125 * (c + 1) * d[2];
}

static void a_turned_cube_holds_each_texel_where_it_is_looked_for(void **state)
{
    (void)state;
    for (int e = 0; kiln_engine_at(e); e++) {
        const ki_axes *axes = &ki_recipe_at(e)->axes;
        kiln_map map, turned;
        CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 12, 3, &map, &error));
        CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 12, 3, &turned, &error));
        for (int k = 0; k < 3; k++)
            for (size_t i = 0; i < kiln_map_texels(&map, k); i++)
                for (int c = 0; c < 3; c++) {
                    double d[3];
                    kiln_map_direction(&map, k, i, d);
                    map.level[k][3 * i + (size_t)c] = (float)radiance(d, c);
                }
        ki_turn_cube(&map, axes, &turned);
        for (int k = 0; k < 3; k++)
            for (size_t i = 0; i < kiln_map_texels(&map, k); i++) {
                double at[3], d[3];
                kiln_map_direction(&turned, k, i, at);
                for (int a = 0; a < 3; a++)
                    d[a] = axes->sign[a] * at[axes->axis[a]];
                for (int c = 0; c < 3; c++)
                    CHECK_NEAR((double)turned.level[k][3 * i + (size_t)c], radiance(d, c), 1e-6);
            }
        kiln_map_free(&map);
        kiln_map_free(&turned);
    }
}

static void turned_harmonics_are_the_same_function(void **state)
{
    (void)state;
    kiln_sh sh = {.bands = 3}, turned;
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            sh.c[i][c] = 1.0 / (1 + i + 2 * c) - 0.3;
    for (int e = 0; kiln_engine_at(e); e++) {
        const ki_axes *axes = &ki_recipe_at(e)->axes;
        ki_turn_sh(&sh, axes, &turned);
        for (int i = 0; i < 20; i++) {
            double z = (i + 0.5) / 10 - 1, r = sqrt(1 - z * z), d[3], wanted[3], value[3];
            const double at[3] = {r * cos(2.4 * i), z, r * sin(2.4 * i)};
            for (int a = 0; a < 3; a++)
                d[a] = axes->sign[a] * at[axes->axis[a]];
            kiln_sh_evaluate(&sh, d, wanted);
            kiln_sh_evaluate(&turned, at, value);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(value[c], wanted[c], 1e-12);
        }
    }
}

static void reading_a_cube_crosses_its_edges_smoothly(void **state)
{
    (void)state;
    kiln_map map;
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 64, 1, &map, &error));
    for (size_t i = 0; i < kiln_map_texels(&map, 0); i++)
        for (int c = 0; c < 3; c++) {
            double d[3];
            kiln_map_direction(&map, 0, i, d);
            map.level[0][3 * i + (size_t)c] = (float)radiance(d, c);
        }
    for (int i = 0; i < 2000; i++) {
        double z = (i + 0.5) / 1000 - 1, r = sqrt(1 - z * z), rgb[3];
        const double d[3] = {r * cos(2.4 * i), z, r * sin(2.4 * i)};
        ki_cube_read(&map, 0, d, rgb);
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(rgb[c], radiance(d, c), 0.02);
    }
    kiln_map_free(&map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_turned_cube_holds_each_texel_where_it_is_looked_for,
                                        set_up, tear_down),
        cmocka_unit_test_setup_teardown(turned_harmonics_are_the_same_function, set_up, tear_down),
        cmocka_unit_test_setup_teardown(reading_a_cube_crosses_its_edges_smoothly, set_up,
                                        tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

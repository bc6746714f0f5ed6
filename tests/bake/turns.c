// Turns about any axis: what is turned is where the matrix says, and is as exact as what is not
// turned.
#include "kit/context.h"
#include "kit/random.h"

enum { ROWS = 64, SIZE = 32 };

// The direction of the input that a turned environment shows in direction d, by
// docs/conventions.md.
static void source_of(const kiln_prefilter_def *def, const double d[3], double from[3])
{
    double yaw = def->rotation * pi / 180, pitch = def->pitch * pi / 180,
           roll = def->roll * pi / 180;
    // Yaw turns back from -Z towards +X, pitch from +Y towards -Z, and roll from +X towards +Y.
    double x = d[0] * cos(yaw) - d[2] * sin(yaw), y = d[1], z = d[2] * cos(yaw) + d[0] * sin(yaw);
    double y2 = y * cos(pitch) + z * sin(pitch), z2 = z * cos(pitch) - y * sin(pitch);
    double x3 = x * cos(roll) - y2 * sin(roll), y3 = x * sin(roll) + y2 * cos(roll);
    from[0] = x3;
    from[1] = def->up == KILN_UP_Z ? -z2 : def->up == KILN_UP_MINUS_Z ? z2 : y3;
    from[2] = def->up == KILN_UP_Z ? y3 : def->up == KILN_UP_MINUS_Z ? -y3 : z2;
}

static const kiln_prefilter_def turns[] = {
    {.rotation = 0, .pitch = 90},
    {.up = KILN_UP_Z},
    {.up = KILN_UP_MINUS_Z},
    {.rotation = 37, .pitch = -21, .roll = 65},
    {.rotation = -120, .pitch = 170, .roll = -8, .up = KILN_UP_Z},
    {.roll = 33},
};
enum { TURNS = sizeof turns / sizeof *turns };

// A picture with detail, a sun of one texel, and a gradient.
static kiln_map make_source(kiln_shape shape)
{
    kiln_map map = make_map(context, shape, shape == KILN_SHAPE_PANORAMA ? ROWS : SIZE, 1);
    fill_noise(&map, 5, 0, 0.5);
    for (size_t i = 0; i < kiln_map_texels(&map, 0); i++) {
        double d[3];
        kiln_map_direction(&map, 0, i, d);
        for (size_t c = 0; c < 3; c++)
            map.level[0][3 * i + c] += (float)(1 + d[c]);
    }
    map.level[0][3 * 777] = 5000;
    return map;
}

// `turn` may have a size and four numbers of roughness, which are 64 and `roughness` without.
static kiln_environment bake(const kiln_map *source, const kiln_prefilter_def *turn,
                             kiln_shape shape)
{
    static const float roughness[] = {0, 0.3f, 0.6f, 1};
    kiln_bake_def def = {.levels = *turn, .irradiance_size = 8, .sh_bands = 5};
    def.levels.shape = shape;
    def.levels.size = turn->size ? turn->size : 64;
    def.levels.level_count = 4;
    def.levels.roughness = turn->roughness ? turn->roughness : roughness;
    kiln_environment made;
    CHECK_OK(kiln_bake(context, source, &def, &made, &error));
    return made;
}

// Filtered levels, with their sun, against brute force over the texels of the untilted panorama in
// the directions that the matrix names. The bound is that of the tests of levels that are not
// turned.
static void levels_are_those_of_brute_force(void **state)
{
    (void)state;
    kiln_map source = make_source(KILN_SHAPE_PANORAMA);
    for (int t = 0; t < TURNS; t++) {
        kiln_shape shape = (kiln_shape)(KILN_SHAPE_PANORAMA + t % 3);
        kiln_environment made = bake(&source, &turns[t], shape);
        for (int k = 1; k < 4; k++) {
            enum { COUNT = 8 };
            double directions[COUNT][3], wanted[COUNT][3];
            size_t texels[COUNT];
            uint64_t random = (uint64_t)t * 10 + (uint64_t)k;
            for (int i = 0; i < COUNT; i++) {
                double d[3];
                texels[i] =
                    (size_t)(random_number(&random) * (double)kiln_map_texels(&made.levels, k));
                kiln_map_direction(&made.levels, k, texels[i], d);
                source_of(&turns[t], d, directions[i]);
            }
            double r = (double)made.levels.roughness[k];
            kiln_lobe lobe = kiln_lobe_ggx(r * r);
            CHECK_OK(kiln_reference_filter(context, &source, &lobe, 0,
                                           (const double(*)[3])directions, COUNT, wanted, &error));
            for (int i = 0; i < COUNT; i++)
                for (int c = 0; c < 3; c++)
                    CHECK_NEAR((double)made.levels.level[k][3 * texels[i] + (size_t)c],
                               wanted[i][c], 1.5e-4 * wanted[i][c]);
        }
        kiln_environment_free(&made);
    }
    kiln_map_free(&source);
}

// Small bakes without a mirror level.
static const float filtered[] = {0.25f, 0.4f, 0.6f, 1};
static const kiln_prefilter_def unturned = {.size = 16, .roughness = filtered};

// Harmonics and irradiance of a turned environment against those of the unturned one, in turned
// directions.
static void harmonics_and_irradiance_turn_along(void **state)
{
    (void)state;
    for (int cube = 0; cube < 2; cube++) {
        kiln_map source = make_source(cube ? KILN_SHAPE_CUBE : KILN_SHAPE_PANORAMA);
        kiln_environment plain = bake(&source, &unturned, KILN_SHAPE_CUBE);
        kiln_sh light;
        CHECK_OK(kiln_sh_filter(&plain.sh, 5, true, 0, &light, &error));
        for (int t = 0; t < TURNS; t++) {
            kiln_prefilter_def turn = turns[t];
            turn.size = unturned.size;
            turn.roughness = unturned.roughness;
            kiln_environment made = bake(&source, &turn, KILN_SHAPE_CUBE);
            uint64_t random = 3;
            for (int i = 0; i < 50; i++) {
                double d[3], from[3], a[3], b[3];
                random_direction(&random, d);
                source_of(&turns[t], d, from);
                kiln_sh_evaluate(&made.sh, d, a);
                kiln_sh_evaluate(&plain.sh, from, b);
                for (int c = 0; c < 3; c++)
                    CHECK_NEAR(a[c], b[c], 1e-6 * plain.sh.c[0][0]);
            }
            // Five bands hold the irradiance but for a part of 3e-3 of the sun's.
            for (size_t i = 0; i < kiln_map_texels(&made.irradiance, 0); i++) {
                double d[3], from[3], b[3];
                kiln_map_direction(&made.irradiance, 0, i, d);
                source_of(&turns[t], d, from);
                kiln_sh_evaluate(&light, from, b);
                for (int c = 0; c < 3; c++)
                    CHECK_NEAR((double)made.irradiance.level[0][3 * i + (size_t)c], b[c] / pi,
                               0.02 * light.c[0][0]);
            }
            kiln_environment_free(&made);
        }
        kiln_environment_free(&plain);
        kiln_map_free(&source);
    }
}

// A cube turned by quarter turns keeps its texels bit by bit, each in the direction that the matrix
// names.
static void quarter_turns_move_texels(void **state)
{
    (void)state;
    kiln_map source = make_noise(context, KILN_SHAPE_CUBE, 8, 1), made;
    static const kiln_prefilter_def quarters[] = {
        {.up = KILN_UP_Z},
        {.up = KILN_UP_MINUS_Z},
        {.pitch = 90},
        {.roll = -90},
        {.rotation = 90, .pitch = 180, .roll = 270},
    };
    for (size_t t = 0; t < sizeof quarters / sizeof *quarters; t++) {
        kiln_prefilter_def def = quarters[t];
        def.size = 8;
        def.level_count = 1;
        CHECK_OK(kiln_prefilter(context, &source, &def, &made, &error));
        for (size_t i = 0; i < kiln_map_texels(&made, 0); i++) {
            double d[3], from[3], best = -2;
            size_t nearest = 0;
            kiln_map_direction(&made, 0, i, d);
            source_of(&def, d, from);
            for (size_t k = 0; k < kiln_map_texels(&source, 0); k++) {
                kiln_map_direction(&source, 0, k, d);
                double dot = d[0] * from[0] + d[1] * from[1] + d[2] * from[2];
                nearest = dot > best ? k : nearest;
                best = fmax(best, dot);
            }
            CHECK_NEAR(best, 1, 1e-12);
            assert_memory_equal(made.level[0] + 3 * i, source.level[0] + 3 * nearest,
                                3 * sizeof(float));
        }
        kiln_map_free(&made);
    }
    kiln_map_free(&source);
}

// The mirror image of a smooth panorama, and of a sun, in any shape.
static void the_mirror_image_turns_along(void **state)
{
    (void)state;
    kiln_map source = make_panorama(context, 128);
    fill_gradient(&source, 0, 1);
    for (int t = 0; t < TURNS; t++)
        for (kiln_shape shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++) {
            kiln_environment made = bake(&source, &turns[t], shape);
            for (size_t i = 0; i < kiln_map_texels(&made.levels, 0); i++) {
                double d[3], from[3];
                kiln_map_direction(&made.levels, 0, i, d);
                source_of(&turns[t], d, from);
                // Half the size of a texel of the panorama, and what the mean over a texel differs
                // from its centre.
                for (size_t c = 0; c < 3; c++)
                    CHECK_NEAR((double)made.levels.level[0][3 * i + c], 2 + from[c],
                               pi / 256 + 1e-3);
            }
            kiln_environment_free(&made);
        }
    fill_constant(&source, 0);
    texel_at(&source, 40, 50)[1] = 1000;
    // Light that is sorted into texels of another width moves by half the difference of the widths
    // at most.
    const double apart = (2.0 / 64 - pi / 128 * sin(50.5 / 128 * pi)) / 2;
    double place[3], x = (40.5 / 128 - 1) * pi, z = 50.5 / 128 * pi;
    place[0] = sin(z) * sin(x), place[1] = cos(z), place[2] = -sin(z) * cos(x);
    for (int t = 0; t < TURNS; t++) {
        kiln_prefilter_def def = turns[t];
        def.size = 64;
        def.level_count = 1;
        kiln_map made;
        kiln_sh before, after;
        CHECK_OK(kiln_prefilter(context, &source, &def, &made, &error));
        CHECK_OK(kiln_map_sh(context, &source, 2, 0, &before, &error));
        CHECK_OK(kiln_map_sh(context, &made, 2, 0, &after, &error));
        CHECK_NEAR(after.c[0][1] / before.c[0][1], 1, 0.02);
        double length = sqrt(3.0) * after.c[0][1];
        double d[3] = {after.c[3][1] / length, after.c[1][1] / length, after.c[2][1] / length},
               from[3];
        source_of(&turns[t], d, from);
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(from[c], place[c], apart);
        kiln_map_free(&made);
    }
    kiln_map_free(&source);
}

static kiln_prefilter_def random_turn(uint64_t *random)
{
    return (kiln_prefilter_def){.size = 16,
                                .roughness = filtered,
                                .rotation = 720 * random_number(random) - 360,
                                .pitch = 720 * random_number(random) - 360,
                                .roll = 720 * random_number(random) - 360};
}

// The angles of the inverse turn. By the formulas of source_of a turn maps d to m d, where m has
// the third row (cos pitch sin yaw, -sin pitch, cos pitch cos yaw) and the second column (-sin roll
// cos pitch, cos roll cos pitch, -sin pitch). The inverse has the transposed matrix.
static kiln_prefilter_def inverse_of(const kiln_prefilter_def *turn)
{
    double m[3][3];
    for (int axis = 0; axis < 3; axis++)
        source_of(turn, (double[3]){axis == 0, axis == 1, axis == 2},
                  m[axis]); // column of m, row of the inverse
    return (kiln_prefilter_def){.size = 16,
                                .roughness = filtered,
                                .rotation = atan2(m[2][0], m[2][2]) * 180 / pi,
                                .pitch = asin(-m[2][1]) * 180 / pi,
                                .roll = atan2(-m[0][1], m[1][1]) * 180 / pi};
}

static kiln_map panorama_of(const kiln_sh *sh, int rows)
{
    kiln_map map = make_panorama(context, rows);
    for (size_t i = 0; i < kiln_map_texels(&map, 0); i++) {
        double d[3], rgb[3];
        kiln_map_direction(&map, 0, i, d);
        kiln_sh_evaluate(sh, d, rgb);
        for (size_t c = 0; c < 3; c++)
            map.level[0][3 * i + c] = (float)rgb[c];
    }
    return map;
}

// A panorama of four bands is turned by a bake; the panorama of the turned harmonics is turned back
// by a second bake. Everything is as in the bake of the first panorama. Texels are constant, which
// makes the harmonics of degree l smaller by l (l + 1) / 24 h^2 for texels of the size h, in each
// of the two panoramas, or less at the poles.
static void a_turn_and_its_inverse_cancel(void **state)
{
    (void)state;
    enum { FINE = 256 };
    const double h = pi / FINE, bound = 2 * 3 * 4 / 24.0 * h * h;
    uint64_t random = 11;
    kiln_sh sh = {.bands = 4, .c = {{4, 5, 6}}};
    for (int i = 1; i < 16; i++)
        for (int c = 0; c < 3; c++)
            sh.c[i][c] = random_number(&random) - 0.5;
    kiln_map first = panorama_of(&sh, FINE);
    kiln_environment plain = bake(&first, &unturned, KILN_SHAPE_CUBE);
    for (int n = 0; n < 4; n++) {
        kiln_prefilter_def turn = random_turn(&random), back = inverse_of(&turn);
        kiln_environment turned = bake(&first, &turn, KILN_SHAPE_CUBE);
        turned.sh.bands = 4;
        kiln_map second = panorama_of(&turned.sh, FINE);
        kiln_environment made = bake(&second, &back, KILN_SHAPE_CUBE);
        for (int i = 0; i < 16; i++)
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(made.sh.c[i][c], plain.sh.c[i][c], bound);
        for (int k = 0; k < 4; k++)
            for (size_t i = 0; i < 3 * kiln_map_texels(&made.levels, k); i++)
                CHECK_NEAR((double)made.levels.level[k][i], (double)plain.levels.level[k][i],
                           2 * bound);
        kiln_environment_free(&turned);
        kiln_environment_free(&made);
        kiln_map_free(&second);
    }
    kiln_environment_free(&plain);
    kiln_map_free(&first);
}

// The angles (yaw + 180, 180 - pitch, roll + 180) are the turn (yaw, pitch, roll). Levels and
// harmonics are the same up to rounding, which is that of floats for a sun of 5000 in a picture of
// about 2; so is a bake without a turn and one turned by (180, 180, 180), which takes the ways of
// turned bakes.
static void angles_of_the_same_turn_bake_alike(void **state)
{
    (void)state;
    kiln_map source = make_source(KILN_SHAPE_PANORAMA);
    uint64_t random = 7;
    for (int n = 0; n < 5; n++) {
        kiln_prefilter_def turn = n ? random_turn(&random) : unturned;
        kiln_prefilter_def same = turn;
        same.rotation += 180;
        same.pitch = 180 - turn.pitch;
        same.roll += 180;
        kiln_environment a = bake(&source, &turn, KILN_SHAPE_CUBE);
        kiln_environment b = bake(&source, &same, KILN_SHAPE_CUBE);
        for (int k = 0; k < 4; k++)
            for (size_t i = 0; i < 3 * kiln_map_texels(&a.levels, k); i++) {
                double value = (double)a.levels.level[k][i];
                CHECK_NEAR((double)b.levels.level[k][i], value, 1e-6 * value);
            }
        for (int i = 0; i < 25; i++)
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(b.sh.c[i][c], a.sh.c[i][c], 1e-12 * a.sh.c[0][c]);
        kiln_environment_free(&a);
        kiln_environment_free(&b);
    }
    kiln_map_free(&source);
}

static void angles_out_of_range_are_refused(void **state)
{
    (void)state;
    kiln_map source = make_noise(context, KILN_SHAPE_PANORAMA, 8, 1), made;
    const kiln_prefilter_def bad[] = {{.pitch = NAN}, {.roll = 2e6}, {.up = (kiln_up)3}};
    for (int i = 0; i < 3; i++)
        assert_int_equal(kiln_prefilter(context, &source, &bad[i], &made, &error),
                         KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "up is 3, it must be 0 to 2");
    kiln_map_free(&source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_are_those_of_brute_force),
        cmocka_unit_test(harmonics_and_irradiance_turn_along),
        cmocka_unit_test(quarter_turns_move_texels),
        cmocka_unit_test(the_mirror_image_turns_along),
        cmocka_unit_test(a_turn_and_its_inverse_cancel),
        cmocka_unit_test(angles_of_the_same_turn_bake_alike),
        cmocka_unit_test(angles_out_of_range_are_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}

// Lights that are taken out of a map and the map that remains are together as bright as the map: in
// every harmonic of five bands and in the irradiance of every surface. Scenes whose lights are
// known, and kiln's sky.
#include "bake/sky.h"
#include "image/texel.h"
#include "math/math.h"
#include "sphere/sh.h"

#include "kit/lights.h"

#include "kit/context.h"

static const double sun_colour[3] = {1, 0.9, 0.7};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double degrees_between(const double a[3], const double b[3])
{
    double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return 2 * asin(fmin(1, sqrt(x * x + y * y + z * z) / 2)) * 180 / pi;
}

static void normalize(double d[3])
{
    double length = sqrt(dot(d, d));
    for (int k = 0; k < 3; k++)
        d[k] /= length;
}

// Side in degrees of a texel: the largest of a panorama and a cube, an average one of an
// octahedron.
static double texel_degrees(const kiln_map *map)
{
    static const double sides[] = {0, 180, 90, 203};
    return sides[map->shape] / map->size;
}

// ------------------------------------------------------------------------------------------ scenes

// A calm scene: a bright upper and a darker lower half, multiplied by noise between 0.5 and 2.
static kiln_map calm(kiln_shape shape, int size)
{
    kiln_map map = make_noise(context, shape, size, 11);
    for (size_t i = 0; i < kiln_map_texels(&map, 0); i++) {
        double d[3];
        kiln_map_direction(&map, 0, i, d);
        for (size_t c = 0; c < 3; c++) {
            float *value = map.level[0] + 3 * i + c;
            *value = (float)((1 + 0.5 * d[1]) * (0.5 + 1.5 * (double)*value));
        }
    }
    return map;
}

typedef struct known {
    double vector[3]; // vector irradiance of what was painted, as the mean of the channels
    double irradiance[3];
} known;

// Adds a disc of a radius in degrees and a radiance to a map, with a part of each texel at the
// disc's edge, and adds the disc to what is known. `most` limits the texels.
static void paint(kiln_map *map, const double centre[3], double radius, double radiance,
                  double most, known *k)
{
    double nearest = cos((radius + 2 * texel_degrees(map)) * pi / 180),
           edge = cos(radius * pi / 180);
    for (size_t i = 0; i < kiln_map_texels(map, 0); i++) {
        ki_texel_nodes nodes;
        double d[3], covered = 0, solid = 0;
        kiln_map_direction(map, 0, i, d);
        if (dot(d, centre) < nearest)
            continue;
        ki_texel_nodes_find(map, i, 4, &nodes);
        for (int n = 0; n < nodes.count; n++) {
            solid += nodes.weight[n];
            covered += dot(nodes.direction[n], centre) > edge ? nodes.weight[n] : 0;
        }
        for (size_t c = 0; c < 3; c++) {
            float *value = map->level[0] + 3 * i + c, before = *value;
            double wanted = (double)before + radiance * sun_colour[c] * covered / solid;
            *value = (float)fmin(wanted, most);
            for (int n = 0; n < nodes.count; n++) {
                double light = ((double)*value - (double)before) * nodes.weight[n];
                k->irradiance[c] += light * dot(nodes.direction[n], centre);
                for (int a = 0; a < 3; a++)
                    k->vector[a] += light * nodes.direction[n][a] / 3;
            }
        }
    }
}

// Adds glow that falls off as 1 / angle^2 and holds a tenth of the light of a disc of 1 degree.
static void paint_bloom(kiln_map *map, const double centre[3], double radiance)
{
    for (size_t i = 0; i < kiln_map_texels(map, 0); i++) {
        double d[3];
        kiln_map_direction(map, 0, i, d);
        double angle = degrees_between(d, centre);
        for (size_t c = 0; c < 3 && angle < 15; c++)
            map->level[0][3 * i + c] += (float)(0.006 * radiance / (1 + angle * angle));
    }
}

// ------------------------------------------------------------------------------------------- laws

// Nothing is brighter or more negative than before, only texels of lights differ, and lights shine.
static void check_signs(const kiln_map *map, const kiln_map *left, const kiln_lights *lights)
{
    size_t changed = 0, texels = 0;
    for (size_t i = 0; i < kiln_map_texels(map, 0); i++) {
        bool differs = false;
        for (size_t c = 0; c < 3; c++) {
            float before = map->level[0][3 * i + c], after = left->level[0][3 * i + c];
            differs |= before != after;
            assert_true(after == before || (after >= 0 && (after < before || before < 0)));
        }
        changed += differs;
    }
    for (int n = 0; n < lights->count; n++) {
        const kiln_light *light = &lights->light[n];
        texels += light->texel_count;
        CHECK_NEAR(dot(light->direction, light->direction), 1, 1e-12);
        assert_true(light->share > 0 && light->share <= 1 && light->angular_radius > 0);
        assert_true(n == 0 || light->share <= light[-1].share);
        for (int c = 0; c < 3; c++)
            assert_true(light->irradiance[c] >= 0);
    }
    assert_true(changed <= texels);
    assert_true((changed > 0) == (lights->count > 0));
}

static kiln_map copy_of(const kiln_map *map)
{
    kiln_map copy = make_map(context, map->shape, map->size, 1);
    memcpy(copy.level[0], map->level[0], 3 * sizeof(float) * kiln_map_texels(map, 0));
    return copy;
}

// Takes `count` lights out of a map, checks every law, and frees the map.
static kiln_lights extract(kiln_map *map, int count, bool whole_check)
{
    kiln_lights lights, found;
    const kiln_lights_def def = {.count = count, .share = 0.001};
    kiln_map left = copy_of(map);
    CHECK_OK(kiln_lights_find(context, map, &def, &found, &error));
    CHECK_OK(kiln_lights_extract(context, &left, &def, &lights, &error));
    assert_memory_equal(&lights, &found, sizeof lights);
    check_signs(map, &left, &lights);
    check_light_harmonics(context, map, &left, &lights);
    if (whole_check)
        check_light_irradiance(context, map, &left, &lights);
    kiln_map_free(&left);
    kiln_map_free(map);
    return lights;
}

// Checks a light against what was painted.
static void check_known(const kiln_light *light, const known *k, double texel)
{
    double d[3] = {k->vector[0], k->vector[1], k->vector[2]};
    normalize(d);
    CHECK_BELOW(degrees_between(light->direction, d), texel / 2);
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(light->irradiance[c], k->irradiance[c], 0.02 * k->irradiance[c]);
}

// ------------------------------------------------------------------------------------------- tests

static const kiln_shape shapes[] = {KILN_SHAPE_PANORAMA, KILN_SHAPE_CUBE, KILN_SHAPE_OCTAHEDRON};
static const int sizes[] = {128, 96, 128};

// Inside, on the seam, on both poles, on an edge and on a corner of a cube.
static void a_sun_is_found_wherever_it_stands(void **state)
{
    (void)state;
    static const double places[][3] = {{0.6, 0.3, -0.74}, {0.003, 0.2, 1}, {0, 1, 0.001},
                                       {0, -1, 0},        {1, 0.999, 0.2}, {1, 1, 1}};
    for (int s = 0; s < 3; s++)
        for (size_t p = 0; p < sizeof places / sizeof *places; p++) {
            kiln_map map = calm(shapes[s], sizes[s]);
            known k = {{0}, {0}};
            double texel = texel_degrees(&map), at[3] = {places[p][0], places[p][1], places[p][2]};
            normalize(at);
            paint(&map, at, 1.5, 2000, HUGE_VAL, &k);
            kiln_lights lights = extract(&map, 4, p == 1);
            assert_int_equal(lights.count, 1);
            check_known(&lights.light[0], &k, texel);
            CHECK_NEAR(lights.light[0].angular_radius, 1.5, 0.5 * texel);
        }
}

static void a_cut_off_sun_with_bloom_is_one_light(void **state)
{
    (void)state;
    const double at[3] = {0.6, 0.64, -0.48};
    kiln_map map = calm(KILN_SHAPE_PANORAMA, 128);
    known k = {{0}, {0}};
    paint(&map, at, 1.5, 5000, 1200, &k);
    paint_bloom(&map, at, 1200);
    double texel = texel_degrees(&map);
    kiln_lights lights = extract(&map, 4, true);
    assert_int_equal(lights.count, 1);
    CHECK_BELOW(degrees_between(lights.light[0].direction, at), texel / 2);
    for (int c = 0; c < 3; c++)
        assert_true(lights.light[0].irradiance[c] > 0.98 * k.irradiance[c] &&
                    lights.light[0].irradiance[c] < 1.3 * k.irradiance[c]);
}

// Lossy compression leaves negative texels beside a sun, whose sum belongs to the sun.
static void negative_texels_beside_a_sun_go_with_the_sun(void **state)
{
    (void)state;
    kiln_map map = calm(KILN_SHAPE_PANORAMA, 128);
    static const int offset[4][2] = {{2, 0}, {-1, 0}, {0, 2}, {1, -1}};
    for (int y = 40; y < 42; y++)
        for (int x = 70; x < 72; x++)
            for (int c = 0; c < 3; c++)
                texel_at(&map, x, y)[c] = 3000;
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 3; c++)
            texel_at(&map, 70 + offset[i][0], 40 + offset[i][1])[c] = -200;
    texel_at(&map, 10, 90)[1] = -5; // far away: stays
    kiln_map left = copy_of(&map);
    kiln_lights lights;
    CHECK_OK(kiln_lights_extract(context, &left, NULL, &lights, &error));
    assert_int_equal(lights.count, 1);
    assert_int_equal(lights.light[0].texel_count, 8);
    for (int i = 0; i < 4; i++)
        assert_true(texel_at(&left, 70 + offset[i][0], 40 + offset[i][1])[0] > 0);
    assert_true(texel_at(&left, 10, 90)[1] == -5);
    kiln_map_free(&left);
    extract(&map, 1, true);
}

static void two_suns_a_window_and_lamps_are_told_apart(void **state)
{
    (void)state;
    kiln_map map = calm(KILN_SHAPE_PANORAMA, 128);
    known k[9] = {{{0}, {0}}};
    double at[9][3] = {{0.6, 0.64, -0.48}, {0.48, 0.64, -0.6}};
    for (int i = 2; i < 9; i++) {
        // A row of lamps, 12 degrees apart.
        at[i][0] = sin(i * pi / 15), at[i][1] = 0.1, at[i][2] = cos(i * pi / 15);
        normalize(at[i]);
    }
    for (int i = 0; i < 9; i++)
        paint(&map, at[i], 1.5, i < 2 ? 4000 - 1000 * i : 900 - 60 * i, HUGE_VAL, &k[i]);
    kiln_lights lights = extract(&map, 16, true);
    assert_int_equal(lights.count, 9);
    for (int i = 0; i < 9; i++) {
        int nearest = 0;
        for (int n = 1; n < 9; n++)
            if (degrees_between(lights.light[n].direction, at[i]) <
                degrees_between(lights.light[nearest].direction, at[i]))
                nearest = n;
        check_known(&lights.light[nearest], &k[i], 180.0 / 128);
    }

    // A window of 8 x 6 degrees with a cross in its middle.
    map = calm(KILN_SHAPE_PANORAMA, 256);
    for (int y = 100; y < 109; y++)
        for (int x = 200; x < 212; x++)
            for (int c = 0; c < 3; c++)
                texel_at(&map, x, y)[c] = x == 206 || y == 104 ? 1 : 200;
    lights = extract(&map, 16, true);
    assert_int_equal(lights.count, 1);
    double centre[3];
    panorama_direction(256, 206, 104.5, centre);
    CHECK_BELOW(degrees_between(lights.light[0].direction, centre), 0.5 * 180 / 256);
}

static void nothing_is_found_where_nothing_stands_out(void **state)
{
    (void)state;
    for (int s = 0; s < 3; s++) {
        kiln_map map = calm(shapes[s], sizes[s]);
        assert_int_equal(extract(&map, 0, false).count, 0);
        map = make_map(context, shapes[s], sizes[s], 1); // black
        assert_int_equal(extract(&map, 0, false).count, 0);
        // A bright quarter of the sky is no compact light.
        map = calm(shapes[s], sizes[s]);
        const double up[3] = {0, 1, 0};
        known k = {{0}, {0}};
        paint(&map, up, 60, 5000, HUGE_VAL, &k);
        assert_int_equal(extract(&map, 0, false).count, 0);
    }
}

// The light of kiln's own sun is known: its direction and its disc's radiance.
static void the_skys_sun_is_the_skys_sun(void **state)
{
    (void)state;
    static const double elevations[] = {2, 3, 5, 10, 20, 30, 45, 60, 75, 85, 89.5, 90};
    enum { SIZE = 256 };
    double solid = pi * sin(ki_sun_radius) * sin(ki_sun_radius);
    for (size_t i = 0; i < sizeof elevations / sizeof *elevations; i++) {
        const double azimuth = 179.9 + 31 * (double)i, albedo = 0.2;
        kiln_map map;
        ki_sky sky;
        const kiln_sky_def def = {.size = SIZE, .elevation = elevations[i], .azimuth = azimuth};
        CHECK_OK(kiln_sky(context, &def, &map, &error));
        ki_sky_prepare(&sky, elevations[i], azimuth, 3, albedo);
        kiln_lights lights = extract(&map, 4, i % 4 == 1);
        assert_int_equal(lights.count, 1);
        const kiln_light *sun = &lights.light[0];
        CHECK_BELOW(degrees_between(sun->direction, sky.sun), 0.5 * 180 / SIZE);
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(sun->irradiance[c], sky.sun_radiance[c] * solid,
                       0.01 * sky.sun_radiance[c] * solid + 0.002 * sky.sun_radiance[0] * solid);
    }
    for (double elevation = -2; elevation < 0; elevation += 0.5) {
        kiln_map map;
        const kiln_sky_def def = {.size = SIZE, .elevation = elevation};
        CHECK_OK(kiln_sky(context, &def, &map, &error));
        assert_int_equal(extract(&map, 0, false).count, 0);
    }
}

// In a small panorama the sun is one texel or two, whose rectangle is no disc.
static void a_sun_of_few_texels_is_a_light(void **state)
{
    (void)state;
    for (int elevation = 10; elevation <= 90; elevation += 8) {
        kiln_map map;
        ki_sky sky;
        const kiln_sky_def def = {.size = 64, .elevation = elevation, .azimuth = 7.0 * elevation};
        CHECK_OK(kiln_sky(context, &def, &map, &error));
        ki_sky_prepare(&sky, elevation, 7.0 * elevation, 3, 0.2);
        kiln_lights lights = extract(&map, 4, false);
        assert_int_equal(lights.count, 1);
        CHECK_BELOW(degrees_between(lights.light[0].direction, sky.sun), 0.5 * 180 / 64);
    }
}

// ------------------------------------------------------------------------------------------- bakes

static void a_bake_without_its_sun_is_the_bake_of_what_remains(void **state)
{
    (void)state;
    const double at[3] = {0.6, 0.64, -0.48};
    for (int s = 0; s < 3; s++) {
        kiln_map map = calm(shapes[s], sizes[s] / 2);
        known k = {{0}, {0}};
        paint(&map, at, 4, 3000, HUGE_VAL, &k);
        kiln_bake_def def = {
            .levels = {.size = 8, .rotation = 90}, .irradiance_size = 4, .sun = KILN_SUN_EXTRACT};
        kiln_environment made, wanted;
        CHECK_OK(kiln_bake(context, &map, &def, &made, &error));
        kiln_lights lights;
        CHECK_OK(kiln_lights_extract(context, &map, NULL, &lights, &error));
        assert_int_equal(lights.count, 1);
        def.sun = KILN_SUN_KEEP;
        CHECK_OK(kiln_bake(context, &map, &def, &wanted, &error));
        check_same_levels(&made.levels, &wanted.levels);
        check_same_levels(&made.irradiance, &wanted.irradiance);
        assert_memory_equal(&made.sh, &wanted.sh, sizeof made.sh);
        assert_int_equal(wanted.lights.count, 0);
        assert_int_equal(made.lights.count, 1);
        // The content of a panorama moves to the left by a quarter: +X comes to -Z, -Z to -X.
        const double *d = lights.light[0].direction;
        const double turned[3] = {d[2], d[1], -d[0]};
        CHECK_BELOW(degrees_between(made.lights.light[0].direction, turned), 1e-9);
        kiln_environment_free(&made);
        kiln_environment_free(&wanted);
        kiln_map_free(&map);
    }
}

static void a_clamp_keeps_colours_and_tells_what_was_lost(void **state)
{
    (void)state;
    const double at[3] = {0.6, 0.64, -0.48}, limits[] = {100, 0};
    for (int i = 0; i < 2; i++) {
        kiln_map map = calm(KILN_SHAPE_PANORAMA, 64);
        known k = {{0}, {0}};
        paint(&map, at, 4, 3000, HUGE_VAL, &k);
        kiln_map clamped = copy_of(&map);
        kiln_clamp clamp;
        double before = 0, after = 0;
        size_t changed = 0;
        CHECK_OK(kiln_map_clamp(context, &clamped, limits[i], &clamp, &error));
        for (size_t t = 0; t < kiln_map_texels(&map, 0); t++) {
            const float *a = map.level[0] + 3 * t, *b = clamped.level[0] + 3 * t;
            double weight = ki_texel_solid_angle(&map, t);
            for (int c = 0; c < 3; c++) {
                before += weight * (double)a[c];
                after += weight * (double)b[c];
                CHECK_BELOW((double)b[c], clamp.limit * (1 + 1e-6));
                CHECK_NEAR((double)b[c] * (double)a[0], (double)b[0] * (double)a[c],
                           1e-6 * (double)b[c] * (double)a[0]);
            }
            changed += a[0] != b[0];
        }
        assert_true(changed > 0 && changed == clamp.texel_count);
        CHECK_NEAR(clamp.light_share, 1 - after / before, 1e-12);
        assert_true(i ? clamp.limit > 20 && clamp.limit < 60 : clamp.limit == 100);
        kiln_environment made;
        const kiln_bake_def def = {
            .levels = {.size = 8}, .sun = KILN_SUN_CLAMP, .clamp = limits[i]};
        CHECK_OK(kiln_bake(context, &map, &def, &made, &error));
        assert_memory_equal(&made.clamped, &clamp, sizeof clamp);
        kiln_environment_free(&made);
        kiln_map_free(&map);
        kiln_map_free(&clamped);
    }
}

static void wrong_numbers_are_named(void **state)
{
    (void)state;
    kiln_map map = make_panorama(context, 16);
    kiln_lights lights;
    kiln_sh sh;
    kiln_lights_def def = {.count = 65};
    assert_int_equal(kiln_lights_find(context, &map, &def, &lights, &error), KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "count of lights is 65, it must be 0 to 64");
    def = (kiln_lights_def){.share = 1.5};
    assert_int_equal(kiln_lights_extract(context, &map, &def, &lights, &error),
                     KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "share of lights is 1.5, it must be 0 to 1");
    assert_int_equal(kiln_map_clamp(context, &map, -1, NULL, &error), KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "limit of a clamp is -1");
    assert_int_equal(kiln_lights_sh(&lights, 6, &sh, &error), KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "bands is 6");
    kiln_environment made;
    kiln_bake_def bake = {.sun = (kiln_sun)3};
    assert_int_equal(kiln_bake(context, &map, &bake, &made, &error), KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "sun is 3, it must be 0 to 2");
    assert_int_equal(kiln_lights_save(context, &lights, "a.txt", &error), KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "a.txt: a file of lights must end in .json");
    kiln_map_free(&map);
}

static void memory_that_runs_out_is_an_error(void **state)
{
    (void)state;
    for (long n = 1;; n++) {
        failing f;
        kiln_error said;
        kiln_lights lights;
        kiln_context *c = failing_context(&f);
        kiln_map map = make_panorama(c, 64);
        fill_constant(&map, 1);
        texel_at(&map, 5, 5)[0] = 1e4f;
        f.fail_at = f.calls + n;
        kiln_result result = kiln_lights_extract(c, &map, NULL, &lights, &said);
        bool failed = f.calls >= f.fail_at;
        kiln_map_free(&map);
        kiln_context_destroy(c);
        assert_int_equal(f.held, 0);
        assert_int_equal(result, failed ? KILN_ERROR_MEMORY : KILN_OK);
        assert_int_equal(lights.count, failed ? 0 : 1);
        if (!failed)
            break;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sun_is_found_wherever_it_stands),
        cmocka_unit_test(a_cut_off_sun_with_bloom_is_one_light),
        cmocka_unit_test(negative_texels_beside_a_sun_go_with_the_sun),
        cmocka_unit_test(two_suns_a_window_and_lamps_are_told_apart),
        cmocka_unit_test(nothing_is_found_where_nothing_stands_out),
        cmocka_unit_test(the_skys_sun_is_the_skys_sun),
        cmocka_unit_test(a_sun_of_few_texels_is_a_light),
        cmocka_unit_test(a_bake_without_its_sun_is_the_bake_of_what_remains),
        cmocka_unit_test(a_clamp_keeps_colours_and_tells_what_was_lost),
        cmocka_unit_test(wrong_numbers_are_named),
        cmocka_unit_test(memory_that_runs_out_is_an_error),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}

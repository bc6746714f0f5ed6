// Photographed panoramas: whatever lights are taken out, the rest and the lights are together as
// bright as the panorama in every harmonic of five bands and in the irradiance of surfaces; each
// light is where its panorama shows it.
#include "image/texel.h"

#include "kit/lights.h"

#include "kit/context.h"

static void load(const char *name, kiln_map *map)
{
    char path[512];
    snprintf(path, sizeof path, "%s/blender/%s.exr", KILN_TEST_DATA, name);
    CHECK_OK(kiln_map_load(context, path, NULL, map, &error));
}

// The radiometric centroid of what is taken out of a panorama, by another sum than the library's.
static void centroid(const kiln_map *map, const kiln_map *left, double d[3])
{
    d[0] = d[1] = d[2] = 0;
    for (size_t i = 0; i < kiln_map_texels(map, 0); i++) {
        const float *a = map->level[0] + 3 * i, *b = left->level[0] + 3 * i;
        ki_texel_nodes nodes;
        double light = 0;
        for (int c = 0; c < 3; c++)
            light += (double)a[c] - (double)b[c];
        if (light == 0)
            continue;
        ki_texel_nodes_find(map, i, 4, &nodes);
        for (int n = 0; n < nodes.count; n++)
            for (int k = 0; k < 3; k++)
                d[k] += light * nodes.weight[n] * nodes.direction[n][k];
    }
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int k = 0; k < 3; k++)
        d[k] /= length;
}

static void check_energy(const kiln_map *map, const kiln_map *left, const kiln_lights *lights)
{
    check_light_harmonics(context, map, left, lights);
    for (size_t i = 0; i < 3 * kiln_map_texels(map, 0); i++) {
        float before = map->level[0][i], after = left->level[0][i];
        assert_true(after == before || (after >= 0 && (after < before || before < 0)));
    }
}

static kiln_map copy_of(const kiln_map *map)
{
    kiln_map copy = make_map(context, map->shape, map->size, 1);
    memcpy(copy.level[0], map->level[0], 3 * sizeof(float) * kiln_map_texels(map, 0));
    return copy;
}

// Takes lights out and checks the laws. Returns the lights.
static kiln_lights check(const kiln_map *map, int count)
{
    const kiln_lights_def def = {.count = count, .share = 0.01};
    kiln_lights lights;
    kiln_map left = copy_of(map);
    double d[3];
    CHECK_OK(kiln_lights_extract(context, &left, &def, &lights, &error));
    check_energy(map, &left, &lights);
    if (lights.count)
        check_light_irradiance(context, map, &left, &lights);
    if (lights.count == 1) {
        centroid(map, &left, d);
        for (int k = 0; k < 3; k++) // half a texel is 3e-3
            CHECK_NEAR(lights.light[0].direction[k], d[k], 1e-4);
    }
    kiln_map_free(&left);
    return lights;
}

// The suns, and the lamps and windows, that the eyes see in Blender's panoramas.
static void panoramas_keep_their_light(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        int count;                  // lights with a hundredth of the light
        double share, direction[3]; // of the largest light
    } cases[] = {{"sunrise", 1, 0.576, {0.580, 0.141, -0.802}},
                 {"city", 1, 0.227, {0.394, 0.741, -0.544}},
                 {"sunset", 1, 0.026, {0.586, 0.058, -0.808}},
                 {"interior", 3, 0.210, {-0.546, 0.838, -0.017}},
                 {"night", 6, 0.179, {-0.973, 0.111, -0.200}},
                 {"studio", 4, 0.220, {0.927, 0.085, -0.364}},
                 {"forest", 2, 0.062, {0.553, 0.334, -0.763}},
                 {"courtyard", 0, 0, {0, 0, 0}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        kiln_map map;
        load(cases[i].name, &map);
        check(&map, 1);
        kiln_lights lights = check(&map, KILN_MAX_LIGHTS);
        printf("%-10s %d lights, the largest holds %.3f\n", cases[i].name, lights.count,
               lights.light[0].share);
        assert_int_equal(lights.count, cases[i].count);
        CHECK_NEAR(lights.light[0].share, cases[i].share, 0.01);
        for (int k = 0; k < 3; k++)
            CHECK_NEAR(lights.light[0].direction[k], cases[i].direction[k], 3e-3);
        kiln_map_free(&map);
    }
}

// Panoramas of npm's @pmndrs/assets, whose compression left negative texels beside suns.
static void panoramas_with_negative_texels_keep_their_light(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        int count; // lights with a hundredth of the light
    } cases[] = {{"apartment", 0}, {"bridge", 3},  {"city", 0},   {"dawn", 0},
                 {"esplanade", 5}, {"forest", 3},  {"hall", 16},  {"lab", 7},
                 {"lobby", 4},     {"night", 0},   {"park", 1},   {"sky", 1},
                 {"studio", 2},    {"sunrise", 1}, {"sunset", 1}, {"venice", 0},
                 {"warehouse", 8}, {"workshop", 5}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        kiln_map map;
        size_t size;
        uint8_t *bytes = read_asset(KILN_ASSETS, cases[i].name, &size);
        CHECK_OK(kiln_map_decode(context, bytes, size, cases[i].name, NULL, &map, &error));
        check(&map, 1);
        int count = check(&map, KILN_MAX_LIGHTS).count;
        printf("%-10s %d lights\n", cases[i].name, count);
        assert_int_equal(count, cases[i].count);
        kiln_map_free(&map);
        free(bytes);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(panoramas_keep_their_light),
        cmocka_unit_test(panoramas_with_negative_texels_keep_their_light),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}

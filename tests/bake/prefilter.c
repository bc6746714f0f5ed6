// The mirror levels of cubes and octahedra come from their source, and each level states its
// roughness.
#include "kit/context.h"

static kiln_map mirror(const kiln_map *source, kiln_shape shape, int size, double rotation)
{
    kiln_map map;
    kiln_prefilter_def def = {.shape = shape, .size = size, .level_count = 1, .rotation = rotation};
    CHECK_OK(kiln_prefilter(context, source, &def, &map, &error));
    return map;
}

// The same size and a quarter turn: texels change places, not their bits.
static void mirrors_of_the_same_size_are_copies(void **state)
{
    (void)state;
    for (int shape = KILN_SHAPE_CUBE; shape <= KILN_SHAPE_OCTAHEDRON; shape++) {
        kiln_map source = make_noise(context, (kiln_shape)shape, 24, 7);
        size_t bytes = kiln_map_texels(&source, 0) * 3 * sizeof(float);
        kiln_map same = mirror(&source, source.shape, 24, 0);
        assert_memory_equal(same.level[0], source.level[0], bytes);
        kiln_map once = mirror(&source, source.shape, 24, 90);
        kiln_map back = mirror(&once, source.shape, 24, 270);
        assert_memory_not_equal(once.level[0], source.level[0], bytes);
        assert_memory_equal(back.level[0], source.level[0], bytes);
        kiln_map_free(&source);
        kiln_map_free(&same);
        kiln_map_free(&once);
        kiln_map_free(&back);
    }
}

static double mean_square(const float *a, const float *b, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += ((double)a[i] - (double)b[i]) * ((double)a[i] - (double)b[i]);
    return sum / (double)count;
}

// As kiln_map_convert has it from the source itself; from a panorama of it, which blurs once more,
// noise would lose some of its variance. Much smaller mirrors keep the whole light.
static void mirrors_of_other_sizes_come_from_the_source(void **state)
{
    (void)state;
    static const struct {
        kiln_shape from, to;
        int size;
        double rotation;
    } cases[] = {{KILN_SHAPE_CUBE, KILN_SHAPE_CUBE, 12, 0},
                 {KILN_SHAPE_CUBE, KILN_SHAPE_CUBE, 1, 180},
                 {KILN_SHAPE_CUBE, KILN_SHAPE_CUBE, 24, 30},
                 {KILN_SHAPE_CUBE, KILN_SHAPE_OCTAHEDRON, 48, 0},
                 {KILN_SHAPE_OCTAHEDRON, KILN_SHAPE_CUBE, 24, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        kiln_map source = make_noise(context, cases[i].from, 24, 7), converted;
        kiln_map got = mirror(&source, cases[i].to, cases[i].size, cases[i].rotation);
        CHECK_OK(kiln_map_convert(context, &source, cases[i].to, cases[i].size, cases[i].rotation,
                                  &converted, &error));
        CHECK_NEAR(mean_square(got.level[0], converted.level[0], 3 * kiln_map_texels(&got, 0)), 0,
                   0);
        kiln_map_free(&source);
        kiln_map_free(&got);
        kiln_map_free(&converted);
    }
    // A lone bright texel that few sub-samples of a coarse, turned mirror would meet.
    kiln_map source = make_map(context, KILN_SHAPE_CUBE, 256, 1);
    source.level[0][(size_t)3 * (256 * 256 * 4 + 256 * 128 + 128)] = 1e6f;
    kiln_map coarse = mirror(&source, KILN_SHAPE_CUBE, 1, 45);
    double sum = 0, wanted = 1e6 * (4.0 / (256 * 256)) / (4 * pi) * 6; // at a face's centre
    for (size_t f = 0; f < 6; f++)
        sum += (double)coarse.level[0][3 * f];
    CHECK_NEAR(sum, wanted, 1e-3 * wanted);
    kiln_map_free(&source);
    kiln_map_free(&coarse);
}

// Lambert has no roughness; its level is as rough as can be.
static void roughness_is_stated(void **state)
{
    (void)state;
    kiln_map source = make_noise(context, KILN_SHAPE_PANORAMA, 16, 7), map;
    kiln_prefilter_def def = {.size = 4};
    CHECK_OK(kiln_prefilter(context, &source, &def, &map, &error));
    for (int k = 0; k < 3; k++)
        CHECK_NEAR((double)map.roughness[k], 0.5 * k, 0);
    kiln_map_free(&map);
    def = (kiln_prefilter_def){.size = 4, .level_count = 1, .lobe = KILN_LOBE_LAMBERT};
    CHECK_OK(kiln_prefilter(context, &source, &def, &map, &error));
    CHECK_NEAR((double)map.roughness[0], 1, 0);
    kiln_map_free(&map);
    def = (kiln_prefilter_def){.size = 4, .level_count = 2, .roughness = (float[]){0.5f, 0.25f}};
    CHECK_OK(kiln_prefilter(context, &source, &def, &map, &error));
    CHECK_NEAR((double)map.roughness[0], 0.5, 0);
    CHECK_NEAR((double)map.roughness[1], 0.25, 0);
    kiln_map_free(&map);
    kiln_map_free(&source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mirrors_of_the_same_size_are_copies),
        cmocka_unit_test(mirrors_of_other_sizes_come_from_the_source),
        cmocka_unit_test(roughness_is_stated),
    };
    return cmocka_run_group_tests(tests, set_up_folder, tear_down_empty_folder);
}

// Maps: their levels and memory, the ranges of their sizes, and their exposure.
#include "kit/kit.h"

#include <float.h>

static kiln_error error;

static void maps_have_levels_aligned_and_zero(void **state)
{
    (void)state;
    kiln_context *context = make_context(1);
    for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++) {
        kiln_map map = make_map(context, (kiln_shape)shape, 13, 0);
        assert_int_equal(map.level_count, 4);
        static const int sizes[4] = {13, 6, 3, 1};
        static const size_t factor[3] = {2, 6, 1};
        for (int k = 0; k < 4; k++) {
            size_t n = (size_t)sizes[k];
            assert_int_equal(kiln_map_level_size(&map, k), sizes[k]);
            assert_int_equal(kiln_map_texels(&map, k), n * n * factor[shape - KILN_SHAPE_PANORAMA]);
            assert_int_equal((uintptr_t)map.level[k] % 64, 0);
            for (size_t i = 0; i < 3 * kiln_map_texels(&map, k); i++)
                assert_true(map.level[k][i] == 0);
        }
        kiln_map_free(&map);
        kiln_map_free(&map);
        assert_null(map.level[0]);
    }
    size_t held;
    kiln_context_memory(context, &held, NULL);
    assert_int_equal(held, 0);
    kiln_context_destroy(context);
}

static void numbers_out_of_range_are_refused_with_the_limit(void **state)
{
    (void)state;
    kiln_context *context = make_context(1);
    kiln_map map;
    kiln_image image;
    assert_int_equal(kiln_map_create(context, KILN_SHAPE_CUBE, -3, 1, &map, &error),
                     KILN_ERROR_ARGUMENT);
    assert_string_equal(error.message, "cube size is -3, it must be 1 to 32768");
    assert_null(map.owner);
    assert_int_equal(map.size, 0);
    assert_int_equal(kiln_map_create(context, KILN_SHAPE_PANORAMA, 32769, 0, &map, &error),
                     KILN_ERROR_ARGUMENT);
    assert_string_equal(error.message, "panorama size is 32769, it must be 1 to 32768");
    assert_int_equal(kiln_map_create(context, KILN_SHAPE_CUBE, 8, 17, &map, &error),
                     KILN_ERROR_ARGUMENT);
    assert_string_equal(error.message, "level_count is 17, it must be 1 to 16");
    assert_int_equal(kiln_map_create(context, (kiln_shape)7, 8, 1, &map, &error),
                     KILN_ERROR_ARGUMENT);
    assert_string_equal(error.message, "shape is 7, it must be 1 to 3");
    assert_int_equal(kiln_map_create(context, KILN_SHAPE_AUTO, 8, 1, &map, &error),
                     KILN_ERROR_ARGUMENT);
    assert_string_equal(error.message, "shape is 0, it must be 1 to 3");
    assert_int_equal(kiln_image_create(context, 4, 0, 3, &image, &error), KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "4 x 0");
    assert_int_equal(kiln_image_create(context, 4, 4, 5, &image, &error), KILN_ERROR_ARGUMENT);
    assert_null(image.pixels);
    kiln_map source = make_map(context, KILN_SHAPE_PANORAMA, 4, 1);
    assert_int_equal(kiln_map_convert(context, &source, KILN_SHAPE_CUBE, 0, 0, &map, &error),
                     KILN_ERROR_ARGUMENT);
    assert_int_equal(
        kiln_map_convert(context, &source, KILN_SHAPE_CUBE, 4, (double)NAN, &map, &error),
        KILN_ERROR_ARGUMENT);
    assert_null(map.owner);
    kiln_map_free(&source);
    size_t held;
    kiln_context_memory(context, &held, NULL);
    assert_int_equal(held, 0);
    kiln_context_destroy(context);
}

static void memory_limits_are_kept(void **state)
{
    (void)state;
    kiln_context *context;
    CHECK_OK(kiln_context_create(
        &(kiln_context_def){.thread_count = 1, .memory_limit = (size_t)1 << 20}, &context, &error));
    kiln_map map;
    assert_int_equal(kiln_map_create(context, KILN_SHAPE_CUBE, 32768, 0, &map, &error),
                     KILN_ERROR_MEMORY);
    assert_null(map.owner);
    kiln_context_destroy(context);
}

static void exposure_is_a_power_of_two(void **state)
{
    (void)state;
    kiln_context *context = make_context(1);
    kiln_map map = make_map(context, KILN_SHAPE_OCTAHEDRON, 2, 2);
    for (int k = 0; k < 4; k++)
        map.level[0][k] = (float)(k + 1);
    map.level[1][0] = 1;
    kiln_map_expose(&map, 3);
    for (int k = 0; k < 4; k++)
        assert_true(map.level[0][k] == (float)(8 * (k + 1)));
    kiln_map_expose(&map, -3.5);
    CHECK_NEAR((double)map.level[1][0], sqrt(0.5), 1e-7);
    kiln_map_expose(&map, 500);
    assert_true(map.level[0][3] == FLT_MAX);
    assert_true(map.level[0][4] == 0);
    kiln_map_free(&map);
    kiln_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_have_levels_aligned_and_zero),
        cmocka_unit_test(numbers_out_of_range_are_refused_with_the_limit),
        cmocka_unit_test(memory_limits_are_kept),
        cmocka_unit_test(exposure_is_a_power_of_two),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

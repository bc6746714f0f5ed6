// The textbook's prefiltered levels and irradiance do what they say, and err where
// docs/theory/textbook.md says that they do.
#include <kiln/course.h>

#include "kit/context.h"

// A picture that is 2 + d in direction d, channel by channel.
static kiln_map gradient(int size)
{
    kiln_map map = make_panorama(context, size);
    fill_gradient(&map, 0, 1);
    return map;
}

static kiln_map white(int size)
{
    kiln_map map = make_panorama(context, size);
    fill_constant(&map, 1);
    return map;
}

// Where a texel of the result looks, in kiln's axes: the textbook's panoramas put texels at
// i / (width - 1) and j / (height - 1).
static void looked(const kiln_map *map, int level, size_t index, double d[3])
{
    int size = kiln_map_level_size(map, level), width = 2 * size;
    if (map->shape != KILN_SHAPE_PANORAMA) {
        kiln_map_direction(map, level, index, d);
        return;
    }
    size_t row = index / (size_t)width;
    double u = (double)(index % (size_t)width) / (width - 1);
    double v = size > 1 ? (double)row / (size - 1) : 0.5;
    panorama_direction(size, u * width, v * size, d);
}

// The mean through GGX of the picture as the textbook reads it: size - 1 rows of 2 size - 1 columns
// stretched over the sphere.
static double stretched_mean(const kiln_map *map, double alpha, const double d[3], int n)
{
    return ggx_mean(map, 2 * map->size - 1, map->size - 1, alpha, d, n);
}

// The sum over theta is a trapezoid rule: white becomes (pi / 2n) cot(pi / 2n), 0.99992 for 100.
static void white_irradiance_is_the_trapezoids(void **state)
{
    (void)state;
    kiln_map source = white(8);
    static const int counts[] = {0, 1 + 2, 10, 250};
    for (int k = 0; k < 4; k++) {
        int n = counts[k] ? counts[k] : 100;
        kiln_map map;
        kiln_textbook_def def = {.size = 4, .theta_count = counts[k], .phi_count = counts[k]};
        CHECK_OK(kiln_textbook_irradiance(context, &source, &def, &map, &error));
        assert_int_equal(map.shape, KILN_SHAPE_PANORAMA);
        assert_int_equal(map.level_count, 1);
        double wanted = pi / (2 * n) / tan(pi / (2 * n));
        for (size_t i = 0; i < 3 * kiln_map_texels(&map, 0); i++)
            CHECK_NEAR((double)map.level[0][i], wanted, 1e-6);
        kiln_map_free(&map);
    }
    kiln_map_free(&source);
}

static void white_prefiltered_stays_white(void **state)
{
    (void)state;
    kiln_map source = white(8), map;
    for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++) {
        kiln_textbook_def def = {.shape = (kiln_shape)shape, .size = 8, .sample_count = 64};
        CHECK_OK(kiln_textbook_prefilter(context, &source, &def, &map, &error));
        assert_int_equal(map.level_count, 4);
        for (int level = 0; level < 4; level++) {
            CHECK_NEAR((double)map.roughness[level], level / 3.0, 1e-7);
            for (size_t i = 0; i < 3 * kiln_map_texels(&map, level); i++)
                CHECK_NEAR((double)map.level[level][i], 1, 1e-7);
        }
        kiln_map_free(&map);
    }
    kiln_map_free(&source);
}

// Directions arrive where they belong, on every shape. The bounds are the textbook's own: a mirror
// reads texels whose centres are up to 1.5 texels away both ways, half for rounding down and one
// for the stretching, on a picture whose slope is 1.
static double worst_on_gradient(kiln_shape shape, int source_size, bool irradiance)
{
    kiln_map source = gradient(source_size), map;
    kiln_textbook_def def = {.shape = shape, .size = 6, .level_count = irradiance ? 0 : 2};
    if (irradiance)
        CHECK_OK(kiln_textbook_irradiance(context, &source, &def, &map, &error));
    else
        CHECK_OK(kiln_textbook_prefilter(context, &source, &def, &map, &error));
    double worst = 0;
    for (int level = 0; level < map.level_count; level++) {
        // A mirror keeps the gradient, Lambert (also GGX with roughness 1) two thirds of it.
        double slope = irradiance || level == 1 ? 2.0 / 3 : 1;
        for (size_t i = 0; i < kiln_map_texels(&map, level); i++) {
            double d[3];
            looked(&map, level, i, d);
            for (size_t c = 0; c < 3; c++)
                worst = fmax(worst, fabs((double)map.level[level][3 * i + c] - 2 - slope * d[c]));
        }
    }
    kiln_map_free(&map);
    kiln_map_free(&source);
    return worst;
}

static void gradients_keep_their_direction(void **state)
{
    (void)state;
    for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++)
        for (int size = 32; size <= 512; size *= 4) {
            CHECK_BELOW(worst_on_gradient((kiln_shape)shape, size, true), pi / size + 1e-3);
            CHECK_BELOW(worst_on_gradient((kiln_shape)shape, size, false),
                        1.5 * sqrt(2) * pi / size + 1e-3);
        }
}

// With more steps the uniform sum nears the integral of the picture that it reads.
static void irradiance_converges(void **state)
{
    (void)state;
    kiln_map source = make_noise(context, KILN_SHAPE_PANORAMA, 8, 17);
    double worst[3] = {0};
    for (int k = 0; k < 3; k++) {
        static const int counts[] = {10, 100, 1000};
        static const double bounds[] = {0.1, 0.01, 0.001};
        kiln_map map;
        kiln_textbook_def def = {.shape = KILN_SHAPE_OCTAHEDRON,
                                 .size = 2,
                                 .phi_count = counts[k],
                                 .theta_count = counts[k]};
        CHECK_OK(kiln_textbook_irradiance(context, &source, &def, &map, &error));
        for (size_t i = 0; i < kiln_map_texels(&map, 0); i++) {
            double d[3];
            looked(&map, 0, i, d);
            double wanted = stretched_mean(&source, 1, d, 32);
            worst[k] = fmax(worst[k], fabs((double)map.level[0][3 * i] / wanted - 1));
        }
        CHECK_BELOW(worst[k], bounds[k]);
        kiln_map_free(&map);
    }
    CHECK_BELOW(worst[2], 0.2 * worst[0]);
    kiln_map_free(&source);
}

static void prefilter_converges(void **state)
{
    (void)state;
    kiln_map source = make_noise(context, KILN_SHAPE_PANORAMA, 8, 17);
    double rms[3] = {0};
    for (int k = 0; k < 3; k++) {
        static const int counts[] = {64, 1024, 65536};
        static const double bounds[] = {0.1, 0.02, 0.002};
        kiln_map map;
        // Roughness 0, 1/3, 2/3, 1: the last three are compared.
        kiln_textbook_def def = {
            .shape = KILN_SHAPE_OCTAHEDRON, .size = 8, .level_count = 4, .sample_count = counts[k]};
        CHECK_OK(kiln_textbook_prefilter(context, &source, &def, &map, &error));
        int count = 0;
        for (int level = 1; level < 4; level++) {
            double alpha = level * level / 9.0;
            for (size_t i = 0; i < kiln_map_texels(&map, level); i += 3, count++) {
                double d[3];
                looked(&map, level, i, d);
                double wanted = stretched_mean(&source, alpha, d, 24);
                double off = (double)map.level[level][3 * i] / wanted - 1;
                rms[k] += off * off;
                CHECK_BELOW(fabs(off), 2 * bounds[k]);
            }
        }
        rms[k] = sqrt(rms[k] / count);
        CHECK_BELOW(rms[k], bounds[k]);
        kiln_map_free(&map);
    }
    CHECK_BELOW(rms[1], 0.5 * rms[0]);
    CHECK_BELOW(rms[2], 0.2 * rms[1]);
    kiln_map_free(&source);
}

// Roughness 0 reads the texel that it looks at.
static void level_zero_is_the_nearest_texel(void **state)
{
    (void)state;
    enum { SIZE = 16 };
    kiln_map source = make_noise(context, KILN_SHAPE_PANORAMA, SIZE, 17), map;
    kiln_textbook_def def = {.size = SIZE, .level_count = 1, .sample_count = 4};
    CHECK_OK(kiln_textbook_prefilter(context, &source, &def, &map, &error));
    // The textbook looks at the texels' very edges, so rounding may take the one before; u = 1 is
    // the last column, which nothing else reads.
    int same = 0;
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < 2 * SIZE; x++) {
            const float *texel = texel_at(&map, x, y);
            bool found = false;
            for (int b = y ? y - 1 : 0; b <= y; b++)
                for (int a = -1; a <= 1; a++) {
                    // The poles lose their azimuth, the last column is the first.
                    bool seam = x == 0 || x == 2 * SIZE - 1;
                    if (a == 1 && !seam)
                        continue;
                    int column = a == 1 ? 2 * SIZE - 1 : (x + a + 2 * SIZE - 1) % (2 * SIZE - 1);
                    const float *other = texel_at(&source, column, b);
                    found |= texel[0] == other[0] && texel[1] == other[1] && texel[2] == other[2];
                }
            same += found || y == 0 || y == SIZE - 1;
        }
    assert_int_equal(same, 2 * SIZE * SIZE);
    kiln_map_free(&map);
    kiln_map_free(&source);
}

static void threads_change_no_bit(void **state)
{
    (void)state;
    kiln_map source = make_noise(context, KILN_SHAPE_PANORAMA, 16, 17), first, again;
    kiln_textbook_def def = {.shape = KILN_SHAPE_CUBE, .size = 4};
    CHECK_OK(kiln_textbook_prefilter(context, &source, &def, &first, &error));
    for (int threads = 1; threads <= 8; threads *= 8) {
        kiln_context *other = make_context(threads);
        CHECK_OK(kiln_textbook_prefilter(other, &source, &def, &again, &error));
        for (int level = 0; level < first.level_count; level++)
            assert_memory_equal(first.level[level], again.level[level],
                                3 * sizeof(float) * kiln_map_texels(&first, level));
        kiln_map_free(&again);
        kiln_context_destroy(other);
    }
    kiln_map_free(&first);
    kiln_map_free(&source);
}

static void wrong_arguments_are_named(void **state)
{
    (void)state;
    kiln_map source = make_noise(context, KILN_SHAPE_PANORAMA, 8, 17), map = {.size = 5};
    kiln_image table = {.width = 5};
    kiln_textbook_def def = {.phi_count = -1};
    assert_int_equal(kiln_textbook_irradiance(context, &source, &def, &map, &error),
                     KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "phi_count is -1");
    assert_int_equal(map.size, 0);
    def = (kiln_textbook_def){.sample_count = 1 << 21};
    assert_int_equal(kiln_textbook_prefilter(context, &source, &def, &map, &error),
                     KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "2097152");
    def = (kiln_textbook_def){.size = -3};
    assert_int_equal(kiln_textbook_prefilter(context, &source, &def, &map, &error),
                     KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, "-3");
    assert_int_equal(kiln_textbook_brdf(context, 1, 0, &table, &error), KILN_ERROR_ARGUMENT);
    assert_int_equal(table.width, 0);
    assert_int_equal(kiln_textbook_brdf(context, 8, -1, &table, &error), KILN_ERROR_ARGUMENT);
    kiln_map cube;
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 4, 1, &cube, &error));
    assert_int_equal(kiln_textbook_irradiance(context, &cube, NULL, &map, &error),
                     KILN_ERROR_ARGUMENT);
    kiln_map_free(&cube);
    kiln_map_free(&source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_irradiance_is_the_trapezoids),
        cmocka_unit_test(white_prefiltered_stays_white),
        cmocka_unit_test(gradients_keep_their_direction),
        cmocka_unit_test(irradiance_converges),
        cmocka_unit_test(prefilter_converges),
        cmocka_unit_test(level_zero_is_the_nearest_texel),
        cmocka_unit_test(threads_change_no_bit),
        cmocka_unit_test(wrong_arguments_are_named),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}

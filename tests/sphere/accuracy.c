// The promise: on real panoramas and the sky, 256 random texels of every level differ from the sum
// over every source texel by at most 1e-4 (relative RMS) and 2e-3 (each).
#include "kit/context.h"

static void check_levels(const kiln_map *panorama, const char *name)
{
    kiln_map out;
    CHECK_OK(kiln_prefilter(context, panorama, NULL, &out, &error));
    assert_int_equal(out.level_count, 9);
    for (int l = 1; l < out.level_count; l++) {
        kiln_lobe lobe = kiln_lobe_ggx((double)out.roughness[l] * (double)out.roughness[l]);
        scene_errors e = scene_compare(context, panorama, &out, l, &lobe, 0, 256);
        printf("%-10s roughness %.3f  rms %.1e  most %.1e\n", name, (double)out.roughness[l], e.rms,
               e.most);
        CHECK_BELOW(e.rms, 1e-4);
        CHECK_BELOW(e.most, 2e-3);
    }
    // The mirror: each texel is the mean of the panorama over its solid angle. Summed here over
    // 96 x 96 points of equal steps across the face, weighed by the cube map's Jacobian.
    enum { CUT = 96, EDGE = 256 * CUT };
    double square = 0, whole = 0;
    uint64_t seed = 99;
    for (int n = 0; n < 256; n++) {
        size_t index = (size_t)(random_number(&seed) * (double)kiln_map_texels(&out, 0));
        double sum[3] = {0}, weight = 0;
        kiln_map fine = {.shape = KILN_SHAPE_CUBE, .size = EDGE, .level_count = 1};
        size_t face = index / 65536, y = index % 65536 / 256, x = index % 256;
        for (size_t j = 0; j < CUT; j++)
            for (size_t i = 0; i < CUT; i++) {
                double d[3], most = 0;
                kiln_map_direction(&fine, 0, (face * EDGE + y * CUT + j) * EDGE + x * CUT + i, d);
                for (int k = 0; k < 3; k++)
                    most = fmax(most, fabs(d[k]));
                double solid = most * most * most;
                double theta = acos(d[1]), u = atan2(-d[0], d[2]) / (2 * pi);
                int size = panorama->size;
                int row = (int)(theta / pi * size), column = (int)((u - floor(u)) * 2 * size);
                row = row < size ? row : size - 1;
                column = column < 2 * size ? column : 2 * size - 1;
                for (int c = 0; c < 3; c++)
                    sum[c] += solid * (double)panorama->level[0][3 * (2 * size * row + column) + c];
                weight += solid;
            }
        for (int c = 0; c < 3; c++) {
            double wanted = sum[c] / weight,
                   off = (double)out.level[0][3 * index + (size_t)c] - wanted;
            square += off * off;
            whole += wanted * wanted;
        }
    }
    printf("%-10s mirror           rms %.1e\n", name, sqrt(square / whole));
    // The sum above is the less exact of the two: a column of points more or less at a texel's
    // edge.
    CHECK_BELOW(sqrt(square / whole), 5e-3);
    kiln_map_free(&out);
}

static void check_file(const char *name)
{
    char path[512];
    kiln_map panorama;
    snprintf(path, sizeof path, "%s/blender/%s.exr", KILN_TEST_DATA, name);
    CHECK_OK(kiln_map_load(context, path, NULL, &panorama, &error));
    check_levels(&panorama, name);
    kiln_map_free(&panorama);
}

static void a_sunny_panorama(void **state)
{
    (void)state;
    check_file("city");
}

static void a_panorama_with_most_of_its_light_in_a_few_texels(void **state)
{
    (void)state;
    check_file("sunrise");
}

static void the_sky(void **state)
{
    (void)state;
    kiln_map sky;
    CHECK_OK(kiln_sky(context, NULL, &sky, &error));
    check_levels(&sky, "sky");
    kiln_map_free(&sky);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sunny_panorama),
        cmocka_unit_test(a_panorama_with_most_of_its_light_in_a_few_texels),
        cmocka_unit_test(the_sky),
    };
    return cmocka_run_group_tests_name("sphere accuracy", tests, set_up, tear_down);
}

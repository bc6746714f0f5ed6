// The promise: on real panoramas and the sky, 256 random texels of every level differ from the sum
// over every source texel by at most 1e-4 (relative RMS) and 2e-3 (each). So do the texels around a
// pole of panoramas that have most of their light there.
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

// Fills a panorama with light at the north pole. Kind 0: a lamp of one row. Kind 1: a lamp of half
// a row. Kind 2: light that falls to 1 / e every three rows.
static void light_pole(kiln_map *map, int kind)
{
    int size = map->size;
    for (int row = 0; row < size; row++)
        for (int x = 0; x < 2 * size; x++) {
            double value = kind == 0   ? (row == 0 ? 1000 : 1)
                           : kind == 1 ? (row == 0 && x < size ? 50 : 0.2)
                                       : 1000 * exp(-row / 3.0) + 0.1;
            for (int c = 0; c < 3; c++)
                map->level[0][3 * (row * 2 * size + x) + c] = (float)value;
        }
}

// Returns the sum of the first five bands of a panorama, whose rows are constant, at an angle from
// the north pole that has this cosine. The integral of P_l over a row is the difference of
// (P_{l+1} - P_{l-1}) / (2 l + 1) between its edges.
static double zonal_bands(const kiln_map *map, double cosine)
{
    enum { BANDS = 5 };
    double sum = 0, here[BANDS + 2] = {0, 1, cosine};
    for (int l = 1; l + 1 < BANDS; l++)
        here[l + 2] = ((2 * l + 1) * cosine * here[l + 1] - l * here[l]) / (l + 1);
    for (int row = 0; row < map->size; row++) {
        double edge[2][BANDS + 2];
        for (int e = 0; e < 2; e++) {
            double x = cos((row + e) * pi / map->size);
            edge[e][0] = edge[e][1] = 1; // P_{-1} and P_0
            edge[e][2] = x;
            for (int l = 1; l < BANDS; l++)
                edge[e][l + 2] = ((2 * l + 1) * x * edge[e][l + 1] - l * edge[e][l]) / (l + 1);
        }
        for (int l = 0; l < BANDS; l++) {
            double area = (edge[0][l + 2] - edge[0][l] - edge[1][l + 2] + edge[1][l]) / 2;
            sum += (double)map->level[0][(size_t)row * 6 * (size_t)map->size] * here[l + 1] * area;
        }
    }
    return sum;
}

// The weights of the latitude rings next to a pole matter only for panoramas with light there.
static void light_at_a_pole(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        kiln_map in;
        CHECK_OK(kiln_map_create(context, KILN_SHAPE_PANORAMA, 512, 1, &in, &error));
        light_pole(&in, kind);
        // the 256 texels around the pole, in the middle of the face +Y
        static double directions[256][3], wanted[256][3];
        kiln_environment made;
        kiln_bake_def def = {.irradiance_size = KILN_NO_IRRADIANCE, .sh_bands = 5};
        CHECK_OK(kiln_bake(context, &in, &def, &made, &error));
        for (int l = 1; l < 5; l++) {
            const kiln_map *out = &made.levels;
            size_t n = (size_t)kiln_map_level_size(out, l), first = 2 * n * n + (n / 2 - 8) * n;
            kiln_lobe lobe = kiln_lobe_ggx((double)out->roughness[l] * (double)out->roughness[l]);
            for (size_t i = 0; i < 256; i++)
                kiln_map_direction(out, l, first + i / 16 * n + n / 2 - 8 + i % 16, directions[i]);
            CHECK_OK(kiln_reference_filter(context, &in, &lobe, 0, (const double(*)[3])directions,
                                           256, wanted, &error));
            double square = 0, whole = 0, most = 0;
            for (size_t i = 0; i < 256; i++) {
                double off = (double)out->level[l][3 * (first + i / 16 * n + n / 2 - 8 + i % 16)] -
                             wanted[i][0];
                square += off * off;
                whole += wanted[i][0] * wanted[i][0];
                most = fmax(most, fabs(off) / wanted[i][0]);
            }
            printf("pole %d     roughness %.3f  rms %.1e  most %.1e\n", kind,
                   (double)out->roughness[l], sqrt(square / whole), most);
            CHECK_BELOW(sqrt(square / whole), 1e-4);
            CHECK_BELOW(most, 2e-3);
        }
        kiln_sh sh;
        CHECK_OK(kiln_map_sh(context, &in, 5, 0, &sh, &error));
        for (int i = 0; i <= 8 && kind != 1; i++) {
            double theta = i * pi / 8, direction[3] = {sin(theta), cos(theta), 0};
            double exact = zonal_bands(&in, cos(theta)), mean = sh.c[0][0] / sqrt(4 * pi), value[3];
            kiln_sh_evaluate(&sh, direction, value);
            CHECK_NEAR(value[0], exact, 2e-6 * mean);
            kiln_sh_evaluate(&made.sh, direction, value);
            CHECK_NEAR(value[0], exact, 2e-6 * mean);
        }
        kiln_environment_free(&made);
        kiln_map_free(&in);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sunny_panorama),
        cmocka_unit_test(a_panorama_with_most_of_its_light_in_a_few_texels),
        cmocka_unit_test(the_sky),
        cmocka_unit_test(light_at_a_pole),
    };
    return cmocka_run_group_tests_name("sphere accuracy", tests, set_up, tear_down);
}

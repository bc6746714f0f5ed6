// Three panoramas of npm's @pmndrs/assets, which much of the web shows. Their lossy compression
// left negative texels with 0.5 to 11 % of the light. Levels and harmonics are compared with brute
// force over the numbers as the decoder leaves them.
#include "codec/codec.h"
#include "kit/context.h"

// Compares 24 texels of each level with the sum over all texels of the panorama, 0 standing for
// sums below zero.
static double level_error(const kiln_map *panorama, const kiln_map *map, int level)
{
    enum { COUNT = 24 };
    double directions[COUNT][3], values[COUNT][3], square = 0, whole = 0;
    size_t index[COUNT];
    uint64_t seed = 3;
    double alpha = (double)map->roughness[level] * (double)map->roughness[level];
    kiln_lobe lobe = kiln_lobe_ggx(alpha);
    for (int i = 0; i < COUNT; i++) {
        index[i] = (size_t)(random_number(&seed) * (double)kiln_map_texels(map, level));
        kiln_map_direction(map, level, index[i], directions[i]);
    }
    CHECK_OK(kiln_reference_filter(context, panorama, &lobe, 0, (const double(*)[3])directions,
                                   COUNT, values, &error));
    for (int i = 0; i < COUNT; i++)
        for (size_t c = 0; c < 3; c++) {
            double wanted = fmax(values[i][c], 0);
            double off = (double)map->level[level][3 * index[i] + c] - wanted;
            square += off * off;
            whole += wanted * wanted;
        }
    return sqrt(square / whole);
}

// The mean radiance of the sphere by a sum over all texels.
static void mean_of(const kiln_map *map, double mean[3])
{
    int size = map->size;
    memset(mean, 0, sizeof(double[3]));
    for (int y = 0; y < size; y++) {
        double solid = (cos(pi * y / size) - cos(pi * (y + 1) / size)) / (4 * size);
        for (int x = 0; x < 2 * size; x++)
            for (int c = 0; c < 3; c++)
                mean[c] += solid * (double)texel_at(map, x, y)[c];
    }
}

static void check_panorama(const char *name, size_t negatives)
{
    size_t size;
    uint8_t *bytes = read_asset(KILN_ASSETS, name, &size);
    ki_decoded decoded;
    kiln_load_report report;
    kiln_load_def def = {.report = &report};
    kiln_bake_def bake = {.levels = {.size = 64}, .irradiance_size = KILN_NO_IRRADIANCE};
    kiln_map source;
    kiln_environment made;
    CHECK_OK(ki_decode(context, bytes, size, name, &decoded, NULL, &error));
    CHECK_OK(kiln_map_decode(context, bytes, size, name, &def, &source, &error));
    assert_int_equal(report.negative_count, negatives);
    CHECK_OK(kiln_bake(context, &source, &bake, &made, &error));
    kiln_map panorama = {.shape = KILN_SHAPE_PANORAMA,
                         .size = decoded.image.height,
                         .level_count = 1,
                         .level = {decoded.image.pixels}};
    for (int level = 1; level < made.levels.level_count; level++) {
        double rms = level_error(&panorama, &made.levels, level);
        printf("%-10s roughness %.3f  rms %.1e\n", name, (double)made.levels.roughness[level], rms);
        CHECK_BELOW(rms, 1e-4);
    }
    double mean[3];
    mean_of(&panorama, mean);
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(made.sh.c[0][c] / sqrt(4 * pi), mean[c], 1e-5 * mean[c]);
    kiln_environment_free(&made);
    kiln_map_free(&source);
    ki_decoded_free(&decoded);
    free(bytes);
}

static void sky(void **state)
{
    (void)state;
    check_panorama("sky", 11);
}

static void esplanade(void **state)
{
    (void)state;
    check_panorama("esplanade", 2866);
}

static void studio(void **state)
{
    (void)state;
    check_panorama("studio", 798);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sky), cmocka_unit_test(esplanade),
                                       cmocka_unit_test(studio)};
    return cmocka_run_group_tests_name("assets", tests, set_up, tear_down);
}

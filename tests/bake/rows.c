// Bakes while rows pass by: the same bits as from the whole map, for every size, block of rows,
// shape of levels and number of threads, with few rows in memory at a time.
#include "kit/context.h"

#include <stdatomic.h>

enum { MOST_ROWS = 1024 };

// A panorama that is read by rows, and what was read.
typedef struct source {
    const kiln_map *map;
    atomic_int read[MOST_ROWS]; // how often each row was read
    atomic_int most;            // the most rows that one call asked for
    int fails_at;               // row whose reading fails; -1 for none
} source;

static kiln_result read_rows(void *user, int first, int count, float *rgb, kiln_error *failure)
{
    source *s = user;
    size_t line = 6 * (size_t)s->map->size;
    assert_true(first >= 0 && count > 0 && first + count <= s->map->size);
    for (int row = first; row < first + count; row++) {
        atomic_fetch_add(&s->read[row], 1);
        if (row != s->fails_at)
            continue;
        failure->result = KILN_ERROR_IO;
        snprintf(failure->message, sizeof failure->message, "row %d is lost", row);
        return KILN_ERROR_IO;
    }
    if (count > atomic_load(&s->most))
        atomic_store(&s->most, count);
    memcpy(rgb, s->map->level[0] + line * (size_t)first, line * (size_t)count * sizeof *rgb);
    return KILN_OK;
}

static void check_same(const kiln_environment *a, const kiln_environment *b)
{
    assert_true(same_map(&a->levels, &b->levels));
    assert_int_equal(a->irradiance.size, b->irradiance.size);
    if (a->irradiance.size)
        assert_true(same_map(&a->irradiance, &b->irradiance));
    assert_memory_equal(&a->sh, &b->sh, sizeof a->sh);
    assert_memory_equal(&a->levels_cut, &b->levels_cut, sizeof a->levels_cut);
    assert_int_equal(a->degree, b->degree);
    assert_int_equal(a->lights.count, b->lights.count);
}

// Bakes a map as a whole and by rows, and compares. Returns how often a row was read at most.
static int compare(kiln_context *with, const kiln_map *map, const kiln_bake_def *def, int block,
                   int phase)
{
    kiln_environment whole, passed;
    source s = {.map = map, .fails_at = -1};
    kiln_rows rows = {map->size, read_rows, &s, block, phase};
    CHECK_OK(kiln_bake(with, map, def, &whole, &error));
    CHECK_OK(kiln_bake_rows(with, &rows, def, &passed, &error));
    check_same(&whole, &passed);
    int most = 0;
    for (int row = 0; row < map->size; row++) {
        int count = atomic_load(&s.read[row]);
        assert_true(count > 0);
        most = count > most ? count : most;
    }
    kiln_environment_free(&whole);
    kiln_environment_free(&passed);
    return most;
}

static void sizes_and_blocks(void **state)
{
    (void)state;
    static const int sizes[] = {1, 2, 3, 7, 45, 97, 200};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int block = i % 2; block < 300; block = 9 * block + 1) {
            int size = sizes[i];
            kiln_map map = make_noise(context, KILN_SHAPE_PANORAMA, size, (uint64_t)size);
            kiln_bake_def def = {.levels = {.size = 5 + 7 * (int)i, .tolerance = 0.01},
                                 .irradiance_size = KILN_NO_IRRADIANCE};
            // Without suns each row is read once.
            assert_int_equal(compare(context, &map, &def, block, 17 - size), 1);
            kiln_map_free(&map);
        }
}

// Texels of level 0 that each cover many rows, those on the horizon rows of both sides.
static void texels_of_many_rows(void **state)
{
    (void)state;
    static const int sizes[] = {128, 255, 512};
    for (int i = 0; i < 3; i++) {
        kiln_map map = make_noise(context, KILN_SHAPE_PANORAMA, sizes[i], 9);
        for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++)
            compare(context, &map,
                    &(kiln_bake_def){
                        .levels = {.shape = (kiln_shape)shape, .size = 32, .level_count = 1},
                        .irradiance_size = KILN_NO_IRRADIANCE},
                    16, 0);
        kiln_map_free(&map);
    }
}

// Suns in all rows: at both poles, on both sides of the equator, two in neighbouring rows, and so
// many that each ring has one.
static void suns(void **state)
{
    (void)state;
    static const int rows[][4] = {
        {0, 0, 0, 0}, {119, 119, 119, 119}, {59, 60, 61, 59}, {10, 11, 100, 50}};
    kiln_bake_def def = {.levels = {.size = 16, .tolerance = 0.01},
                         .irradiance_size = KILN_NO_IRRADIANCE};
    for (int i = 0; i < 5; i++) {
        kiln_map map = make_noise(context, KILN_SHAPE_PANORAMA, 120, 3);
        for (int k = 0; k < (i < 4 ? 4 : 120); k++)
            texel_at(&map, (37 * k + 11) % 240, i < 4 ? rows[i][k] : k)[k % 3] =
                i < 4 ? 9e4F : 5e4F;
        assert_true(compare(context, &map, &def, 16, 3) > 1);
        kiln_map_free(&map);
    }
}

static void every_option(void **state)
{
    (void)state;
    kiln_map map = make_panorama(context, 90);
    scene_fill(&map, 5);
    texel_at(&map, 20, 9)[1] = -50;
    for (int threads = 1; threads <= 3; threads++) {
        kiln_context *with = make_context(threads);
        for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++) {
            kiln_bake_def def = {.levels = {.shape = (kiln_shape)shape,
                                            .size = 30,
                                            .rotation = 33,
                                            .tolerance = 0.01},
                                 .mirror = threads > 1,
                                 .exposure = threads - 1.5};
            compare(with, &map, &def, 7, 0);
        }
        kiln_context_destroy(with);
    }
    // one level that is a mirror and no other level, whose spectrum is too short for the irradiance
    compare(context, &map, &(kiln_bake_def){.levels = {.size = 40, .level_count = 1}}, 16, 0);
    compare(context, &map, &(kiln_bake_def){.levels = {.size = 8, .lobe = KILN_LOBE_LAMBERT}}, 16,
            0);
    for (int tune = KILN_TUNE_NONE; tune <= KILN_TUNE_SHARP; tune++)
        compare(context, &map,
                &(kiln_bake_def){.levels = {.size = 32},
                                 .engine = kiln_engine_find("three"),
                                 .tune = (kiln_tune)tune},
                16, 0);
    kiln_map_free(&map);
}

// What needs the whole panorama gets it.
static void bakes_of_all_rows(void **state)
{
    (void)state;
    kiln_map map = make_panorama(context, 64);
    const float narrow[] = {0, 0.05F, 1};
    scene_fill(&map, 6);
    const kiln_bake_def defs[] = {
        {.levels = {.size = 16}, .sun = KILN_SUN_EXTRACT},
        {.levels = {.size = 16}, .sun = KILN_SUN_CLAMP, .clamp = 10},
        {.levels = {.size = 16, .pitch = 20}},
        {.levels = {.size = 16, .level_count = 3, .roughness = narrow}},
    };
    for (size_t i = 0; i < sizeof defs / sizeof *defs; i++)
        compare(context, &map, &defs[i], 8, 0);
    kiln_map_free(&map);
}

static void failures(void **state)
{
    (void)state;
    kiln_map map = make_noise(context, KILN_SHAPE_PANORAMA, 100, 1);
    kiln_environment made;
    const kiln_bake_def defs[] = {{.levels = {.size = 16}}, {.levels = {.size = 16, .pitch = 20}}};
    for (int i = 0; i < 2; i++) {
        source s = {.map = &map, .fails_at = 51};
        kiln_rows rows = {100, read_rows, &s, 4, 0};
        assert_int_equal(kiln_bake_rows(context, &rows, &defs[i], &made, &error), KILN_ERROR_IO);
        assert_string_equal(error.message, "row 51 is lost");
        assert_null(made.levels.level[0]);
        rows.size = 0;
        assert_int_equal(kiln_bake_rows(context, &rows, &defs[i], &made, &error),
                         KILN_ERROR_ARGUMENT);
        assert_string_equal(error.message, "the panorama has 0 rows in blocks of 4, it must have 1 "
                                           "to 16384, in blocks of 0 or more");
    }
    kiln_map_free(&map);
}

// The bake's own memory grows by less than half of the panorama's when the panorama grows.
static void little_memory(void **state)
{
    (void)state;
    size_t peaks[2], now, texels[2];
    for (int i = 0; i < 2; i++) {
        kiln_context *with = make_context(1);
        kiln_map map = make_noise(context, KILN_SHAPE_PANORAMA, i ? MOST_ROWS : MOST_ROWS / 2, 1);
        source s = {.map = &map, .fails_at = -1};
        kiln_rows rows = {map.size, read_rows, &s, 16, 0};
        kiln_bake_def def = {.levels = {.size = 64}, .irradiance_size = KILN_NO_IRRADIANCE};
        kiln_environment made;
        CHECK_OK(kiln_bake_rows(with, &rows, &def, &made, &error));
        kiln_environment_free(&made);
        texels[i] = kiln_map_texels(&map, 0);
        kiln_context_memory(with, &now, &peaks[i]);
        kiln_context_destroy(with);
        kiln_map_free(&map);
    }
    assert_true(2 * (peaks[1] - peaks[0]) < 12 * (texels[1] - texels[0]));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_and_blocks),    cmocka_unit_test(suns),
        cmocka_unit_test(texels_of_many_rows), cmocka_unit_test(every_option),
        cmocka_unit_test(bakes_of_all_rows),   cmocka_unit_test(failures),
        cmocka_unit_test(little_memory),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}

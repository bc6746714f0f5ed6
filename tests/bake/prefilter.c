// Mirror levels of cubes and octahedra, and stopping wherever progress is reported.
#include "kit/context.h"

static kiln_map random_map(kiln_shape shape, int size)
{
    kiln_map map = make_map(context, shape, size, 1);
    fill_noise(&map, 7, 0, 1);
    return map;
}

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
        kiln_map source = random_map((kiln_shape)shape, 24);
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
        kiln_map source = random_map(cases[i].from, 24), converted;
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
    kiln_map source = random_map(KILN_SHAPE_PANORAMA, 16), map;
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

typedef struct countdown {
    int left, calls;
} countdown;

static bool count_down(void *user, const char *stage, double fraction)
{
    countdown *c = user;
    assert_non_null(stage);
    assert_true(fraction >= 0 && fraction <= 1);
    c->calls++;
    return c->left-- > 0;
}

// Stops at each report in turn: all memory comes back, no file is left, and the sentence says so.
// Returns how many reports there are.
static int stop_everywhere(const kiln_map *source, kiln_shape shape, const char *ending)
{
    countdown c = {0};
    kiln_context *own;
    kiln_context_def def = {.thread_count = 1, .progress = count_down, .progress_user = &c};
    CHECK_OK(kiln_context_create(&def, &own, &error));
    char name[16];
    snprintf(name, sizeof name, "out%s", ending);
    kiln_result result = KILN_ERROR_CANCELLED;
    for (int stop = 0; result != KILN_OK; stop += 1 + stop / 8) {
        c = (countdown){.left = stop};
        kiln_map map;
        kiln_prefilter_def what = {.shape = shape, .size = 64, .level_count = 2};
        kiln_save_def how = {.zstd = !strcmp(ending, ".ktx2")};
        size_t before, after;
        kiln_context_memory(own, &before, NULL);
        result = kiln_prefilter(own, source, &what, &map, &error);
        if (result == KILN_OK)
            result = kiln_map_save(own, &map, in_folder(name), &how, NULL, &error);
        else
            assert_null(map.owner);
        kiln_map_free(&map);
        kiln_context_memory(own, &after, NULL);
        assert_int_equal(after, before);
        if (result == KILN_OK)
            break;
        assert_int_equal(result, KILN_ERROR_CANCELLED);
        assert_int_equal(c.calls, stop + 1); // nothing goes on after it
        CHECK_SAYS(error.message, "stopped while ");
        assert_int_equal(file_count(folder_path()), 0);
    }
    kiln_context_destroy(own);
    return c.calls;
}

static void work_stops_wherever_it_reports(void **state)
{
    (void)state;
    kiln_map panorama = random_map(KILN_SHAPE_PANORAMA, 64), cube = random_map(KILN_SHAPE_CUBE, 32);
    static const char *const endings[] = {".ktx2", ".dds", ".exr", ".hdr", ".png"};
    for (int i = 0; i < 5; i++) {
        // Dozens of reports a level and some a file: a bake of any size stops soon.
        int calls = stop_everywhere(i % 2 ? &cube : &panorama, KILN_SHAPE_CUBE, endings[i]);
        assert_true(calls > 80);
        folder_empty();
    }
    int calls = stop_everywhere(&panorama, KILN_SHAPE_PANORAMA, ".exr");
    assert_true(calls > 80);
    folder_empty();
    kiln_map_free(&panorama);
    kiln_map_free(&cube);
}

typedef struct intruder {
    kiln_context *own;
    bool inside;
    int calls;
} intruder;

// A callback that calls kiln itself, while the helper threads are at work for the bake.
static bool intrude(void *user, const char *stage, double fraction)
{
    intruder *i = user;
    kiln_map map;
    (void)stage;
    (void)fraction;
    if (i->inside)
        return true;
    i->inside = true;
    i->calls++;
    CHECK_OK(kiln_map_create(i->own, KILN_SHAPE_PANORAMA, 1024, 1, &map, &error));
    for (size_t k = 0; k < 3 * kiln_map_texels(&map, 0); k += 4001)
        assert_true(map.level[0][k] == 0);
    kiln_map_free(&map);
    i->inside = false;
    return true;
}

static void a_callback_may_call_kiln(void **state)
{
    (void)state;
    intruder i = {0};
    kiln_map source = random_map(KILN_SHAPE_PANORAMA, 64), map, wanted;
    kiln_prefilter_def what = {.size = 32, .level_count = 2};
    kiln_context_def def = {.thread_count = 4, .progress = intrude, .progress_user = &i};
    CHECK_OK(kiln_context_create(&def, &i.own, &error));
    CHECK_OK(kiln_prefilter(context, &source, &what, &wanted, &error));
    CHECK_OK(kiln_prefilter(i.own, &source, &what, &map, &error));
    assert_true(i.calls > 4);
    check_same_levels(&map, &wanted);
    kiln_map_free(&map);
    kiln_map_free(&wanted);
    kiln_map_free(&source);
    kiln_context_destroy(i.own);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mirrors_of_the_same_size_are_copies),
        cmocka_unit_test(mirrors_of_other_sizes_come_from_the_source),
        cmocka_unit_test(roughness_is_stated),
        cmocka_unit_test(work_stops_wherever_it_reports),
        cmocka_unit_test(a_callback_may_call_kiln),
    };
    return cmocka_run_group_tests(tests, set_up_folder, tear_down_empty_folder);
}

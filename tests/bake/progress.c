// Progress: work stops wherever it reports and leaves nothing behind, and a callback may call kiln.
#include "kit/context.h"

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
        kiln_save_def how = {.zstd = KILN_TEST_ZSTD && !strcmp(ending, ".ktx2")};
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
    kiln_map panorama = make_noise(context, KILN_SHAPE_PANORAMA, 64, 7),
             cube = make_noise(context, KILN_SHAPE_CUBE, 32, 7);
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
    kiln_map source = make_noise(context, KILN_SHAPE_PANORAMA, 64, 7), map, wanted;
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
        cmocka_unit_test(work_stops_wherever_it_reports),
        cmocka_unit_test(a_callback_may_call_kiln),
    };
    return cmocka_run_group_tests(tests, set_up_folder, tear_down_empty_folder);
}

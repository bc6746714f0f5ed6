// Engines' files when memory runs out.
#include "kit/kit.h"

static kiln_error error;

// The smallest cube that an engine takes, white.
static kiln_map smallest_cube(kiln_context *own, const kiln_engine *engine)
{
    float roughness[KILN_MAX_LEVELS];
    kiln_prefilter_def def;
    int size = 1;
    while (kiln_engine_levels(engine, size, 0, roughness, &def, &error) != KILN_OK)
        size *= 2;
    kiln_map source = make_panorama(own, 4), map;
    fill_constant(&source, 1);
    def.tolerance = 0.01;
    CHECK_OK(kiln_prefilter(own, &source, &def, &map, &error));
    kiln_map_free(&source);
    return map;
}

// Whichever allocation fails, nothing is held and no file appears.
static void memory_that_runs_out_leaves_no_file(void **state)
{
    (void)state;
    folder_make();
    const kiln_sh sh = {.bands = 3, .c = {{1, 1, 1}}};
    for (int e = 0; kiln_engine_at(e); e++) {
        const kiln_engine *engine = kiln_engine_at(e);
        if (!engine_is_written(engine))
            continue;
        failing f;
        kiln_context *own = failing_context(&f);
        kiln_map map = smallest_cube(own, engine);
        char name[64], path[128];
        snprintf(name, sizeof name, "x%s%s", engine->ending[0] ? "." : "", engine->ending);
        snprintf(path, sizeof path, "%s", in_folder(name));
        long held = f.held, needed;
        kiln_result result;
        f.calls = 0;
        CHECK_OK(kiln_engine_save(own, engine, &map, &sh, KILN_FORMAT_AUTO, path, NULL, &error));
        needed = f.calls;
        assert_true(needed > 2 && f.held == held);
        assert_true(file_count(folder_path()) > 0);
        folder_empty();
        for (long n = 1; n <= needed; n++) {
            f.calls = 0;
            f.fail_at = n;
            result = kiln_engine_save(own, engine, &map, &sh, KILN_FORMAT_AUTO, path, NULL, &error);
            if (result != KILN_ERROR_MEMORY || f.held != held || file_count(folder_path()) != 0)
                fail_msg("%s: allocation %ld of %ld: result %d, %ld blocks held, %s", engine->name,
                         n, needed, (int)result, f.held - held, error.message);
        }
        print_message("%s: %ld allocations\n", engine->name, needed);
        f.fail_at = 0;
        kiln_map_free(&map);
        kiln_context_destroy(own);
    }
    assert_int_equal(file_count(folder_path()), 0);
    folder_remove();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(memory_that_runs_out_leaves_no_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

// Files in memory are the files that saving writes, for maps and for every engine, and memory that
// runs out leaves nothing.
#include <unistd.h>

#include "kit/context.h"

static void encoded_maps_are_the_files(void **state)
{
    (void)state;
    kiln_environment made = make_sky_bake(context);
    static const struct {
        const char *name;
        int count;
        kiln_format format;
    } ways[] = {{"a.ktx2", 1, KILN_FORMAT_RGB9E5}, {"a.dds", 1, KILN_FORMAT_BC6H},
                {"a.exr", 30, KILN_FORMAT_AUTO},   {"a_%s_%d.hdr", 30, KILN_FORMAT_AUTO},
                {"a.png", 30, KILN_FORMAT_RGBM},   {"sub/", 30, KILN_FORMAT_AUTO}};
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        kiln_save_def def = {.format = ways[i].format, .sh = &made.sh, .lobe = "ggx"};
        kiln_save_report saved, encoded;
        kiln_files files;
        CHECK_OK(kiln_map_encode(context, &made.levels, in_folder(ways[i].name), &def, &files,
                                 &encoded, &error));
        assert_int_equal(files.count, ways[i].count);
        assert_int_equal(access(files.file[0].name, F_OK), -1); // nothing is written
        assert_int_equal(access(in_folder("sub"), F_OK), -1);
        CHECK_OK(
            kiln_map_save(context, &made.levels, in_folder(ways[i].name), &def, &saved, &error));
        assert_int_equal(saved.file_count, ways[i].count);
        assert_memory_equal(&saved, &encoded, sizeof saved);
        check_saved_files(&files);
        kiln_files_free(&files);
        assert_int_equal(files.count, 0);
    }
    rmdir(in_folder("sub"));
    // And what is encoded is read again.
    kiln_files files;
    kiln_map again;
    kiln_save_def floats = {.format = KILN_FORMAT_RGBA32F};
    CHECK_OK(kiln_map_encode(context, &made.levels, "x.ktx2", &floats, &files, NULL, &error));
    CHECK_OK(kiln_map_decode(context, files.file[0].bytes, files.file[0].size, NULL, NULL, &again,
                             &error));
    check_same_levels(&again, &made.levels);
    kiln_map_free(&again);
    kiln_files_free(&files);
    kiln_environment_free(&made);
}

static void engines_files_are_encoded_alike(void **state)
{
    (void)state;
    kiln_map white;
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_PANORAMA, 8, 1, &white, &error));
    for (int i = 0; kiln_engine_at(i); i++) {
        const kiln_engine *engine = kiln_engine_at(i);
        if (!engine_is_written(engine))
            continue;
        kiln_bake_def def = {.engine = engine,
                             .levels = {.size = engine->size < 64 ? engine->size : 64},
                             .tune = KILN_TUNE_NONE,
                             .irradiance_size = 4};
        kiln_environment made;
        kiln_environment_save_def save = {.engine = engine};
        kiln_environment_report report;
        kiln_files files;
        char name[64];
        if (kiln_bake(context, &white, &def, &made, &error) != KILN_OK) {
            def.levels.size = 0; // one size only
            CHECK_OK(kiln_bake(context, &white, &def, &made, &error));
        }
        snprintf(name, sizeof name, "e%s%s", engine->ending[0] ? "." : "", engine->ending);
        CHECK_OK(
            kiln_environment_encode(context, &made, in_folder(name), &save, &files, NULL, &error));
        assert_true(files.count >= 1);
        CHECK_OK(kiln_environment_save(context, &made, in_folder(name), &save, &report, &error));
        assert_int_equal(report.file_count, files.count);
        check_saved_files(&files);
        kiln_files_free(&files);
        CHECK_OK(kiln_engine_encode(context, engine, &made.levels, &made.sh, KILN_FORMAT_AUTO,
                                    in_folder(name), &files, &report.levels, &error));
        assert_int_equal(report.levels.file_count, files.count);
        kiln_files_free(&files);
        kiln_environment_free(&made);
    }
    kiln_map_free(&white);
}

static void memory_that_is_refused_leaves_nothing(void **state)
{
    (void)state;
    kiln_context_def def = {.memory_limit = 200000, .thread_count = 1};
    kiln_context *small;
    kiln_map map;
    kiln_files files;
    kiln_save_report report;
    size_t before, after;
    CHECK_OK(kiln_context_create(&def, &small, &error));
    CHECK_OK(kiln_map_create(small, KILN_SHAPE_CUBE, 48, 1, &map, &error));
    kiln_context_memory(small, &before, NULL);
    assert_int_equal(kiln_map_encode(small, &map, "a.ktx2", NULL, &files, &report, &error),
                     KILN_ERROR_MEMORY);
    assert_int_equal(files.count, 0);
    assert_null(files.file);
    assert_int_equal(report.value_count, 0);
    kiln_context_memory(small, &after, NULL);
    assert_int_equal(after, before);
    kiln_map_free(&map);
    kiln_context_destroy(small);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(encoded_maps_are_the_files),
        cmocka_unit_test(engines_files_are_encoded_alike),
        cmocka_unit_test(memory_that_is_refused_leaves_nothing),
    };
    return cmocka_run_group_tests_name("memory", tests, set_up_folder, tear_down_empty_folder);
}

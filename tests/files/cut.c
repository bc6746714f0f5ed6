// Values above what a format holds are cut off and counted.
#include "kit/context.h"

static void what_is_cut_off_is_counted(void **state)
{
    (void)state;
    kiln_map map;
    kiln_files files;
    kiln_save_report report;
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 4, 1, &map, &error));
    map.level[0][5] = 65505;
    map.level[0][17] = 1e6f;
    map.level[0][18] = 65504;
    static const struct {
        const char *name;
        kiln_format format;
        size_t cut;
        double limit;
    } ways[] = {{"a.ktx2", KILN_FORMAT_AUTO, 2, 65504},  {"a.ktx2", KILN_FORMAT_RGBA32F, 0, 0},
                {"a.dds", KILN_FORMAT_RGB9E5, 3, 65408}, {"a.dds", KILN_FORMAT_B10G11R11, 3, 64512},
                {"a.ktx2", KILN_FORMAT_BC6H, 2, 65504},  {"a.exr", KILN_FORMAT_AUTO, 2, 65504},
                {"a.hdr", KILN_FORMAT_AUTO, 0, 0},       {"a.png", KILN_FORMAT_AUTO, 3, 1}};
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        kiln_save_def def = {.format = ways[i].format};
        CHECK_OK(kiln_map_encode(context, &map, ways[i].name, &def, &files, &report, &error));
        assert_int_equal(report.cut_count, ways[i].cut);
        assert_int_equal(report.value_count, 3 * 96);
        CHECK_NEAR(report.share, (double)ways[i].cut / 288, 1e-15);
        CHECK_NEAR(report.limit, ways[i].limit, 0);
        CHECK_NEAR(report.largest, 1e6, 0);
        kiln_files_free(&files);
    }
    kiln_map_free(&map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_cut_off_is_counted),
    };
    return cmocka_run_group_tests_name("memory", tests, set_up_folder, tear_down_empty_folder);
}

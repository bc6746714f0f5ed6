// The table of formats: what an ending may hold is asked and saved by one rule, in letters of
// either case.
#include <kiln/brdf.h>

#include "kit/context.h"

static kiln_map make_ramp(kiln_shape shape)
{
    kiln_map map = make_map(context, shape, 4, 1);
    for (size_t i = 0; i < value_count(&map, 0); i++)
        map.level[0][i] = (float)i / 256;
    return map;
}

// Every ending, shape, format and compression: the question has the answer, and the sentence, of
// the work.
static void saving_does_what_the_check_says(void **state)
{
    (void)state;
    static const char *const names[] = {"a.ktx2", "a.dds", "a.exr",    "a.hdr",  "a.png", "f/",
                                        "a.glb",  "a.ktx", "a_%s.exr", "a.json", "a.h",   "a"};
    int good = 0, bad = 0;
    for (size_t n = 0; n < sizeof names / sizeof *names; n++)
        for (int shape = KILN_SHAPE_PANORAMA; shape <= KILN_SHAPE_OCTAHEDRON; shape++) {
            kiln_map map = make_ramp((kiln_shape)shape);
            for (int format = 0; format <= KILN_FORMAT_UASTC + 1; format++)
                for (int zstd = 0; zstd < 2; zstd++) {
                    const kiln_save_def def = {.format = (kiln_format)format, .zstd = zstd};
                    kiln_error asked = {0}, done = {0};
                    const char *path = in_folder(names[n]);
                    kiln_result check = kiln_map_save_check(path, (kiln_shape)shape, &def, &asked);
                    kiln_result save = kiln_map_save(context, &map, path, &def, NULL, &done);
                    assert_int_equal(check, save);
                    if (save != KILN_OK) {
                        bool lacks_zstd = zstd && !KILN_TEST_ZSTD && save == KILN_ERROR_UNSUPPORTED;
                        assert_true(save == KILN_ERROR_ARGUMENT || lacks_zstd);
                        assert_string_equal(asked.message, done.message);
                    }
                    good += save == KILN_OK;
                    bad += save != KILN_OK;
                }
            kiln_map_free(&map);
        }
    // A cube: KTX2 7 formats without zstd, and with zstd if the build has it, DDS 6, EXR, folder
    // and pattern 3 each, HDR 1, PNG 4. Another shape: EXR and folder 3 each, HDR 1, PNG 4.
    assert_int_equal(good, 7 * (1 + KILN_TEST_ZSTD) + 6 + 3 * 3 + 1 + 4 + 2 * (2 * 3 + 1 + 4));
    assert_int_equal(good + bad, 12 * 3 * 11 * 2);
}

static void sentences_name_the_way_out(void **state)
{
    (void)state;
    static const struct {
        const char *path;
        kiln_shape shape;
        kiln_save_def def;
        const char *sentence;
    } cases[] = {
        {"a.jpg", KILN_SHAPE_CUBE, {0}, "a.jpg: must end in .ktx2 .dds .exr .hdr .png or /"},
        {"a.dds",
         KILN_SHAPE_PANORAMA,
         {0},
         "a.dds: .dds files hold cubes only, save a panorama to .exr .hdr or .png"},
        {"a_%s.exr",
         KILN_SHAPE_OCTAHEDRON,
         {0},
         "a_%s.exr: the path names a face, but an octahedron has no faces"},
        {"a.hdr",
         KILN_SHAPE_CUBE,
         {.format = KILN_FORMAT_RGBA32F},
         "a.hdr: .hdr files have one format only, leave the format rgba32f out"},
        {"a.exr",
         KILN_SHAPE_CUBE,
         {.format = KILN_FORMAT_BC6H},
         "a.exr: the format bc6h can be written to .ktx2 and .dds only"},
        {"a.exr",
         KILN_SHAPE_CUBE,
         {.format = KILN_FORMAT_RGBM},
         "a.exr: the format rgbm can be written to .png only"},
        {"a.dds", KILN_SHAPE_CUBE, {.zstd = 3}, "a.dds: only .ktx2 files are compressed by zstd"},
        {"a.ktx2", KILN_SHAPE_CUBE, {.zstd = 23}, "zstd is 23, it must be 0 to 22"},
        {"a.ktx2", KILN_SHAPE_CUBE, {.format = 10}, "format is 10, it must be 0 to 9"},
        {"a.ktx2", (kiln_shape)4, {0}, "shape is 4, it must be 1 to 3"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(kiln_map_save_check(cases[i].path, cases[i].shape, &cases[i].def, &error),
                         KILN_ERROR_ARGUMENT);
        assert_string_equal(error.message, cases[i].sentence);
    }
    CHECK_OK(kiln_map_save_check("a.ktx2", KILN_SHAPE_CUBE, NULL, &error));
}

static void limits_are_those_of_the_file(void **state)
{
    (void)state;
    const struct {
        const char *path;
        kiln_format format;
        double limit;
    } cases[] = {{"a.ktx2", KILN_FORMAT_AUTO, 65504},  {"a.ktx2", KILN_FORMAT_RGBA32F, 0},
                 {"a.dds", KILN_FORMAT_RGB9E5, 65408}, {"a.dds", KILN_FORMAT_B10G11R11, 64512},
                 {"a.KTX2", KILN_FORMAT_BC6H, 65504},  {"a.ktx2", KILN_FORMAT_UASTC, 65504},
                 {"a.exr", KILN_FORMAT_AUTO, 65504},   {"folder/", KILN_FORMAT_RGBA32F, 0},
                 {"folder/", KILN_FORMAT_AUTO, 65504}, {"a.hdr", KILN_FORMAT_AUTO, 0},
                 {"a.png", KILN_FORMAT_AUTO, 1},       {"a.png", KILN_FORMAT_RGBM, 64},
                 {"a.png", KILN_FORMAT_RGBP, 64},      {"a.png", KILN_FORMAT_RGBD, 255}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_true(kiln_map_save_limit(cases[i].path, cases[i].format) == cases[i].limit);
}

static void endings_may_have_capitals(void **state)
{
    (void)state;
    static const char *const endings[][2] = {
        {"a.KTX2", ".ktx2"}, {"a.Dds", ".dds"},   {"dir.exr/", "/"}, {"a.exr.old", ""},
        {".exr", ""},        {"x/a.Inc", ".inc"}, {"a.GLB", ".glb"}, {"exr", ""}};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        assert_string_equal(kiln_path_ending(endings[i][0]), endings[i][1]);

    kiln_map cube = make_ramp(KILN_SHAPE_CUBE), back;
    static const char *const maps[][4] = {{"s.ktx2", "s.ktx2", "L.KTX2", "L.KTX2"},
                                          {"s.dds", "s.dds", "L.Dds", "L.Dds"},
                                          {"s.exr", "s_nz.exr", "L.EXR", "L_nz.EXR"},
                                          {"s.hdr", "s_px.hdr", "L.HDR", "L_px.HDR"},
                                          {"s.png", "s_py.png", "L.pNg", "L_py.pNg"}};
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) {
        CHECK_OK(kiln_map_save(context, &cube, in_folder(maps[i][0]), NULL, NULL, &error));
        CHECK_OK(kiln_map_save(context, &cube, in_folder(maps[i][2]), NULL, NULL, &error));
        check_same_files(in_folder(maps[i][1]), in_folder(maps[i][3]));
    }
    // A folder of such faces is a cube.
    CHECK_OK(kiln_map_save(context, &cube, in_folder("faces/"), NULL, NULL, &error));
    CHECK_OK(kiln_map_save(context, &cube, in_folder("faces/a_%s.Exr"), NULL, NULL, &error));
    CHECK_OK(kiln_map_load(context, in_folder("faces/a_%s.Exr"), NULL, &back, &error));
    assert_memory_equal(cube.level[0], back.level[0], kiln_map_texels(&cube, 0) * 12);
    kiln_map_free(&back);
    kiln_map_free(&cube);

    kiln_sh sh = {.bands = 2};
    CHECK_OK(kiln_sh_save(context, &sh, in_folder("s.json"), &error));
    CHECK_OK(kiln_sh_save(context, &sh, in_folder("L.JSON"), &error));
    check_same_files(in_folder("s.json"), in_folder("L.JSON"));
    float pixels[12] = {0};
    kiln_table table = {{.kind = KILN_TABLE_E, .width = 4, .height = 3, .depth = 1},
                        {4, 3, 1, pixels, NULL}};
    CHECK_OK(kiln_table_save(context, &table, in_folder("s.inc"), NULL, &error));
    CHECK_OK(kiln_table_save(context, &table, in_folder("L.INC"), NULL, &error));
    check_same_files(in_folder("s.inc"), in_folder("L.INC"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(saving_does_what_the_check_says),
        cmocka_unit_test(sentences_name_the_way_out),
        cmocka_unit_test(limits_are_those_of_the_file),
        cmocka_unit_test(endings_may_have_capitals),
    };
    return cmocka_run_group_tests(tests, set_up_folder, tear_down_folder);
}

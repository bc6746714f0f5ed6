// The names of files: a set of faces and levels is saved under names that say both, and is found
// again by a folder, a pattern or a path.
#include <sys/stat.h>
#include <unistd.h>

#include "kit/context.h"

enum { N = 6 }; // size of the cubes here

static void check_names(const char *path, int levels, const char *const *names, int count)
{
    kiln_map cube;
    cube = make_steps(context, KILN_SHAPE_CUBE, N, levels);
    kiln_save_report written = {.file_count = -1};
    CHECK_OK(kiln_map_save(context, &cube, in_folder(path), NULL, &written, &error));
    assert_int_equal(written.file_count, count);
    for (int i = 0; names && names[i]; i++)
        if (access(in_folder(names[i]), R_OK) != 0)
            fail_msg("%s was not written", names[i]);
    kiln_map_free(&cube);
}

static void names_say_face_and_level(void **state)
{
    (void)state;
    check_names("a.exr", 1, (const char *[]){"a_px.exr", "a_nz.exr", NULL}, 6);
    check_names("b.exr", 3, (const char *[]){"b_px_0.exr", "b_nz_2.exr", NULL}, 18);
    check_names("c-{level}-{face}.hdr", 2, (const char *[]){"c-0-px.hdr", "c-1-ny.hdr", NULL}, 12);
    check_names("d%s.%d.png", 2, (const char *[]){"dpz.0.png", "dnx.1.png", NULL}, 12);
    check_names("e/", 1, (const char *[]){"e/px.exr", "e/nz.exr", NULL}, 6);
    check_names("f/", 2, (const char *[]){"f/px_0.exr", "f/nz_1.exr", NULL}, 12);
    check_names("g.ktx2", 2, (const char *[]){"g.ktx2", NULL}, 1);
    check_names("h.dds", 2, (const char *[]){"h.dds", NULL}, 1);

    kiln_map panorama;
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_PANORAMA, 4, 1, &panorama, &error));
    CHECK_OK(kiln_map_save(context, &panorama, in_folder("p.exr"), NULL, NULL, &error));
    assert_int_equal(access(in_folder("p.exr"), R_OK), 0);
    assert_int_equal(kiln_map_save(context, &panorama, in_folder("p_%s.exr"), NULL, NULL, &error),
                     KILN_ERROR_ARGUMENT);
    assert_int_equal(kiln_map_save(context, &panorama, in_folder("p.ktx2"), NULL, NULL, &error),
                     KILN_ERROR_ARGUMENT);
    assert_int_equal(kiln_map_save(context, &panorama, in_folder("p.jpg"), NULL, NULL, &error),
                     KILN_ERROR_ARGUMENT);
    kiln_map_free(&panorama);
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_OCTAHEDRON, 4, 2, &panorama, &error));
    CHECK_OK(kiln_map_save(context, &panorama, in_folder("o.exr"), NULL, NULL, &error));
    assert_int_equal(access(in_folder("o_1.exr"), R_OK), 0);
    kiln_map_free(&panorama);

    // An octahedron is a square like a face: the file says what it is.
    kiln_file_info info;
    CHECK_OK(kiln_file_describe(context, in_folder("o_1.exr"), &info, &error));
    assert_string_equal(info.layout, "octahedron");
    CHECK_OK(kiln_map_load(context, in_folder("o_1.exr"), NULL, &panorama, &error));
    assert_int_equal(panorama.shape, KILN_SHAPE_OCTAHEDRON);
    assert_int_equal(panorama.size, 2);
    kiln_map_free(&panorama);
}

static void faces_are_found_again(void **state)
{
    (void)state;
    static const struct {
        const char *save, *load;
    } ways[] = {{"a/", "a"},
                {"b/", "b/"},
                {"c_%s.exr", "c_{face}.exr"},
                {"d_{face}.exr", "d_%s.exr"},
                {"e.ktx2", "e.ktx2"},
                {"f.dds", "f.dds"}};
    kiln_map cube, back;
    cube = make_steps(context, KILN_SHAPE_CUBE, N, 1);
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        CHECK_OK(kiln_map_save(context, &cube, in_folder(ways[i].save), NULL, NULL, &error));
        CHECK_OK(kiln_map_load(context, in_folder(ways[i].load), NULL, &back, &error));
        check_same_levels(&cube, &back);
        kiln_map_free(&back);
    }
    mkdir(in_folder("g"), 0777);
    CHECK_OK(kiln_map_save(context, &cube, in_folder("g/env.hdr"), NULL, NULL, &error));
    CHECK_OK(kiln_map_load(context, in_folder("g"), NULL, &back, &error));
    kiln_map_free(&back);
    // Two sets in one folder: which is meant must be said.
    CHECK_OK(kiln_map_save(context, &cube, in_folder("g/sky.hdr"), NULL, NULL, &error));
    assert_int_equal(kiln_map_load(context, in_folder("g"), NULL, &back, &error), KILN_ERROR_IO);
    CHECK_SAYS(error.message, "env_px.hdr and sky_px.hdr");
    CHECK_OK(kiln_map_save(context, &cube, in_folder("g/"), NULL, NULL, &error));
    assert_int_equal(kiln_map_load(context, in_folder("g"), NULL, &back, &error), KILN_ERROR_IO);
    CHECK_SAYS(error.message, "holds two sets of faces");
    CHECK_OK(kiln_map_load(context, in_folder("g/env_%s.hdr"), NULL, &back, &error));
    kiln_map_free(&back);
    folder_empty();
    CHECK_OK(kiln_map_save(context, &cube, in_folder("g/"), NULL, NULL, &error));
    // A face of another size, and one that is not square.
    kiln_image image;
    CHECK_OK(kiln_image_create(context, 5, 5, 3, &image, &error));
    CHECK_OK(kiln_image_save(context, &image, in_folder("g/ny.exr"), &error));
    assert_int_equal(kiln_map_load(context, in_folder("g"), NULL, &back, &error),
                     KILN_ERROR_FORMAT);
    CHECK_SAYS(error.message, "ny.exr: is 5 x 5 pixels, but the first face is 6 x 6");
    kiln_image_free(&image);
    CHECK_OK(kiln_image_create(context, 6, 5, 3, &image, &error));
    CHECK_OK(kiln_image_save(context, &image, in_folder("g/px.exr"), &error));
    assert_int_equal(kiln_map_load(context, in_folder("g"), NULL, &back, &error),
                     KILN_ERROR_FORMAT);
    CHECK_SAYS(error.message, "px.exr: is 6 x 5 pixels, a face must be square");
    kiln_image_free(&image);
    kiln_map_free(&cube);
}

static void a_file_is_described(void **state)
{
    (void)state;
    kiln_map cube;
    cube = make_steps(context, KILN_SHAPE_CUBE, N, 2);
    cube.roughness[1] = 0.25f;
    CHECK_OK(kiln_map_save(context, &cube, in_folder("a.ktx2"), NULL, NULL, &error));
    CHECK_OK(kiln_map_save(context, &cube, in_folder("f/"), NULL, NULL, &error));
    kiln_file_info info;
    CHECK_OK(kiln_file_describe(context, in_folder("a.ktx2"), &info, &error));
    assert_string_equal(info.format, "ktx2");
    assert_int_equal(info.width, N);
    assert_int_equal(info.level_count, 2);
    CHECK_OK(kiln_file_describe(context, in_folder("f/px_1.exr"), &info, &error));
    assert_string_equal(info.encoding, "half rgb, zip");
    assert_string_equal(info.layout, "image");
    assert_true(info.roughness[0] == 0.25f && info.roughness[1] == -1);
    struct stat status;
    assert_int_equal(stat(in_folder("f/px_1.exr"), &status), 0);
    assert_int_equal(info.byte_count, status.st_size);
    kiln_map_free(&cube);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(names_say_face_and_level, set_up_folder, tear_down_folder),
        cmocka_unit_test_setup_teardown(faces_are_found_again, set_up_folder, tear_down_folder),
        cmocka_unit_test_setup_teardown(a_file_is_described, set_up_folder, tear_down_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

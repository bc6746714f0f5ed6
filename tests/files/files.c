// Loading and saving by path: layouts, faces, names, and that nothing is half written.
#include "codec/codec.h"
#include "image/image.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "kit/context.h"

// A cube whose texels say where they are; exact in half floats.
static float mark(int face, int x, int y, int c)
{
    return (float)(face * 64 + y * 8 + x) + (float)c / 4;
}

enum { N = 6 };

static void make_cube(int levels, kiln_map *map)
{
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, N, levels, map, &error));
    for (int k = 0; k < map->level_count; k++) {
        int n = kiln_map_level_size(map, k);
        map->roughness[k] = 0.25f * (float)k;
        for (int i = 0; i < 6 * n * n * 3; i++)
            map->level[k][i] = mark(i / 3 / n / n, i / 3 % n, i / 3 / n % n, i % 3) + (float)k / 8;
    }
}

// Draws the cube as a picture whose face f lies at column places[f][0], row places[f][1].
static void save_picture(const kiln_map *cube, const int places[6][2], int columns, int rows,
                         const char *path)
{
    kiln_image image;
    CHECK_OK(kiln_image_create(context, columns * N, rows * N, 3, &image, &error));
    const float *texel = cube->level[0];
    for (int face = 0; face < 6; face++)
        for (int i = 0; i < N * N; i++, texel += 3) {
            int x = places[face][0] * N + i % N, y = places[face][1] * N + i / N;
            int place = y * image.width + x;
            memcpy(image.pixels + 3 * (size_t)place, texel, 3 * sizeof(float));
        }
    CHECK_OK(kiln_image_save(context, &image, path, &error));
    kiln_image_free(&image);
}

static void crosses_and_strips(void **state)
{
    (void)state;
    static const int wide[6][2] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};
    static const int tall[6][2] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {1, 3}};
    static const int row[6][2] = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}};
    static const int column[6][2] = {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}};
    kiln_map cube, back;
    make_cube(1, &cube);
    save_picture(&cube, wide, 4, 3, in_folder("wide.exr"));
    save_picture(&cube, row, 6, 1, in_folder("row.exr"));
    save_picture(&cube, column, 1, 6, in_folder("column.exr"));
    static const char *const names[] = {"wide.exr", "row.exr", "column.exr", "tall.exr"};
    // In the upright cross, -Z is upside down.
    enum { FACE = 3 * N * N, LAST = 5 * FACE };
    kiln_map hung;
    make_cube(1, &hung);
    for (int i = 0; i < FACE; i += 3)
        memcpy(hung.level[0] + LAST + FACE - 3 - i, cube.level[0] + LAST + i, 3 * sizeof(float));
    save_picture(&hung, tall, 3, 4, in_folder("tall.exr"));
    kiln_map_free(&hung);
    for (int i = 0; i < 4; i++) {
        CHECK_OK(kiln_map_load(context, in_folder(names[i]), NULL, &back, &error));
        check_same_levels(&cube, &back);
        kiln_map_free(&back);
    }
    kiln_map_free(&cube);
}

// Neighbours in a cross are neighbours on the sphere: across every seam of the picture the
// directions of two texels differ by no more than inside a face.
static void crosses_have_no_seams(void **state)
{
    (void)state;
    kiln_map cube;
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 32, 1, &cube, &error));
    for (int tall = 0; tall < 2; tall++) {
        // A picture whose texels are numbered, to find where each lands.
        int columns = tall ? 3 : 4, rows = tall ? 4 : 3, n = cube.size;
        kiln_image image;
        CHECK_OK(kiln_image_create(context, columns * n, rows * n, 3, &image, &error));
        float *pixel = image.pixels;
        for (int i = 0; i < image.width * image.height; i++, pixel += 3)
            *pixel = (float)(i + 1);
        ki_writer w = {.context = context};
        ki_exr_options options = {.roughness = -1};
        CHECK_OK(ki_exr_encode(image.pixels, image.width, image.height, 3, &options, &w, &error));
        kiln_map map;
        CHECK_OK(kiln_map_decode(context, w.bytes, w.size, "cross", NULL, &map, &error));
        double(*direction)[3] =
            calloc((size_t)image.width * (size_t)image.height, sizeof *direction);
        for (size_t i = 0; i < kiln_map_texels(&map, 0); i++) {
            size_t place = (size_t)map.level[0][3 * i] - 1;
            kiln_map_direction(&map, 0, i, direction[place]);
        }
        int seams = 0;
        for (int y = 0; y < image.height; y++)
            for (int x = 0; x < image.width; x++)
                for (int way = 0; way < 2; way++) {
                    int x2 = x + (way == 0), y2 = y + (way == 1);
                    if (x2 == image.width || y2 == image.height)
                        continue;
                    const double *a = direction[y * image.width + x];
                    const double *b = direction[y2 * image.width + x2];
                    double length = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
                    if (length < 0.5 || b[0] * b[0] + b[1] * b[1] + b[2] * b[2] < 0.5)
                        continue;
                    seams += x2 / n != x / n || y2 / n != y / n;
                    double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
                    CHECK_BELOW(acos(fmin(1, dot)), 2.01 / n);
                }
        assert_int_equal(seams, 5 * n);
        free(direction);
        ki_writer_free(&w);
        kiln_image_free(&image);
        kiln_map_free(&map);
    }
    kiln_map_free(&cube);
}

static void layouts_can_be_said(void **state)
{
    (void)state;
    static const struct {
        int width, height;
        enum kiln_layout layout;
        kiln_shape shape;
        const char *sentence;
    } cases[] = {
        {8, 4, KILN_LAYOUT_AUTO, KILN_SHAPE_PANORAMA, NULL},
        {8, 4, KILN_LAYOUT_PANORAMA, KILN_SHAPE_PANORAMA, NULL},
        {6, 6, KILN_LAYOUT_OCTAHEDRON, KILN_SHAPE_OCTAHEDRON, NULL},
        {8, 6, KILN_LAYOUT_CROSS, KILN_SHAPE_CUBE, NULL},
        {2, 12, KILN_LAYOUT_STRIP, KILN_SHAPE_CUBE, NULL},
        {6, 6, KILN_LAYOUT_AUTO, 0,
         "is 6 x 6, its sides must be 2:1 (panorama), 4:3 or 3:4 (cross), 6:1 or 1:6 (strip); if "
         "the square is an octahedron, say so by the layout"},
        {7, 5, KILN_LAYOUT_AUTO, 0,
         "is 7 x 5, its sides must be 2:1 (panorama), 4:3 or 3:4 (cross), 6:1 or 1:6 (strip)"},
        {8, 4, KILN_LAYOUT_CROSS, 0, "is 8 x 4, its sides must be 4:3 or 3:4 for a cross"},
        {8, 6, KILN_LAYOUT_PANORAMA, 0, "is 8 x 6, its sides must be 2:1 for a panorama"},
        {8, 4, KILN_LAYOUT_OCTAHEDRON, 0, "is 8 x 4, its sides must be 1:1 for an octahedron"},
        {8, 4, KILN_LAYOUT_STRIP, 0, "is 8 x 4, its sides must be 6:1 or 1:6 for a strip"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        kiln_image image;
        CHECK_OK(kiln_image_create(context, cases[i].width, cases[i].height, 3, &image, &error));
        CHECK_OK(kiln_image_save(context, &image, in_folder("a.hdr"), &error));
        kiln_image_free(&image);
        kiln_map map;
        kiln_load_def def = {.layout = cases[i].layout};
        kiln_result result = kiln_map_load(context, in_folder("a.hdr"), &def, &map, &error);
        if (cases[i].sentence) {
            assert_int_equal(result, KILN_ERROR_FORMAT);
            CHECK_SAYS(error.message, cases[i].sentence);
            CHECK_SAYS(error.message, "a.hdr");
        } else {
            CHECK_OK(result);
            assert_int_equal(map.shape, cases[i].shape);
        }
        kiln_map_free(&map);
    }
    kiln_map map;
    assert_int_equal(
        kiln_map_load(context, in_folder("a.hdr"), &(kiln_load_def){.layout = 9}, &map, &error),
        KILN_ERROR_ARGUMENT);
    assert_int_equal(kiln_map_load(context, in_folder("none.hdr"), NULL, &map, &error),
                     KILN_ERROR_IO);
    CHECK_SAYS(error.message, "none.hdr");
}

static void check_names(const char *path, int levels, const char *const *names, int count)
{
    kiln_map cube;
    make_cube(levels, &cube);
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
    make_cube(1, &cube);
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
    // Two sets in one folder: which is meant must be said; a set with plain names is preferred.
    CHECK_OK(kiln_map_save(context, &cube, in_folder("g/sky.hdr"), NULL, NULL, &error));
    assert_int_equal(kiln_map_load(context, in_folder("g"), NULL, &back, &error), KILN_ERROR_IO);
    CHECK_SAYS(error.message, "env_px.hdr and sky_px.hdr");
    CHECK_OK(kiln_map_save(context, &cube, in_folder("g/"), NULL, NULL, &error));
    CHECK_OK(kiln_map_load(context, in_folder("g"), NULL, &back, &error));
    check_same_levels(&cube, &back);
    kiln_map_free(&back);
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
    make_cube(2, &cube);
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

// A limit on the size of files stands for a full disk: the old file stays, no other appears.
static void nothing_is_half_written(void **state)
{
    (void)state;
    kiln_map cube, big, back;
    make_cube(1, &cube);
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 64, 1, &big, &error));
    fill_noise(&big, 1, 0, 1000);
    CHECK_OK(kiln_map_save(context, &cube, in_folder("a.ktx2"), NULL, NULL, &error));
    CHECK_OK(kiln_map_save(context, &cube, in_folder("a.exr"), NULL, NULL, &error));
    int before = file_count(folder_path());
    struct rlimit limit, small;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    small = limit;
    small.rlim_cur = 4096;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    kiln_result one = kiln_map_save(context, &big, in_folder("a.ktx2"), NULL, NULL, &error);
    kiln_result six = kiln_map_save(context, &big, in_folder("a.exr"), NULL, NULL, &error);
    kiln_result fresh = kiln_map_save(context, &big, in_folder("new/"), NULL, NULL, &error);
    setrlimit(RLIMIT_FSIZE, &limit);
    assert_int_equal(one, KILN_ERROR_IO);
    assert_int_equal(six, KILN_ERROR_IO);
    assert_int_equal(fresh, KILN_ERROR_IO);
    CHECK_SAYS(error.message, "new/px.exr: cannot write");
    assert_int_equal(file_count(folder_path()), before); // "new" is gone too
    CHECK_OK(kiln_map_load(context, in_folder("a.ktx2"), NULL, &back, &error));
    check_same_levels(&cube, &back);
    kiln_map_free(&back);
    CHECK_OK(kiln_map_load(context, in_folder("a_%s.exr"), NULL, &back, &error));
    check_same_levels(&cube, &back);
    kiln_map_free(&back);
    assert_int_equal(kiln_map_save(context, &cube, in_folder("missing/a.ktx2"), NULL, NULL, &error),
                     KILN_ERROR_IO);
    CHECK_SAYS(error.message, "missing/a.ktx2");
    kiln_map_free(&cube);
    kiln_map_free(&big);
}

static void check_text(const char *name, const kiln_sh *sh, const char *wanted)
{
    CHECK_OK(kiln_sh_save(context, sh, in_folder(name), &error));
    size_t size;
    char *text = (char *)read_file(in_folder(name), &size);
    assert_string_equal(text, wanted);
    free(text);
}

static void harmonics_are_text(void **state)
{
    (void)state;
    kiln_sh sh = {.bands = 2, .irradiance = true, .window = 1.5};
    for (int i = 0; i < 12; i++)
        sh.c[i / 3][i % 3] = (i - 4) / 8.0;
    check_text("a.json", &sh,
               "{\n  \"bands\": 2,\n  \"irradiance\": true,\n  \"window\": 1.5,\n"
               "  \"basis\": \"real orthonormal, no Condon-Shortley sign, l(l+1)+m\",\n"
               "  \"coefficients\": [\n    [-0.5, -0.375, -0.25],\n    [-0.125, 0, 0.125],\n"
               "    [0.25, 0.375, 0.5],\n    [0.625, 0.75, 0.875]\n  ]\n}\n");
    check_text("a.txt", &sh,
               "-0.5 -0.375 -0.25 ; Y0,0\n-0.125 0 0.125 ; Y1,-1\n0.25 0.375 0.5 ; Y1,0\n"
               "0.625 0.75 0.875 ; Y1,1\n");
    check_text("a.h", &sh,
               "// Spherical harmonics of irradiance, 2 bands, red green blue: real, orthonormal, "
               "no\n// Condon-Shortley sign, in the order l(l+1)+m. Hanning window of width 1.5.\n"
               "static const double kiln_sh_coefficients[4][3] = {\n"
               "    {-0.5, -0.375, -0.25}, // Y0,0\n    {-0.125, 0, 0.125}, // Y1,-1\n"
               "    {0.25, 0.375, 0.5}, // Y1,0\n    {0.625, 0.75, 0.875}, // Y1,1\n};\n");
    assert_int_equal(kiln_sh_save(context, &sh, in_folder("a.xml"), &error), KILN_ERROR_ARGUMENT);
    sh.bands = 6;
    assert_int_equal(kiln_sh_save(context, &sh, in_folder("a.txt"), &error), KILN_ERROR_ARGUMENT);
}

// 8192 x 4096 half floats: the picture itself, 384 MiB, and little more.
static void memory_is_the_picture(void **state)
{
    (void)state;
    enum { WIDE = 8192, HIGH = 4096 };
    ki_writer w = {.context = context};
    float *pixels = ki_alloc(context, (size_t)WIDE * HIGH, 3 * sizeof(float));
    assert_non_null(pixels);
    ki_exr_options options = {.half = true, .roughness = -1};
    CHECK_OK(ki_exr_encode(pixels, WIDE, HIGH, 3, &options, &w, &error));
    ki_free(pixels);
    kiln_context *fresh = make_context(2);
    kiln_map map;
    CHECK_OK(kiln_map_decode(fresh, w.bytes, w.size, "large.exr", NULL, &map, &error));
    size_t peak;
    kiln_context_memory(fresh, NULL, &peak);
    size_t picture = (size_t)WIDE * HIGH * 3 * sizeof(float);
    CHECK_BELOW((double)peak, (double)picture + (16 << 20));
    kiln_map_free(&map);
    kiln_context_destroy(fresh);
    ki_writer_free(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(crosses_and_strips, set_up_folder, tear_down_folder),
        cmocka_unit_test_setup_teardown(crosses_have_no_seams, set_up_folder, tear_down_folder),
        cmocka_unit_test_setup_teardown(layouts_can_be_said, set_up_folder, tear_down_folder),
        cmocka_unit_test_setup_teardown(names_say_face_and_level, set_up_folder, tear_down_folder),
        cmocka_unit_test_setup_teardown(faces_are_found_again, set_up_folder, tear_down_folder),
        cmocka_unit_test_setup_teardown(a_file_is_described, set_up_folder, tear_down_folder),
        cmocka_unit_test_setup_teardown(nothing_is_half_written, set_up_folder, tear_down_folder),
        cmocka_unit_test_setup_teardown(harmonics_are_text, set_up_folder, tear_down_folder),
        cmocka_unit_test_setup_teardown(memory_is_the_picture, set_up_folder, tear_down_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

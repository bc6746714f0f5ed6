// A picture that holds a whole environment: cubes as crosses and strips, the layout that a
// picture's sides or its reader say, and faces that are neighbours in a cross and on the sphere.
#include "codec/codec.h"

#include "kit/context.h"

enum { N = 6 }; // size of the cubes here

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
    cube = make_steps(context, KILN_SHAPE_CUBE, N, 1);
    save_picture(&cube, wide, 4, 3, in_folder("wide.exr"));
    save_picture(&cube, row, 6, 1, in_folder("row.exr"));
    save_picture(&cube, column, 1, 6, in_folder("column.exr"));
    static const char *const names[] = {"wide.exr", "row.exr", "column.exr", "tall.exr"};
    // In the upright cross, -Z is upside down.
    enum { FACE = 3 * N * N, LAST = 5 * FACE };
    kiln_map hung;
    hung = make_steps(context, KILN_SHAPE_CUBE, N, 1);
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
         "the square is an octahedron, a light probe or a mirror ball, say so by the layout"},
        {7, 5, KILN_LAYOUT_AUTO, 0,
         "is 7 x 5, its sides must be 2:1 (panorama), 4:3 or 3:4 (cross), 6:1 or 1:6 (strip)"},
        {8, 4, KILN_LAYOUT_CROSS, 0, "is 8 x 4, its sides must be 4:3 or 3:4 for a cross"},
        {8, 6, KILN_LAYOUT_PANORAMA, KILN_SHAPE_PANORAMA, NULL},
        {6, 6, KILN_LAYOUT_PROBE, KILN_SHAPE_PANORAMA, NULL},
        {6, 6, KILN_LAYOUT_BALL, KILN_SHAPE_PANORAMA, NULL},
        {8, 4, KILN_LAYOUT_PROBE, 0, "is 8 x 4, its sides must be 1:1 for a light probe"},
        {8, 4, KILN_LAYOUT_BALL, 0, "is 8 x 4, its sides must be 1:1 for a mirror ball"},
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(crosses_and_strips, set_up_folder, tear_down_folder),
        cmocka_unit_test_setup_teardown(crosses_have_no_seams, set_up_folder, tear_down_folder),
        cmocka_unit_test_setup_teardown(layouts_can_be_said, set_up_folder, tear_down_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

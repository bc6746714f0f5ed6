// Texels that are infinite, not a number, negative or missing: what becomes of them, and what the
// report says. All pictures are made here.
#include "codec/codec.h"
#include "image/pack.h"
#include "kit/context.h"
#include "kit/notes.h"

#include <float.h>

enum { ROWS = 16, WIDTH = 2 * ROWS, TEXELS = ROWS * WIDTH };

static float *texel(float *rgb, int x, int y)
{
    return rgb + 3 * (y * WIDTH + x);
}

static void set(float *rgb, float value)
{
    for (int c = 0; c < 3; c++)
        rgb[c] = value;
}

static void fill(float *rgb, float value)
{
    for (int i = 0; i < 3 * TEXELS; i++)
        rgb[i] = value;
}

// Loads the picture: floats as an EXR file, halfs, which the writer would limit, from memory.
static kiln_result load(const float *rgb, bool half, kiln_negative negative,
                        kiln_load_report *report, kiln_map *map)
{
    uint16_t halfs[3 * TEXELS];
    for (int i = 0; i < 3 * TEXELS; i++)
        halfs[i] = isinf(rgb[i]) ? 0x7c00 : ki_half_from_float(rgb[i]);
    kiln_pixels pixels = {.data = halfs,
                          .width = WIDTH,
                          .height = ROWS,
                          .channels = 3,
                          .type = KILN_PIXEL_HALF,
                          .negative = negative,
                          .report = report};
    if (half)
        return kiln_map_from_pixels(context, &pixels, map, &error);
    ki_writer w = {.context = context};
    ki_exr_options options = {.half = false, .roughness = -1};
    kiln_load_def def = {.negative = negative, .report = report};
    CHECK_OK(ki_exr_encode(rgb, WIDTH, ROWS, 3, &options, &w, &error));
    kiln_result result = kiln_map_decode(context, w.bytes, w.size, "a.exr", &def, map, &error);
    ki_writer_free(&w);
    return result;
}

static void check_end(const kiln_load_report *report, int count)
{
    kiln_note note;
    assert_false(kiln_load_report_note(report, count, &note));
    assert_false(kiln_load_report_note(report, -1, &note));
}

static void a_plain_picture_has_nothing_to_report(void **state)
{
    (void)state;
    static float rgb[3 * TEXELS];
    kiln_load_report report;
    kiln_map map;
    fill(rgb, 0.125f);
    texel(rgb, 3, 3)[0] = 1e30f; // a float of any size is data
    CHECK_OK(load(rgb, false, KILN_NEGATIVE_KEEP, &report, &map));
    assert_memory_equal(map.level[0], rgb, sizeof rgb);
    assert_int_equal(report.texel_count, TEXELS);
    check_end(&report, 0);
    kiln_map_free(&map);
}

static void infinite_texels_become_65504_in_every_type(void **state)
{
    (void)state;
    static float rgb[3 * TEXELS];
    for (int half = 0; half < 2; half++) {
        kiln_load_report report;
        kiln_map map;
        fill(rgb, 0.125f);
        set(texel(rgb, 20, 3), INFINITY);
        CHECK_OK(load(rgb, half, KILN_NEGATIVE_KEEP, &report, &map));
        for (int i = 0; i < 3 * TEXELS; i++)
            CHECK_NEAR((double)map.level[0][i], i / 3 == 3 * WIDTH + 20 ? 65504 : 0.125, 0);
        assert_int_equal(report.infinite_count, 1);
        check_note(&report, 0, KILN_NOTE_INFINITE, true,
                   "1 of 512 texels is infinite and became 65504");
        check_end(&report, 1);
        kiln_map_free(&map);
    }
}

// Neighbours have different values, and those beyond the left edge are those at the right.
static void not_a_number_becomes_the_mean_of_the_texels_around(void **state)
{
    (void)state;
    static float rgb[3 * TEXELS];
    kiln_load_report report;
    kiln_map map;
    for (int i = 0; i < 3 * TEXELS; i++)
        rgb[i] = (float)(i * i % 1021);
    texel(rgb, 0, 5)[1] = NAN;        // only green, in the first column
    set(texel(rgb, 7, 0), -INFINITY); // in the first row, which has nothing above
    CHECK_OK(load(rgb, false, KILN_NEGATIVE_KEEP, &report, &map));
    for (int c = 0; c < 3; c++) {
        double around = 0, below = 0;
        for (int y = 4; y <= 6; y++)
            for (int x = -1; x <= 1; x++)
                around += x || y != 5 ? (double)texel(rgb, (x + WIDTH) % WIDTH, y)[c] : 0;
        for (int y = 0; y <= 1; y++)
            for (int x = 6; x <= 8; x++)
                below += x != 7 || y ? (double)texel(rgb, x, y)[c] : 0;
        double kept = (double)texel(rgb, 0, 5)[c];
        CHECK_NEAR((double)texel(map.level[0], 0, 5)[c], c == 1 ? around / 8 : kept, 1e-4);
        CHECK_NEAR((double)texel(map.level[0], 7, 0)[c], below / 5, 1e-4);
    }
    assert_int_equal(report.nan_count, 2);
    check_note(&report, 0, KILN_NOTE_NAN, true,
               "2 of 512 texels are not a number and became the mean of the texels around");
    kiln_map_free(&map);
}

// In a picture that is linear in x and y a hole of 5 x 5 is symmetric about its centre.
static void holes_are_filled_from_their_border(void **state)
{
    (void)state;
    static float rgb[3 * TEXELS], first[3 * TEXELS];
    kiln_load_report report;
    kiln_map map;
    for (int y = 0; y < ROWS; y++)
        for (int x = 0; x < WIDTH; x++)
            set(texel(rgb, x, y), (float)(3 * x + 7 * y));
    memcpy(first, rgb, sizeof rgb);
    for (int y = 4; y < 9; y++)
        for (int x = 10; x < 15; x++)
            set(texel(rgb, x, y), NAN);
    CHECK_OK(load(rgb, false, KILN_NEGATIVE_KEEP, &report, &map));
    assert_int_equal(report.nan_count, 25);
    CHECK_NEAR((double)*texel(map.level[0], 12, 6), 3 * 12 + 7 * 6, 1e-4);
    // A corner has five neighbours outside the hole.
    double corner = 0;
    for (int y = 3; y <= 5; y++)
        for (int x = 9; x <= 11; x++)
            corner += x < 10 || y < 4 ? (double)*texel(first, x, y) : 0;
    CHECK_NEAR((double)*texel(map.level[0], 10, 4), corner / 5, 1e-4);
    // A texel inside has only neighbours that were filled in the first round, and the centre of the
    // hole, which has none.
    double inside = 0;
    for (int y = 4; y <= 6; y++)
        for (int x = 10; x <= 12; x++)
            inside += x == 10 || y == 4 ? (double)*texel(map.level[0], x, y) : 0;
    CHECK_NEAR((double)*texel(map.level[0], 11, 5), inside / 5, 1e-4);
    kiln_map_free(&map);
}

// From one texel the value spreads over 131071 others; a search of all texels in each round would
// take minutes.
static void one_number_suffices(void **state)
{
    (void)state;
    enum { SIZE = 256, COUNT = 2 * SIZE * SIZE };
    float *rgb = malloc(COUNT * 3 * sizeof *rgb);
    kiln_load_report report;
    kiln_map map;
    for (int i = 0; i < 3 * COUNT; i++)
        rgb[i] = i / 3 == 12345 ? 0.75f : NAN;
    kiln_pixels pixels = {
        .data = rgb, .width = 2 * SIZE, .height = SIZE, .channels = 3, .report = &report};
    CHECK_OK(kiln_map_from_pixels(context, &pixels, &map, &error));
    for (int i = 0; i < 3 * COUNT; i++)
        CHECK_NEAR((double)map.level[0][i], 0.75, 0);
    assert_int_equal(report.nan_count, COUNT - 1);
    kiln_map_free(&map);
    rgb[3 * 12345] = INFINITY;
    assert_int_equal(kiln_map_from_pixels(context, &pixels, &map, &error), KILN_ERROR_ARGUMENT);
    assert_string_equal(error.message,
                        "pixels: all of its 131072 texels are infinite or not a number");
    assert_null(map.level[0]);
    assert_int_equal(report.texel_count, 0);
    free(rgb);
}

// A face without numbers takes its values from the faces around.
static void faces_of_a_cube_are_neighbours(void **state)
{
    (void)state;
    enum { SIZE = 6, FACE = SIZE * SIZE };
    static float rgb[3 * 6 * FACE];
    kiln_load_report report;
    kiln_map map;
    for (int i = 0; i < 3 * 6 * FACE; i++)
        rgb[i] = i / 3 / FACE == 2 ? NAN : i / 3 / FACE == 3 ? 100 : 0.5f;
    kiln_pixels pixels = {
        .data = rgb, .width = SIZE, .height = 6 * SIZE, .channels = 3, .report = &report};
    CHECK_OK(kiln_map_from_pixels(context, &pixels, &map, &error));
    assert_int_equal(report.nan_count, FACE);
    for (int i = 0; i < 3 * FACE; i++)
        CHECK_NEAR((double)map.level[0][3 * 2 * FACE + i], 0.5, 0); // nothing of the face below
    kiln_map_free(&map);
}

static void pictures_without_numbers_are_refused(void **state)
{
    (void)state;
    static float rgb[3 * TEXELS];
    kiln_load_report report;
    kiln_map map;
    kiln_image image;
    fill(rgb, NAN);
    set(texel(rgb, 1, 1), INFINITY);
    assert_int_equal(load(rgb, false, KILN_NEGATIVE_KEEP, &report, &map), KILN_ERROR_FORMAT);
    assert_string_equal(error.message, "a.exr: all of its 512 texels are infinite or not a number");
    assert_null(map.level[0]);
    image = (kiln_image){.width = WIDTH, .height = ROWS, .channels = 3, .pixels = rgb};
    folder_make();
    CHECK_OK(kiln_image_save(context, &image, in_folder("nan.exr"), &error));
    assert_int_equal(kiln_image_load(context, in_folder("nan.exr"), &image, &error),
                     KILN_ERROR_FORMAT);
    assert_null(image.pixels);
    folder_remove();
}

// The share of the light by a sum over all texels with their solid angles.
static double share_below(const float *rgb)
{
    double above = 0, below = 0;
    for (int y = 0; y < ROWS; y++)
        for (int i = 0; i < 3 * WIDTH; i++) {
            double solid = cos(pi * y / ROWS) - cos(pi * (y + 1) / ROWS);
            double value = (double)rgb[3 * WIDTH * y + i];
            above += value > 0 ? value * solid : 0;
            below -= value < 0 ? value * solid : 0;
        }
    return below / above;
}

static void negative_texels_are_kept_or_become_0(void **state)
{
    (void)state;
    static float rgb[3 * TEXELS];
    fill(rgb, 0.25f);
    set(texel(rgb, 9, 2), 40);
    set(texel(rgb, 8, 2), -2);
    texel(rgb, 10, 2)[2] = -1;
    texel(rgb, 11, 2)[2] = -0.0f;
    double share = share_below(rgb);
    for (int zero = 0; zero < 2; zero++)
        for (int half = 0; half < 2; half++) {
            kiln_load_report report;
            kiln_map map;
            char text[128];
            CHECK_OK(load(rgb, half, (kiln_negative)zero, &report, &map));
            for (int i = 0; i < 3 * TEXELS; i++) {
                CHECK_NEAR((double)map.level[0][i], zero && rgb[i] < 0 ? 0 : (double)rgb[i], 0);
                assert_true(map.level[0][i] != 0 || !signbit(map.level[0][i]));
            }
            assert_int_equal(report.negative_count, 2);
            assert_int_equal(report.negative, zero);
            CHECK_NEAR(report.negative_share, share, 1e-12);
            snprintf(text, sizeof text,
                     "2 of 512 texels are negative and %s, with %.3g %% of the "
                     "light",
                     zero ? "became 0" : "kept", 100 * share);
            check_note(&report, 0, KILN_NOTE_NEGATIVE, false, text);
            check_end(&report, 1);
            kiln_map_free(&map);
        }
    kiln_map map;
    assert_int_equal(load(rgb, true, (kiln_negative)2, NULL, &map), KILN_ERROR_ARGUMENT);
    assert_string_equal(error.message, "negative is 2, it must be 0 or 1");
}

// Six files: counts add up, and the report is one for all.
static void six_faces_have_one_report(void **state)
{
    (void)state;
    enum { SIZE = 4, FACE = SIZE * SIZE };
    static float rgb[3 * FACE];
    char names[6][8];
    const char *paths[6];
    kiln_load_report report;
    kiln_map map;
    folder_make();
    for (int face = 0; face < 6; face++) {
        for (int i = 0; i < 3 * FACE; i++)
            rgb[i] = (float)(face + 1);
        rgb[3 * face] = -1;
        rgb[3 * face + 7] = INFINITY;
        kiln_image image = {.width = SIZE, .height = SIZE, .channels = 3, .pixels = rgb};
        snprintf(names[face], sizeof names[face], "%d.exr", face);
        paths[face] = in_folder(names[face]);
        CHECK_OK(kiln_image_save(context, &image, paths[face], &error));
    }
    kiln_load_def def = {.negative = KILN_NEGATIVE_ZERO, .report = &report};
    CHECK_OK(kiln_map_load_faces(context, paths, &def, &map, &error));
    assert_int_equal(map.shape, KILN_SHAPE_CUBE);
    for (int face = 0; face < 6; face++)
        for (int i = 0; i < 3 * FACE; i++) {
            double wanted = i == 3 * face ? 0 : i == 3 * face + 7 ? 65504 : face + 1;
            CHECK_NEAR((double)map.level[0][3 * FACE * face + i], wanted, 0);
        }
    assert_int_equal(report.texel_count, 6 * FACE);
    assert_int_equal(report.negative_count, 6);
    assert_int_equal(report.infinite_count, 6);
    check_note(&report, 0, KILN_NOTE_INFINITE, true,
               "6 of 96 texels are infinite and became 65504");
    kiln_map_free(&map);
    folder_remove();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plain_picture_has_nothing_to_report),
        cmocka_unit_test(infinite_texels_become_65504_in_every_type),
        cmocka_unit_test(not_a_number_becomes_the_mean_of_the_texels_around),
        cmocka_unit_test(holes_are_filled_from_their_border),
        cmocka_unit_test(one_number_suffices),
        cmocka_unit_test(faces_of_a_cube_are_neighbours),
        cmocka_unit_test(pictures_without_numbers_are_refused),
        cmocka_unit_test(negative_texels_are_kept_or_become_0),
        cmocka_unit_test(six_faces_have_one_report),
    };
    return cmocka_run_group_tests_name("values", tests, set_up, tear_down);
}

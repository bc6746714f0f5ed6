// Data in and out of memory: pixels to maps, maps in borrowed memory, levels packed for a graphics
// processor, and maps that outlive their context.
#include "codec/codec.h"
#include "image/pack.h"

#include <float.h>

#include "kit/context.h"

// Values of every kind.
static const float odd[] = {NAN, -1, INFINITY, -INFINITY, 1e-40f, -0.0f, 3e38f, 0.25f, -NAN};
enum { ODD = sizeof odd / sizeof *odd };

static float odd_value(size_t i)
{
    return i % 5 == 0 ? odd[i / 5 % ODD] : (float)(i % 97) / 16;
}

// Whether all values are finite, and zeros have no sign.
static bool is_sane(const kiln_map *map)
{
    for (size_t i = 0; i < 3 * kiln_map_texels(map, 0); i++) {
        float value = map->level[0][i];
        if (!(fabsf(value) <= FLT_MAX) || (value == 0 && signbit(value)))
            return false;
    }
    return true;
}

// The same picture as an uncompressed EXR, by kiln's own writer, which keeps every float as it is.
static void load_as_exr(const float *rgb, int width, int height, bool half, kiln_map *map)
{
    ki_writer w = {.context = context};
    ki_exr_options options = {.half = half, .roughness = -1};
    CHECK_OK(ki_exr_encode(rgb, width, height, 3, &options, &w, &error));
    CHECK_OK(kiln_map_decode(context, w.bytes, w.size, "odd.exr", NULL, map, &error));
    ki_writer_free(&w);
}

static void bad_texels_become_what_they_become_in_files(void **state)
{
    (void)state;
    enum { HEIGHT = 20, WIDTH = 40, COUNT = 3 * WIDTH * HEIGHT };
    static float rgb[COUNT];
    for (size_t i = 0; i < COUNT; i++)
        rgb[i] = odd_value(i);
    kiln_map file, memory;
    load_as_exr(rgb, WIDTH, HEIGHT, false, &file);
    CHECK_OK(kiln_map_from_pixels(
        context, &(kiln_pixels){.data = rgb, .width = WIDTH, .height = HEIGHT, .channels = 3},
        &memory, &error));
    assert_int_equal(memory.shape, KILN_SHAPE_PANORAMA);
    assert_int_equal(memory.size, HEIGHT);
    assert_true(is_sane(&memory));
    assert_memory_equal(memory.level[0], file.level[0], sizeof rgb);
    CHECK_NEAR((double)memory.level[0][5], -1, 0);
    CHECK_NEAR((double)memory.level[0][10], 65504, 0);         // infinity
    CHECK_NEAR((double)memory.level[0][30], (double)3e38f, 0); // a float of this size stays
    kiln_map_free(&memory);
    kiln_map_free(&file);
    // Halves, of every kind there is.
    enum { SIDE = 128 };
    static uint16_t halfs[4 * SIDE * 2 * SIDE];
    for (size_t i = 0; i < sizeof halfs / sizeof *halfs; i++)
        halfs[i] = (uint16_t)i;
    CHECK_OK(kiln_map_from_pixels(context,
                                  &(kiln_pixels){.data = halfs,
                                                 .width = 2 * SIDE,
                                                 .height = SIDE,
                                                 .channels = 4,
                                                 .type = KILN_PIXEL_HALF},
                                  &memory, &error));
    assert_true(is_sane(&memory));
    for (size_t i = 0; i < 2 * SIDE * SIDE; i++)
        for (size_t c = 0; c < 3; c++) {
            uint16_t half = halfs[4 * i + c];
            bool is_nan =
                (half & 0x7fff) > 0x7c00 || half == 0xfc00; // minus infinity counts as one
            double wanted = half == 0x7c00 ? 65504 : (double)ki_float_from_half(half);
            if (!is_nan)
                CHECK_NEAR((double)memory.level[0][3 * i + c], wanted, 0);
        }
    kiln_map_free(&memory);
}

static void rows_may_have_gaps_and_run_upwards(void **state)
{
    (void)state;
    // Four channels, an odd address, 13 bytes between rows.
    enum { HEIGHT = 6, WIDTH = 12, STRIDE = 16 * WIDTH + 13 };
    static unsigned char bytes[HEIGHT * STRIDE + 1];
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < 4 * WIDTH; x++) {
            float value = (float)(100 * y + x);
            memcpy(bytes + 1 + y * STRIDE + 4 * x, &value, 4);
        }
    for (int up = 0; up < 2; up++) {
        kiln_map map;
        kiln_pixels pixels = {.data = bytes + 1 + (up ? (HEIGHT - 1) * STRIDE : 0),
                              .width = WIDTH,
                              .height = HEIGHT,
                              .channels = 4,
                              .row_stride = up ? -STRIDE : STRIDE};
        CHECK_OK(kiln_map_from_pixels(context, &pixels, &map, &error));
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++)
                for (int c = 0; c < 3; c++)
                    CHECK_NEAR((double)map.level[0][3 * (y * WIDTH + x) + c],
                               100 * (up ? HEIGHT - 1 - y : y) + 4 * x + c, 0);
        kiln_map_free(&map);
    }
}

static void six_faces_in_a_row_are_a_cube(void **state)
{
    (void)state;
    kiln_map cube, made;
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 7, 1, &cube, &error));
    for (size_t i = 0; i < 3 * kiln_map_texels(&cube, 0); i++)
        cube.level[0][i] = (float)i;
    kiln_pixels pixels = {.data = cube.level[0], .width = 7, .height = 42, .channels = 3};
    CHECK_OK(kiln_map_from_pixels(context, &pixels, &made, &error));
    assert_int_equal(made.shape, KILN_SHAPE_CUBE);
    assert_int_equal(made.size, 7);
    assert_memory_equal(made.level[0], cube.level[0], 3 * 6 * 49 * sizeof(float));
    kiln_map_free(&made);
    static const struct {
        kiln_pixels change;
        const char *said;
    } wrong[] = {
        {{.width = 7, .height = 41, .channels = 3}, "pixels: is 7 x 41"},
        {{.width = 7, .height = 42, .channels = 2}, "2 channels"},
        {{.width = 7, .height = 42, .channels = 3, .row_stride = 83}, "at least a row's 84 bytes"},
        {{.width = -7, .height = 42, .channels = 3}, "-7"},
        {{.width = 7, .height = 42, .channels = 3, .layout = 9}, "layout is 9"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        pixels = wrong[i].change;
        pixels.data = cube.level[0];
        assert_int_equal(kiln_map_from_pixels(context, &pixels, &made, &error),
                         KILN_ERROR_ARGUMENT);
        assert_int_equal(error.result, KILN_ERROR_ARGUMENT);
        CHECK_SAYS(error.message, wrong[i].said);
        assert_null(made.level[0]);
    }
    kiln_map_free(&cube);
}

// Levels in the caller's memory are read and written like kiln's own.
static void borrowed_memory_is_taken(void **state)
{
    (void)state;
    static float source[3 * 16 * 32], level[2][3 * 6 * 64], diffuse[3 * 6 * 4];
    for (size_t i = 0; i < sizeof source / sizeof *source; i++)
        source[i] = (float)(i * 7 % 31);
    kiln_map in = {.shape = KILN_SHAPE_PANORAMA, .size = 16, .level_count = 1, .level = {source}};
    kiln_environment out = {.levels = {.size = 8, .level_count = 2, .level = {level[0], level[1]}},
                            .irradiance = {.size = 2, .level_count = 1, .level = {diffuse}}};
    out.levels.shape = out.irradiance.shape = KILN_SHAPE_CUBE;
    kiln_bake_def def = {.levels = {.size = 8, .level_count = 2}, .irradiance_size = 2};
    kiln_environment wanted;
    kiln_plan *plan;
    CHECK_OK(kiln_bake(context, &in, &def, &wanted, &error));
    CHECK_OK(kiln_plan_create(context, KILN_SHAPE_PANORAMA, 16, &def, &plan, &error));
    CHECK_OK(kiln_plan_execute(plan, &in, &out, &error));
    check_same_levels(&out.levels, &wanted.levels);
    assert_memory_equal(diffuse, wanted.irradiance.level[0], sizeof diffuse);
    kiln_plan_destroy(plan);
    kiln_environment_free(&wanted);
    kiln_environment_free(&out); // frees nothing
    kiln_map_free(&in);
    assert_null(in.level[0]);
}

// What is packed is what stands in the files: behind 148 bytes of header, face after face.
static void packed_levels_are_those_of_files(void **state)
{
    (void)state;
    static const kiln_format formats[] = {KILN_FORMAT_RGBA16F, KILN_FORMAT_RGBA32F,
                                          KILN_FORMAT_RGB9E5, KILN_FORMAT_B10G11R11,
                                          KILN_FORMAT_BC6H};
    kiln_map map;
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 10, 1, &map, &error));
    for (size_t i = 0; i < 3 * kiln_map_texels(&map, 0); i++)
        map.level[0][i] = (float)(i % 89) * 0.37f;
    for (size_t f = 0; f < sizeof formats / sizeof *formats; f++) {
        kiln_save_def def = {.format = formats[f]};
        kiln_files files;
        CHECK_OK(kiln_map_encode(context, &map, "a.dds", &def, &files, NULL, &error));
        size_t size = kiln_map_packed_size(&map, 0, formats[f]);
        assert_int_equal(files.file[0].size, size + 148);
        unsigned char *packed = malloc(size);
        CHECK_OK(kiln_map_pack(context, &map, 0, formats[f], packed, 0, size, &error));
        assert_memory_equal(packed, files.file[0].bytes + 148, size);
        // With gaps, which stay as they are.
        size_t rows = formats[f] == KILN_FORMAT_BC6H ? 18 : 60, row = size / rows;
        size_t stride = row + 24, room = (rows - 1) * stride + row;
        unsigned char *wide = malloc(room);
        memset(wide, 0xab, room);
        CHECK_OK(kiln_map_pack(context, &map, 0, formats[f], wide, stride, room, &error));
        for (size_t y = 0; y < rows; y++) {
            assert_memory_equal(wide + y * stride, packed + y * row, row);
            for (size_t i = row; y + 1 < rows && i < stride; i++)
                assert_int_equal(wide[y * stride + i], 0xab);
        }
        assert_int_equal(
            kiln_map_pack(context, &map, 0, formats[f], wide, stride, room - 1, &error),
            KILN_ERROR_ARGUMENT);
        assert_int_equal(kiln_map_pack(context, &map, 0, formats[f], wide, row - 1, room, &error),
                         KILN_ERROR_ARGUMENT);
        free(wide);
        free(packed);
        kiln_files_free(&files);
    }
    unsigned char none[4];
    assert_int_equal(kiln_map_packed_size(&map, 0, KILN_FORMAT_RGBM), 0);
    assert_int_equal(kiln_map_pack(context, &map, 0, KILN_FORMAT_RGBM, none, 0, 4, &error),
                     KILN_ERROR_ARGUMENT);
    assert_int_equal(kiln_map_pack(context, &map, 1, KILN_FORMAT_AUTO, none, 0, 4, &error),
                     KILN_ERROR_ARGUMENT);
    kiln_map_free(&map);
}

static void maps_may_outlive_their_context(void **state)
{
    (void)state;
    failing f;
    kiln_context *own = failing_context_of(&f, 2);
    kiln_map map;
    kiln_image image;
    kiln_environment made;
    kiln_files files;
    kiln_spectrum *spectrum;
    kiln_plan *plan;
    CHECK_OK(kiln_sky(own, &(kiln_sky_def){.size = 16}, &map, &error));
    CHECK_OK(kiln_image_create(own, 3, 3, 1, &image, &error));
    kiln_bake_def bake = {.levels = {.size = 8}};
    CHECK_OK(kiln_bake(own, &map, &bake, &made, &error));
    CHECK_OK(kiln_spectrum_analyze(own, &map, 8, &spectrum, &error));
    CHECK_OK(kiln_plan_create(own, KILN_SHAPE_PANORAMA, 16, &bake, &plan, &error));
    CHECK_OK(kiln_map_encode(own, &map, "a.exr", NULL, &files, NULL, &error));
    long held = f.held;
    kiln_context_destroy(own);
    assert_int_equal(f.held, held - 1); // the context itself; what the blocks need stays
    kiln_map_free(&map);
    kiln_image_free(&image);
    kiln_environment_free(&made);
    kiln_spectrum_destroy(spectrum);
    kiln_plan_destroy(plan);
    kiln_files_free(&files);
    assert_int_equal(f.held, 0);
    assert_int_equal(f.bytes, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_texels_become_what_they_become_in_files),
        cmocka_unit_test(rows_may_have_gaps_and_run_upwards),
        cmocka_unit_test(six_faces_in_a_row_are_a_cube),
        cmocka_unit_test(borrowed_memory_is_taken),
        cmocka_unit_test(packed_levels_are_those_of_files),
        cmocka_unit_test(maps_may_outlive_their_context),
    };
    return cmocka_run_group_tests_name("pixels", tests, set_up, tear_down);
}

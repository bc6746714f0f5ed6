// PNG: every colour type and depth as libpng writes it, as linear floats; and what kiln writes.
#include "check.h"
#include "codec/codec.h"
#include "codec/rgbx.h"
#include "image/pack.h"

#include <png.h>

#include "context.h"

static kiln_error error;

enum { W = 19, H = 11 };

static void write_bytes(png_structp png, png_bytep bytes, size_t size)
{
    ki_write(png_get_io_ptr(png), bytes, size);
}

static void flush(png_structp png)
{
    (void)png;
}

static int sample(int x, int y, int c, int depth)
{
    return (x * 37 + y * 101 + c * 59 + (x * y * 257)) & ((1 << depth) - 1);
}

static void make(ki_writer *w, int color, int depth, bool interlaced)
{
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, w, write_bytes, flush);
    png_set_IHDR(png, info, W, H, depth, color, interlaced ? PNG_INTERLACE_ADAM7 : 0, 0, 0);
    png_color palette[256];
    if (color == PNG_COLOR_TYPE_PALETTE) {
        for (int i = 0; i < 1 << depth; i++)
            palette[i] = (png_color){(png_byte)i, (png_byte)(255 - i), (png_byte)(i * 7)};
        png_set_PLTE(png, info, palette, 1 << depth);
    }
    png_set_gAMA(png, info, 1.0); // which is not to change anything
    png_write_info(png, info);
    png_set_packing(png); // one byte a sample below 8 bits
    int channels = png_get_channels(png, info);
    static png_byte rows[H][W * 8];
    png_bytep row[H];
    for (int y = 0; y < H; y++) {
        png_bytep to = row[y] = rows[y];
        for (int i = 0; i < W * channels; i++) {
            int value = sample(i / channels, y, i % channels, depth);
            if (depth == 16)
                *to++ = (png_byte)(value >> 8);
            *to++ = (png_byte)value;
        }
    }
    png_write_image(png, row);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
}

// The sRGB value that channel c of the picture should have had.
static double wanted_value(int x, int y, int c, int color, int depth)
{
    int most = (1 << depth) - 1;
    if (color == PNG_COLOR_TYPE_PALETTE) {
        int i = sample(x, y, 0, depth);
        int entry[3] = {i, 255 - i, i * 7 & 255};
        return entry[c] / 255.0;
    }
    bool rgb = color & PNG_COLOR_MASK_COLOR;
    return (double)sample(x, y, rgb ? c : 0, depth) / most;
}

static void every_kind_is_read(void **state)
{
    (void)state;
    static const int kinds[][2] = {{PNG_COLOR_TYPE_GRAY, 1},       {PNG_COLOR_TYPE_GRAY, 2},
                                   {PNG_COLOR_TYPE_GRAY, 4},       {PNG_COLOR_TYPE_GRAY, 8},
                                   {PNG_COLOR_TYPE_GRAY, 16},      {PNG_COLOR_TYPE_RGB, 8},
                                   {PNG_COLOR_TYPE_RGB, 16},       {PNG_COLOR_TYPE_PALETTE, 1},
                                   {PNG_COLOR_TYPE_PALETTE, 4},    {PNG_COLOR_TYPE_PALETTE, 8},
                                   {PNG_COLOR_TYPE_GRAY_ALPHA, 8}, {PNG_COLOR_TYPE_GRAY_ALPHA, 16},
                                   {PNG_COLOR_TYPE_RGB_ALPHA, 8},  {PNG_COLOR_TYPE_RGB_ALPHA, 16}};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        for (int interlaced = 0; interlaced < 2; interlaced++) {
            ki_writer w = {.context = context};
            make(&w, kinds[k][0], kinds[k][1], interlaced);
            ki_decoded decoded;
            CHECK_OK(ki_decode(context, w.bytes, w.size, "made.png", &decoded, NULL, &error));
            assert_int_equal(decoded.image.width, W);
            assert_int_equal(decoded.image.height, H);
            for (int i = 0; i < W * H * 3; i++) {
                double v = wanted_value(i / 3 % W, i / 3 / W, i % 3, kinds[k][0], kinds[k][1]);
                double linear = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
                CHECK_NEAR((double)decoded.image.pixels[i], linear, linear * 4e-7);
            }
            ki_decoded_free(&decoded);
            ki_writer_free(&w);
        }
}

static void what_is_written_comes_back(void **state)
{
    (void)state;
    float pixels[256 * 4];
    for (int i = 0; i < 256; i++)
        for (int k = 0; k < 4; k++)
            pixels[4 * i + k] = ki_linear_from_srgb((float)i / 255);
    for (int srgb = 0; srgb < 2; srgb++)
        for (int channels = 3; channels <= 4; channels++) {
            ki_writer w = {.context = context};
            CHECK_OK(ki_png_encode(pixels, 256 * 4 / channels / 4, 4, channels,
                                   srgb ? KI_PNG_SRGB8 : KI_PNG_PLAIN8, &w, &error));
            ki_decoded decoded;
            CHECK_OK(ki_decode(context, w.bytes, w.size, "back.png", &decoded, NULL, &error));
            int count = 256 * 4 / channels / 4 * 4;
            for (int i = 0; i < count * 3; i++) {
                float from = pixels[i / 3 * channels + i % 3];
                double wanted = (double)from;
                if (!srgb) // the stored value, as the reader understands it
                    wanted = (double)ki_linear_from_srgb(floorf(from * 255 + 0.5f) / 255);
                CHECK_NEAR((double)decoded.image.pixels[i], wanted, 1e-7);
            }
            ki_decoded_free(&decoded);
            ki_writer_free(&w);
        }
}

// Halfway between two sRGB values the upper one begins, outside they are clamped.
static void srgb_bytes_are_nearest(void **state)
{
    (void)state;
    float middle = ki_linear_from_srgb(100.5f / 255);
    const float pixels[6] = {nextafterf(middle, 0), middle, -1, 2, NAN, 1};
    ki_writer w = {.context = context};
    CHECK_OK(ki_png_encode(pixels, 6, 1, 1, KI_PNG_SRGB8, &w, &error));
    ki_decoded decoded;
    CHECK_OK(ki_decode(context, w.bytes, w.size, "back.png", &decoded, NULL, &error));
    const int wanted[6] = {100, 101, 0, 255, 0, 255};
    const float *pixel = decoded.image.pixels;
    for (int i = 0; i < 6; i++, pixel += 3)
        CHECK_NEAR((double)*pixel, (double)ki_linear_from_srgb((float)wanted[i] / 255), 0);
    ki_decoded_free(&decoded);
    ki_writer_free(&w);
}

// A panorama in four bytes, read by libpng itself.
static void radiance_in_four_bytes_comes_back(void **state)
{
    (void)state;
    static const struct {
        kiln_format format;
        void (*unpack)(const float packed[4], float rgb[3]);
        double bound; // of the largest channel, relative
    } codings[] = {{KILN_FORMAT_RGBM, ki_float_from_rgbm, 0.005},
                   {KILN_FORMAT_RGBD, ki_float_from_rgbd, 0.007},
                   {KILN_FORMAT_RGBP, ki_float_from_rgbp, 0.005}};
    enum { SIZE = 16, COUNT = 2 * SIZE * SIZE };
    kiln_map map;
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_PANORAMA, SIZE, 1, &map, &error));
    for (int i = 0; i < 3 * COUNT; i++)
        map.level[0][i] = (float)exp2(6.0 * (i % 1009) / 1009); // 1 to 64
    for (int k = 0; k < 3; k++) {
        static png_byte bytes[4 * COUNT];
        kiln_save_def def = {.format = codings[k].format};
        png_image image = {.version = PNG_IMAGE_VERSION};
        CHECK_OK(kiln_map_save(context, &map, "four-bytes.png", &def, NULL, &error));
        assert_int_not_equal(png_image_begin_read_from_file(&image, "four-bytes.png"), 0);
        assert_int_equal(image.format, PNG_FORMAT_RGBA);
        assert_int_equal(image.width, 2 * SIZE);
        assert_int_equal(image.height, SIZE);
        assert_int_not_equal(png_image_finish_read(&image, NULL, bytes, 0, NULL), 0);
        for (int i = 0; i < COUNT; i++) {
            float stored[4], back[3];
            const float *rgb = map.level[0] + 3 * (size_t)i;
            int most = rgb[1] > rgb[0] ? 1 : 0;
            most = rgb[2] > rgb[most] ? 2 : most;
            for (int c = 0; c < 4; c++)
                stored[c] = (float)bytes[4 * i + c] / 255;
            codings[k].unpack(stored, back);
            CHECK_NEAR((double)(back[most] / rgb[most]), 1, codings[k].bound);
        }
        assert_int_equal(kiln_map_save(context, &map, "four-bytes.exr", &def, NULL, &error),
                         KILN_ERROR_ARGUMENT);
    }
    remove("four-bytes.png");
    kiln_map_free(&map);
}

static void a_cut_file_is_said(void **state)
{
    (void)state;
    ki_writer w = {.context = context};
    make(&w, PNG_COLOR_TYPE_RGB, 16, true);
    ki_decoded decoded;
    assert_int_equal(ki_decode(context, w.bytes, w.size / 2, "cut.png", &decoded, NULL, &error),
                     KILN_ERROR_FORMAT);
    assert_string_equal(error.message, "cut.png: the PNG is damaged: the file ends too early");
    ki_writer_free(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_kind_is_read, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_written_comes_back, set_up, tear_down),
        cmocka_unit_test_setup_teardown(srgb_bytes_are_nearest, set_up, tear_down),
        cmocka_unit_test_setup_teardown(radiance_in_four_bytes_comes_back, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_cut_file_is_said, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

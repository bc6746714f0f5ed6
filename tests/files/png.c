// PNG: every colour type, depth, filter and interlacing as libpng writes them, as linear floats;
// what kiln writes, as libpng reads it; and what is damaged.
#include "codec/codec.h"
#include "codec/deflate.h"
#include "codec/rgbx.h"
#include "image/pack.h"

#include <png.h>

#include "kit/context.h"

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

typedef struct made {
    int width, height, color, depth;
    bool interlaced, transparent;
    int filters; // libpng's bits, 0 for its own choice
    int data;    // bytes of a chunk IDAT, 0 for libpng's choice
} made;

enum { MOST = 40 };

static void add_palette(png_structp png, png_infop info, int depth)
{
    png_color palette[256];
    for (int i = 0; i < 1 << depth; i++)
        palette[i] = (png_color){(png_byte)i, (png_byte)(255 - i), (png_byte)(i * 7)};
    png_set_PLTE(png, info, palette, 1 << depth);
}

// What must not change a pixel: a chunk that says what the default is, and transparent colours.
static void add_ancillary(png_structp png, png_infop info, const made *m)
{
    static const png_byte alphas[4] = {0, 100, 200, 255};
    const png_color_16 color = {.red = 1, .green = 1, .blue = 1, .gray = 1};
    png_set_sRGB(png, info, PNG_sRGB_INTENT_RELATIVE);
    if (m->transparent)
        png_set_tRNS(png, info, alphas, m->depth < 2 ? 2 : 4, &color);
}

static void make(ki_writer *w, const made *m)
{
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, w, write_bytes, flush);
    png_set_IHDR(png, info, (png_uint_32)m->width, (png_uint_32)m->height, m->depth, m->color,
                 m->interlaced ? PNG_INTERLACE_ADAM7 : 0, 0, 0);
    if (m->filters)
        png_set_filter(png, 0, m->filters);
    if (m->data)
        png_set_compression_buffer_size(png, (size_t)m->data);
    if (m->color == PNG_COLOR_TYPE_PALETTE)
        add_palette(png, info, m->depth);
    add_ancillary(png, info, m);
    png_write_info(png, info);
    png_set_packing(png); // one byte a sample below 8 bits
    int channels = png_get_channels(png, info);
    static png_byte rows[MOST][MOST * 8];
    png_bytep row[MOST];
    for (int y = 0; y < m->height; y++) {
        png_bytep to = row[y] = rows[y];
        for (int i = 0; i < m->width * channels; i++) {
            int value = sample(i / channels, y, i % channels, m->depth);
            if (m->depth == 16)
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

static void check_read(const made *m)
{
    ki_writer w = {.context = context};
    make(&w, m);
    ki_decoded decoded;
    CHECK_OK(ki_decode(context, w.bytes, w.size, "made.png", &decoded, NULL, &error));
    assert_int_equal(decoded.image.width, m->width);
    assert_int_equal(decoded.image.height, m->height);
    for (int i = 0; i < m->width * m->height * 3; i++) {
        double v = wanted_value(i / 3 % m->width, i / 3 / m->width, i % 3, m->color, m->depth);
        double linear = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
        CHECK_NEAR((double)decoded.image.pixels[i], linear, linear * 4e-7);
    }
    ki_decoded_free(&decoded);
    ki_writer_free(&w);
}

static const struct {
    int color, depth;
} kinds[] = {
    {PNG_COLOR_TYPE_GRAY, 1},        {PNG_COLOR_TYPE_GRAY, 2},      {PNG_COLOR_TYPE_GRAY, 4},
    {PNG_COLOR_TYPE_GRAY, 8},        {PNG_COLOR_TYPE_GRAY, 16},     {PNG_COLOR_TYPE_RGB, 8},
    {PNG_COLOR_TYPE_RGB, 16},        {PNG_COLOR_TYPE_PALETTE, 1},   {PNG_COLOR_TYPE_PALETTE, 2},
    {PNG_COLOR_TYPE_PALETTE, 4},     {PNG_COLOR_TYPE_PALETTE, 8},   {PNG_COLOR_TYPE_GRAY_ALPHA, 8},
    {PNG_COLOR_TYPE_GRAY_ALPHA, 16}, {PNG_COLOR_TYPE_RGB_ALPHA, 8}, {PNG_COLOR_TYPE_RGB_ALPHA, 16}};
enum { KINDS = sizeof kinds / sizeof *kinds };

// Every kind, with each filter alone and by libpng's choice, in one chunk and in many.
static void every_kind_and_filter_is_read(void **state)
{
    (void)state;
    static const int filters[] = {0,
                                  PNG_FILTER_NONE,
                                  PNG_FILTER_SUB,
                                  PNG_FILTER_UP,
                                  PNG_FILTER_AVG,
                                  PNG_FILTER_PAETH,
                                  PNG_ALL_FILTERS};
    for (size_t k = 0; k < KINDS; k++)
        for (int i = 0; i < 7 * 2 * 2; i++) {
            bool transparent = i % 3 == 0 && !(kinds[k].color & PNG_COLOR_MASK_ALPHA);
            check_read(&(made){19, 11, kinds[k].color, kinds[k].depth, i / 7 % 2, transparent,
                               filters[i % 7], i / 14 ? 50 : 0});
        }
}

// Adam7 leaves passes out of small pictures.
static void every_small_size_is_read(void **state)
{
    (void)state;
    for (size_t k = 0; k < KINDS; k++)
        for (int i = 0; i < 9 * 9 * 2; i += kinds[k].depth == 16 ? 7 : 1)
            check_read(&(made){1 + i % 9, 1 + i / 9 % 9, kinds[k].color, kinds[k].depth, i / 81,
                               false, 0, 0});
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

// Eight and sixteen bits of one to four channels, larger than a part that is packed at once, as
// libpng reads them.
static void libpng_reads_what_is_written(void **state)
{
    (void)state;
    enum { WIDTH = 700, HEIGHT = 301 };
    static float pixels[WIDTH * HEIGHT * 4];
    static png_uint_16 back[WIDTH * HEIGHT * 4];
    for (int i = 0; i < WIDTH * HEIGHT * 4; i++)
        pixels[i] = (float)((i / 5000 * 977 + i % 5000 / 4 + i % 4 * 300) % 65536) / 65535;
    for (int coding = KI_PNG_SRGB8; coding <= KI_PNG_PLAIN16; coding++)
        for (int channels = 1; channels <= 4; channels++) {
            ki_writer w = {.context = context};
            CHECK_OK(
                ki_png_encode(pixels, WIDTH, HEIGHT, channels, (ki_png_coding)coding, &w, &error));
            png_image image = {.version = PNG_IMAGE_VERSION};
            assert_int_not_equal(png_image_begin_read_from_memory(&image, w.bytes, w.size), 0);
            assert_int_equal(image.width, WIDTH);
            assert_int_equal(image.height, HEIGHT);
            assert_int_equal(image.warning_or_error, 0);
            bool wide = coding == KI_PNG_PLAIN16;
            png_uint_32 format = (channels > 2 ? PNG_FORMAT_FLAG_COLOR : 0U) |
                                 (channels % 2 ? 0U : PNG_FORMAT_FLAG_ALPHA) |
                                 (wide ? PNG_FORMAT_FLAG_LINEAR : 0U);
            assert_int_equal(image.format & PNG_FORMAT_RGBA, format & PNG_FORMAT_RGBA);
            if (!wide) { // 16 bits would be premultiplied: kiln's own reader and oiiotool see those
                image.format = format;
                assert_int_not_equal(png_image_finish_read(&image, NULL, back, 0, NULL), 0);
                assert_int_equal(image.warning_or_error, 0);
                const png_byte *got = (const png_byte *)back;
                for (int i = 0; i < WIDTH * HEIGHT * channels; i++) {
                    float v = pixels[i];
                    if (coding == KI_PNG_SRGB8)
                        v = v <= 0.0031308f ? v * 12.92f : 1.055f * powf(v, 1 / 2.4f) - 0.055f;
                    CHECK_NEAR(got[i], (double)(v * 255), 0.501);
                }
            }
            png_image_free(&image);
            ki_decoded decoded;
            CHECK_OK(ki_decode(context, w.bytes, w.size, "back.png", &decoded, NULL, &error));
            for (int i = 0; i < WIDTH * HEIGHT * 3; i++) {
                float from = pixels[i / 3 * channels + (channels < 3 ? 0 : i % 3)];
                if (wide)
                    CHECK_NEAR((double)decoded.image.pixels[i], (double)ki_linear_from_srgb(from),
                               1e-6);
            }
            ki_decoded_free(&decoded);
            ki_writer_free(&w);
        }
}

static void refused(ki_writer *w, const char *sentence)
{
    ki_decoded decoded;
    assert_int_equal(ki_decode(context, w->bytes, w->size, "bad.png", &decoded, NULL, &error),
                     KILN_ERROR_FORMAT);
    assert_string_equal(error.message, sentence);
}

static size_t find(const ki_writer *w, const char *type)
{
    for (size_t i = 0; i + 4 <= w->size; i++)
        if (!memcmp(w->bytes + i, type, 4))
            return i;
    fail_msg("no chunk %s", type);
    return 0;
}

static void set_sum(ki_writer *w, size_t type)
{
    ki_crc32_table table;
    ki_crc32_fill(&table);
    uint32_t size;
    memcpy(&size, w->bytes + type - 4, 4);
    size = __builtin_bswap32(size);
    uint32_t sum = __builtin_bswap32(ki_crc32(&table, 0, w->bytes + type, size + 4));
    memcpy(w->bytes + type + 4 + size, &sum, 4);
}

static void what_is_damaged_is_said(void **state)
{
    (void)state;
    const made rgb = {.width = 9, .height = 7, .color = PNG_COLOR_TYPE_RGB, .depth = 16};
    ki_writer w = {.context = context};
    make(&w, &rgb);
    size_t data = find(&w, "IDAT"), size = w.size;
    w.size /= 2;
    refused(&w, "bad.png: the PNG is damaged: the file ends too early");
    w.size = size;
    w.bytes[data + 10] ^= 1;
    refused(&w, "bad.png: the PNG is damaged: the CRC of a chunk is wrong");
    set_sum(&w, data);
    refused(&w, "bad.png: the PNG is damaged: its data does not inflate to the picture's size "
                "or has a wrong Adler-32 sum");
    w.bytes[data + 10] ^= 1;
    uint32_t bytes;
    memcpy(&bytes, w.bytes + data - 4, 4);
    w.bytes[data + 3 + __builtin_bswap32(bytes)] ^= 1; // the last byte of the data's own sum
    set_sum(&w, data);
    refused(&w, "bad.png: the PNG is damaged: its data does not inflate to the picture's size "
                "or has a wrong Adler-32 sum");
    w.bytes[data + 3 + __builtin_bswap32(bytes)] ^= 1;
    set_sum(&w, data);
    size_t coding = find(&w, "sRGB");
    w.bytes[coding] = 'S'; // critical now
    set_sum(&w, coding);
    refused(&w, "bad.png: the PNG is damaged: it has a critical chunk that PNG does not define");
    w.bytes[coding] = 's'; // whose sum is wrong now, which is nobody's loss
    kiln_image image;
    CHECK_OK(ki_png_decode(context, w.bytes, w.size, "good.png", &image, NULL, NULL, &error));
    kiln_image_free(&image);
    size_t head = find(&w, "IHDR");
    w.bytes[head + 12] = 3;
    set_sum(&w, head);
    refused(&w,
            "bad.png: the PNG is damaged: 9 x 7 pixels of 3 bits, colour type 2, compression 0, "
            "filters 0, interlacing 0");
    ki_writer_free(&w);
}

// Rows that the data has beyond the picture are not looked at, as libpng does.
static void more_data_than_pixels_is_read(void **state)
{
    (void)state;
    const made tall = {.width = 9, .height = 30, .color = PNG_COLOR_TYPE_GRAY, .depth = 8};
    ki_writer w = {.context = context};
    make(&w, &tall);
    size_t head = find(&w, "IHDR");
    w.bytes[head + 11] = 7; // rows
    set_sum(&w, head);
    kiln_image image;
    CHECK_OK(ki_png_decode(context, w.bytes, w.size, "more.png", &image, NULL, NULL, &error));
    assert_int_equal(image.height, 7);
    for (int i = 0; i < 9 * 7; i++) {
        float v = (float)sample(i % 9, i / 9, 0, 8) / 255;
        CHECK_NEAR((double)image.pixels[(ptrdiff_t)3 * i], (double)ki_linear_from_srgb(v), 0);
    }
    kiln_image_free(&image);
    ki_writer_free(&w);
}

// A palette's entries that the file leaves out are black.
static void a_short_palette_is_filled_with_black(void **state)
{
    (void)state;
    const made m = {.width = 16, .height = 4, .color = PNG_COLOR_TYPE_PALETTE, .depth = 4};
    ki_writer w = {.context = context}, cut = {.context = context};
    make(&w, &m);
    size_t palette = find(&w, "PLTE");
    enum { LEFT = 5 };
    ki_write(&cut, w.bytes, palette - 4);
    ki_write(&cut, "\0\0\0\x0fPLTE", 8);
    ki_write(&cut, w.bytes + palette + 4, LEFT * 3 + 4);
    ki_write(&cut, w.bytes + palette + 4 + 16 * 3 + 4, w.size - palette - 4 - 16 * 3 - 4);
    set_sum(&cut, find(&cut, "PLTE"));
    kiln_image image;
    CHECK_OK(ki_png_decode(context, cut.bytes, cut.size, "cut.png", &image, NULL, NULL, &error));
    for (int i = 0; i < 16 * 4; i++) {
        int index = sample(i % 16, i / 16, 0, 4);
        float green = index < LEFT ? ki_linear_from_srgb((float)(255 - index) / 255) : 0;
        CHECK_NEAR((double)image.pixels[3 * i + 1], (double)green, 0);
    }
    kiln_image_free(&image);
    ki_writer_free(&w);
    ki_writer_free(&cut);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_kind_and_filter_is_read, set_up, tear_down),
        cmocka_unit_test_setup_teardown(every_small_size_is_read, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_written_comes_back, set_up, tear_down),
        cmocka_unit_test_setup_teardown(srgb_bytes_are_nearest, set_up, tear_down),
        cmocka_unit_test_setup_teardown(radiance_in_four_bytes_comes_back, set_up, tear_down),
        cmocka_unit_test_setup_teardown(libpng_reads_what_is_written, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_damaged_is_said, set_up, tear_down),
        cmocka_unit_test_setup_teardown(more_data_than_pixels_is_read, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_short_palette_is_filled_with_black, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

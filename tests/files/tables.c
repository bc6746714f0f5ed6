// Tables as files: every format there and back, which tables and formats a file cannot hold, and
// which files hold no table.
#include "lookup/tables.h"
#include "image/pack.h"
#include "table/table_text.h"

#include <png.h>
#include <unistd.h>

#include "kit/context.h"

static size_t number_count(const kiln_table *table)
{
    return (size_t)table->image.width * (size_t)table->image.height * (size_t)table->image.channels;
}

static void check_def(const kiln_table_def *def, const kiln_table_def *wanted)
{
    char text[KI_TABLE_TEXT], other[KI_TABLE_TEXT];
    ki_table_describe(def, text);
    ki_table_describe(wanted, other);
    assert_string_equal(text, other);
}

// What a number becomes in a format.
static float store(kiln_table_format format, float value)
{
    switch (format) {
    case KILN_TABLE_FORMAT_F32:
        return value;
    case KILN_TABLE_FORMAT_U16:
        return (float)round((double)value * 65535) / 65535;
    case KILN_TABLE_FORMAT_U8:
        return (float)round((double)value * 255) / 255;
    default:
        return ki_float_from_half(ki_half_from_float(value));
    }
}

static void ktx2_there_and_back(void **state)
{
    (void)state;
    static const char *const names[] = {"16f", "32f", "16f", "16", "8"};
    static const char *const colors[] = {"r", "rg", "rgba", "rgba"};
    const char *path = in_folder("a.ktx2");
    for (int i = 0; i < LOOKUP_TABLES; i++) {
        kiln_table table, back;
        CHECK_OK(lookup_table(context, i, &table, &error));
        kiln_table_save_def def = {.format = (kiln_table_format)(i / 2 % 5),
                                   .zstd = i % 3 ? 0 : 3 * KILN_TEST_ZSTD};
        CHECK_OK(kiln_table_save(context, &table, path, &def, &error));
        CHECK_OK(kiln_table_load(context, path, &back, &error));
        check_def(&back.def, &table.def);
        assert_int_equal(number_count(&back), number_count(&table));
        assert_int_equal(back.image.channels, table.image.channels);
        for (size_t k = 0; k < number_count(&table); k++)
            if (back.image.pixels[k] != store(def.format, table.image.pixels[k]))
                fail_msg("table %d: number %zu is %.9g, saved %.9g", i, k,
                         (double)back.image.pixels[k], (double)table.image.pixels[k]);
        kiln_file_info info;
        CHECK_OK(kiln_file_describe(context, path, &info, &error));
        char encoding[48], text[KI_TABLE_TEXT];
        snprintf(encoding, sizeof encoding, "%s%s%s", colors[table.image.channels - 1],
                 names[def.format], def.zstd ? ", zstd" : "");
        ki_table_describe(&table.def, text);
        assert_string_equal(info.encoding, encoding);
        assert_string_equal(info.layout, "table");
        assert_string_equal(info.table, text);
        assert_string_equal(info.orientation, table.def.depth > 1 ? "rdi" : "rd");
        assert_int_equal(info.width, table.def.width);
        assert_int_equal(info.height, table.def.height);
        assert_int_equal(info.depth, table.def.depth);
        assert_int_equal(info.face_count, 1);
        kiln_table_free(&back);
        kiln_table_free(&table);
    }
}

// EXR keeps floats; a reader sees grey, or red and green, or the colours.
static void exr_there_and_back(void **state)
{
    (void)state;
    const char *path = in_folder("a.exr");
    for (int i = 0; i < 24; i++) {
        kiln_table table;
        kiln_image image;
        CHECK_OK(lookup_table(context, i, &table, &error));
        table.image.pixels[0] = 0.7F; // not to lose a sign
        kiln_table_save_def def = {.format = (kiln_table_format)(i % 3)};
        kiln_table_format stored =
            def.format == KILN_TABLE_FORMAT_F16 ? KILN_TABLE_FORMAT_F16 : KILN_TABLE_FORMAT_F32;
        CHECK_OK(kiln_table_save(context, &table, path, &def, &error));
        CHECK_OK(kiln_image_load(context, path, &image, &error));
        assert_int_equal(image.width, table.def.width);
        assert_int_equal(image.height, table.def.height * table.def.depth);
        int channels = table.image.channels;
        for (size_t k = 0; k < (size_t)image.width * (size_t)image.height; k++)
            for (size_t c = 0; c < 3 && c < (size_t)channels; c++)
                assert_true(image.pixels[3 * k + c] ==
                            store(stored, table.image.pixels[k * (size_t)channels + c]));
        kiln_file_info info;
        char text[KI_TABLE_TEXT];
        CHECK_OK(kiln_file_describe(context, path, &info, &error));
        ki_table_describe(&table.def, text);
        assert_string_equal(info.table, text);
        kiln_image_free(&image);
        kiln_table_free(&table);
    }
}

static void png_has_the_nearest_numbers(void **state)
{
    (void)state;
    const char *path = in_folder("a.png");
    for (int i = 0; i < 24; i++) {
        kiln_table table;
        CHECK_OK(lookup_table(context, i, &table, &error));
        table.image.pixels[0] = -0.25F;
        int bits = i % 2 ? 16 : 8;
        kiln_table_save_def def = {.format = bits == 8    ? KILN_TABLE_FORMAT_U8
                                             : i % 3 == 0 ? KILN_TABLE_FORMAT_AUTO
                                                          : KILN_TABLE_FORMAT_U16};
        CHECK_OK(kiln_table_save(context, &table, path, &def, &error));
        FILE *file = fopen(path, "rb");
        png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
        png_infop info = png_create_info_struct(png);
        png_init_io(png, file);
        png_read_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
        int channels = table.image.channels, stored = channels == 2 ? 3 : channels;
        assert_int_equal(png_get_bit_depth(png, info), bits);
        assert_int_equal(png_get_channels(png, info), stored);
        assert_int_equal(png_get_image_width(png, info), table.image.width);
        assert_int_equal(png_get_image_height(png, info), table.image.height);
        png_bytepp rows = png_get_rows(png, info);
        for (int y = 0; y < table.image.height; y++)
            for (int k = 0; k < table.image.width * stored; k++) {
                const png_byte *at = rows[y] + k * bits / 8;
                int value = bits == 8 ? at[0] : at[0] << 8 | at[1], c = k % stored;
                size_t texel = (size_t)y * (size_t)table.image.width + (size_t)(k / stored);
                double number =
                    c < channels ? (double)table.image.pixels[texel * (size_t)channels + (size_t)c]
                                 : 0;
                CHECK_NEAR(value, fmax(number, 0) * ((1 << bits) - 1), 0.5);
            }
        png_destroy_read_struct(&png, &info, NULL);
        fclose(file);
        kiln_table_free(&table);
    }
}

static void hdr_and_raw_hold_the_numbers(void **state)
{
    (void)state;
    for (int i = 0; i < 24; i++) {
        kiln_table table;
        CHECK_OK(lookup_table(context, i, &table, &error));
        size_t count = number_count(&table), size;
        kiln_table_save_def def = {.format = (kiln_table_format)(i % 5)};
        CHECK_OK(
            kiln_table_save(context, &table, in_folder(i % 2 ? "a.raw" : "a.bin"), &def, &error));
        uint8_t *bytes = read_file(in_folder(i % 2 ? "a.raw" : "a.bin"), &size);
        static const size_t widths[] = {4, 4, 2, 2, 1};
        assert_int_equal(size, count * widths[i % 5]);
        for (size_t k = 0; k < count; k++) {
            float value = 0;
            uint16_t word = 0;
            memcpy(widths[i % 5] == 4 ? (void *)&value : (void *)&word, bytes + k * widths[i % 5],
                   widths[i % 5]);
            if (i % 5 == KILN_TABLE_FORMAT_F16)
                value = ki_float_from_half(word);
            else if (i % 5 >= KILN_TABLE_FORMAT_U16)
                value = (float)word / (i % 5 == KILN_TABLE_FORMAT_U8 ? 255 : 65535);
            kiln_table_format stored = def.format ? def.format : KILN_TABLE_FORMAT_F32;
            assert_true(value == store(stored, table.image.pixels[k]));
        }
        free(bytes);
        int channels = table.image.channels;
        kiln_result result = kiln_table_save(context, &table, in_folder("a.hdr"), NULL, &error);
        assert_int_equal(result, channels == 4 ? KILN_ERROR_ARGUMENT : KILN_OK);
        kiln_image image = {0};
        if (result == KILN_OK)
            CHECK_OK(kiln_image_load(context, in_folder("a.hdr"), &image, &error));
        for (size_t k = 0; k < 3 * (size_t)image.width * (size_t)image.height; k++) {
            size_t c = channels == 1 ? 0 : k % 3;
            double number =
                c < (size_t)channels ? (double)table.image.pixels[k / 3 * (size_t)channels + c] : 0;
            CHECK_NEAR((double)image.pixels[k], number, 1.0 / 256);
        }
        kiln_image_free(&image);
        kiln_table_free(&table);
    }
}

static void refused(const kiln_table *table, const char *name, const kiln_table_save_def *def,
                    const char *sentence)
{
    int before = file_count(folder_path());
    kiln_result result = kiln_table_save(context, table, in_folder(name), def, &error);
    assert_int_equal(result, KILN_ERROR_ARGUMENT);
    CHECK_SAYS(error.message, sentence);
    assert_int_equal(file_count(folder_path()), before);
}

static void what_cannot_be_saved_is_said(void **state)
{
    (void)state;
    kiln_table table, large = {.def = {.width = 256, .height = 65, .depth = 1}};
    CHECK_OK(lookup_table(context, 0, &table, &error));
    refused(&table, "a.tga", NULL, "must end in .ktx2 .exr .hdr .png .raw .bin .h .inc or .glsl");
    refused(&table, "a.png", &(kiln_table_save_def){.format = KILN_TABLE_FORMAT_F16},
            "a .png file has no format f16");
    refused(&table, "a.hdr", &(kiln_table_save_def){.format = KILN_TABLE_FORMAT_F32},
            "a .hdr file has no format f32");
    refused(&table, "a.exr", &(kiln_table_save_def){.format = KILN_TABLE_FORMAT_U8},
            "a .exr file has no format u8");
    refused(&table, "a.h", &(kiln_table_save_def){.format = KILN_TABLE_FORMAT_F16},
            "a .h file has no format f16");
    refused(&table, "a.ktx2", &(kiln_table_save_def){.format = (kiln_table_format)6},
            "format is 6, it must be 0 to 5");
    refused(&table, "a.ktx2", &(kiln_table_save_def){.format = KILN_TABLE_FORMAT_RGBD},
            "a .ktx2 file has no format rgbd");
    refused(&table, "a.ktx2", &(kiln_table_save_def){.zstd = 23}, "zstd is 23, it must be 0 to 22");
    refused(&table, "a.raw", &(kiln_table_save_def){.zstd = 3},
            "only .ktx2 files are compressed by zstd");
    static const char *const names[] = {"", "9a", "a-b", "_a", "a__b", "gl_a"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        refused(&table, "a.h", &(kiln_table_save_def){.name = names[i]}, "the name is \"");
    float alpha = table.image.pixels[3];
    table.image.pixels[3] = INFINITY;
    refused(&table, "a.exr", NULL, "number 3 of the table is not finite");
    table.image.pixels[3] = alpha;
    table.def.kind = KILN_TABLE_DFG;
    refused(&table, "a.exr", NULL, "is 7 x 5 with 1 channels, it must be 7 x 5 with 2");
    table.def.kind = (kiln_table_kind)9;
    refused(&table, "a.exr", NULL, "kind, d, g, axis and sheen are 9, 0, 0, 0 and 0");
    kiln_table_free(&table);

    CHECK_OK(kiln_image_create(context, 256, 65, 1, &large.image, &error));
    refused(&large, "a.glsl", NULL,
            "would hold 66560 bytes, the limit of a constant array is 65536");
    CHECK_OK(kiln_table_save(context, &large, in_folder("small.glsl"),
                             &(kiln_table_save_def){.format = KILN_TABLE_FORMAT_U16}, &error));
    kiln_table_free(&large);
    large.def = (kiln_table_def){.width = 4096, .height = 1025, .depth = 1};
    CHECK_OK(kiln_image_create(context, 4096, 1025, 1, &large.image, &error));
    refused(&large, "a.h", NULL, "would hold 4198400 numbers, the limit is 4194304");
    kiln_table_free(&large);
}

// Files of other sorts, and tables that are not what they say.
static void what_is_no_table_is_not_loaded(void **state)
{
    (void)state;
    kiln_table table, back;
    kiln_map map;
    kiln_image image;
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 4, 1, &map, &error));
    CHECK_OK(kiln_map_save(context, &map, in_folder("cube.ktx2"), NULL, NULL, &error));
    kiln_map_free(&map);
    assert_int_equal(kiln_table_load(context, in_folder("cube.ktx2"), &back, &error),
                     KILN_ERROR_UNSUPPORTED);
    CHECK_OK(lookup_table(context, 6, &table, &error)); // four channels and slices
    CHECK_OK(kiln_table_save(context, &table, in_folder("t.exr"), NULL, &error));
    assert_int_equal(kiln_table_load(context, in_folder("t.exr"), &back, &error),
                     KILN_ERROR_UNSUPPORTED);
    CHECK_OK(kiln_table_save(context, &table, in_folder("t.ktx2"), NULL, &error));
    assert_int_equal(kiln_map_load(context, in_folder("t.ktx2"), NULL, &map, &error),
                     KILN_ERROR_UNSUPPORTED);
    CHECK_SAYS(error.message, "holds a table, not an environment");
    CHECK_OK(kiln_image_load(context, in_folder("t.ktx2"), &image, &error));
    assert_int_equal(image.channels, 4);
    assert_int_equal(image.height, 15);
    kiln_image_free(&image);
    // As the face of a cube.
    assert_int_equal(symlink("t.ktx2", in_folder("px.exr")), 0);
    assert_int_equal(kiln_map_load(context, in_folder("%s.exr"), NULL, &map, &error),
                     KILN_ERROR_UNSUPPORTED);
    CHECK_SAYS(error.message, "holds a table, not a face");
    kiln_table_free(&table);
    assert_null(back.image.pixels);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ktx2_there_and_back),
        cmocka_unit_test(exr_there_and_back),
        cmocka_unit_test(png_has_the_nearest_numbers),
        cmocka_unit_test(hdr_and_raw_hold_the_numbers),
        cmocka_unit_test(what_cannot_be_saved_is_said),
        cmocka_unit_test(what_is_no_table_is_not_loaded),
    };
    return cmocka_run_group_tests(tests, set_up_folder, tear_down_folder);
}

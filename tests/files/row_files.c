// Files that are baked while their rows pass by: the same environments, reports and error messages
// as of files that are loaded as a whole.
#include "exr_make.h"

#include "base/bytes.h"
#include "codec/row_file.h"
#include "kit/context.h"

enum { ROWS = 40 };

static const kiln_bake_def quick = {.levels = {.size = 8, .tolerance = 0.01},
                                    .irradiance_size = KILN_NO_IRRADIANCE};

// Returns whether a file is decoded by rows.
static bool passes(const char *path, const kiln_load_def *load)
{
    ki_row_file *file;
    kiln_rows rows;
    CHECK_OK(ki_row_file_open(context, path, load, &file, &rows, &error));
    ki_row_file_close(file);
    return file;
}

// Bakes a file by rows and as a whole, and checks that both say and make the same.
static void compare(const char *path, kiln_layout layout, kiln_negative negative)
{
    kiln_load_report reports[2];
    kiln_load_def load = {.layout = layout, .negative = negative, .report = &reports[0]};
    kiln_environment made, wanted = {0};
    kiln_extent source;
    kiln_map map;
    kiln_error other;
    kiln_result result = kiln_bake_file(context, path, &load, &quick, &source, &made, &error);
    load.report = &reports[1];
    kiln_result expected = kiln_map_load(context, path, &load, &map, &other);
    if (expected == KILN_OK)
        expected = kiln_bake(context, &map, &quick, &wanted, &other);
    assert_int_equal(result, expected);
    if (result != KILN_OK) {
        assert_string_equal(error.message, other.message);
        assert_null(made.levels.level[0]);
        return;
    }
    assert_int_equal(source.shape, map.shape);
    assert_int_equal(source.size, map.size);
    assert_true(same_map(&made.levels, &wanted.levels));
    assert_memory_equal(&made.sh, &wanted.sh, sizeof made.sh);
    assert_memory_equal(&made.levels_cut, &wanted.levels_cut, sizeof made.levels_cut);
    kiln_note notes[2];
    for (int i = 0; kiln_load_report_note(&reports[1], i, &notes[1]); i++) {
        assert_true(kiln_load_report_note(&reports[0], i, &notes[0]));
        assert_string_equal(notes[0].text, notes[1].text);
    }
    assert_int_equal(reports[0].texel_count, reports[1].texel_count);
    assert_int_equal(reports[0].infinite_count, reports[1].infinite_count);
    assert_int_equal(reports[0].nan_count, reports[1].nan_count);
    assert_int_equal(reports[0].negative_count, reports[1].negative_count);
    assert_int_equal(reports[0].missing_count, reports[1].missing_count);
    assert_int_equal(reports[0].note_count, reports[1].note_count);
    assert_memory_equal(&reports[0].negative_share, &reports[1].negative_share, sizeof(double));
    kiln_map_free(&map);
    kiln_environment_free(&made);
    kiln_environment_free(&wanted);
}

static void save(const char *path, uint8_t *bytes, size_t size)
{
    write_file(path, bytes, size);
    free(bytes);
}

// --------------------------------------------------------------------------------------------- EXR

// Noise with some values below zero.
static float noise(int x, int y, const char *channel)
{
    uint64_t place = (uint64_t)(x + 64) << 32 | (uint64_t)(y + 64) << 8 | (uint64_t)channel[0];
    return (float)(random_hash(place) >> 44) / (float)(1 << 20) - 0.01F;
}

static const exr_make_channel colours[] = {{"B", EXR_PIXEL_HALF, 0, false},
                                           {"G", EXR_PIXEL_FLOAT, 0, false},
                                           {"R", EXR_PIXEL_HALF, 0, false}};

static const struct {
    int tile_width, tile_height;
    exr_lineorder_t order;
} layouts[] = {{0, 0, EXR_LINEORDER_INCREASING_Y},
               {0, 0, EXR_LINEORDER_DECREASING_Y},
               {20, 12, EXR_LINEORDER_DECREASING_Y},
               {16, 64, EXR_LINEORDER_RANDOM_Y}};

static void every_compression_and_order(void **state)
{
    (void)state;
    const char *path = in_folder("rows.exr");
    for (int compression = 0; compression <= EXR_COMPRESSION_B44A; compression++)
        for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++) {
            exr_make make = {.width = 2 * ROWS,
                             .height = ROWS,
                             .x = -3,
                             .y = 5 * (int)i,
                             .compression = (exr_compression_t)compression,
                             .order = layouts[i].order,
                             .tile_width = layouts[i].tile_width,
                             .tile_height = layouts[i].tile_height,
                             .channels = colours,
                             .channel_count = 3,
                             .part_count = 1 + (int)i % 2,
                             .value = noise};
            size_t size;
            uint8_t *bytes = exr_make_file(&make, &size);
            save(path, bytes, size);
            assert_true(passes(path, &(kiln_load_def){0}));
            compare(path, KILN_LAYOUT_AUTO, (kiln_negative)(i % 2));
        }
}

// Data windows that lie within the display window, around it and beside it.
static void windows(void **state)
{
    (void)state;
    const char *path = in_folder("window.exr");
    static const int places[][4] = {
        {10, 7, 30, 20}, {-9, -8, 100, 60}, {-5, 30, 60, 31}, {40, -20, 30, 45}};
    for (size_t i = 0; i < 8; i++) {
        const int *p = places[i / 2];
        exr_make make = {.x = p[0],
                         .y = p[1],
                         .width = p[2],
                         .height = p[3],
                         .display = {{{{0, 0}}}, {{{2 * ROWS - 1, ROWS - 1}}}},
                         .compression = i % 2 ? EXR_COMPRESSION_PIZ : EXR_COMPRESSION_ZIP,
                         .tile_width = i % 2 ? 11 : 0,
                         .tile_height = i % 2 ? 7 : 0,
                         .channels = colours,
                         .channel_count = 3,
                         .value = noise};
        size_t size;
        uint8_t *bytes = exr_make_file(&make, &size);
        save(path, bytes, size);
        assert_true(passes(path, &(kiln_load_def){0}));
        compare(path, KILN_LAYOUT_AUTO, KILN_NEGATIVE_KEEP);
    }
}

static float strange_at; // row of the strange values
static float strange_value;

static float strange(int x, int y, const char *channel)
{
    bool here = (y == (int)strange_at || strange_at < 0) && (x == 7 || strange_at < 0);
    return here ? strange_value : fabsf(noise(x, y, channel));
}

// Infinite values, values that are not a number, and values below zero: near a pole, in the middle,
// and everywhere.
static void values_that_are_no_radiance(void **state)
{
    (void)state;
    const char *path = in_folder("strange.exr");
    const float values[] = {INFINITY, -INFINITY, NAN, -2, -0.0F};
    const int rows[] = {0, 20, 39, -1};
    for (size_t i = 0; i < 20; i++) {
        exr_make make = {.width = 2 * ROWS,
                         .height = ROWS,
                         .compression = EXR_COMPRESSION_NONE,
                         .channels = colours,
                         .channel_count = 3,
                         .value = strange};
        size_t place = i / 5;
        strange_at = (float)rows[place];
        strange_value = values[i % 5];
        size_t size;
        uint8_t *bytes = exr_make_file(&make, &size);
        save(path, bytes, size);
        compare(path, KILN_LAYOUT_AUTO, KILN_NEGATIVE_KEEP);
        compare(path, KILN_LAYOUT_PANORAMA, KILN_NEGATIVE_ZERO);
    }
}

// Files that end too early or have wrong bytes fail with the message that loading gives.
static void damage(void **state)
{
    (void)state;
    const char *path = in_folder("damaged.exr");
    size_t size;
    exr_make make = {.width = 2 * ROWS,
                     .height = ROWS,
                     .compression = EXR_COMPRESSION_ZIP,
                     .channels = colours,
                     .channel_count = 3,
                     .value = noise};
    uint8_t *bytes = exr_make_file(&make, &size);
    for (size_t i = 1; i < 40; i++) {
        write_file(path, bytes, size * i / 40);
        compare(path, KILN_LAYOUT_AUTO, KILN_NEGATIVE_KEEP);
        uint8_t kept = bytes[size * i / 40];
        bytes[size * i / 40] = (uint8_t)~kept;
        write_file(path, bytes, size);
        compare(path, KILN_LAYOUT_AUTO, KILN_NEGATIVE_KEEP);
        bytes[size * i / 40] = kept;
    }
    free(bytes);
}

// What is read as a whole: other layouts, sides of another ratio, and a file that is no regular
// file.
static void other_pictures(void **state)
{
    (void)state;
    static const char *const names[] = {"envmap-cube.exr", "envmap-latlong.exr", "dwaa-half.exr"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[256];
        snprintf(path, sizeof path, "%s/%s", KILN_GOOD_FILES, names[i]);
        compare(path, KILN_LAYOUT_AUTO, KILN_NEGATIVE_KEEP);
        compare(path, KILN_LAYOUT_PANORAMA, KILN_NEGATIVE_KEEP);
    }
    kiln_extent source;
    kiln_environment made;
    assert_int_equal(kiln_bake_file(context, "/no/such.exr", NULL, NULL, &source, &made, &error),
                     KILN_ERROR_IO);
    assert_int_equal(source.size, 0);
    assert_false(passes("-", &(kiln_load_def){0}));
    assert_false(passes("/dev/null", &(kiln_load_def){0}));
}

// --------------------------------------------------------------------------------------------- HDR

// Lines of the three encodings, in four orientations, with and without conversions.
static void every_hdr(void **state)
{
    (void)state;
    static const char *const first[] = {"-Y", "+Y", "-X"}, *const second[] = {"+X", "-X", "+Y"};
    const char *path = in_folder("rows.hdr");
    for (int i = 0; i < 3 * 3 * 2; i++) {
        int coding = i % 3, turn = i / 3 % 3, width = coding ? 2 * ROWS : ROWS, height = width / 2;
        bool columns = turn == 2;
        ki_writer w = {.context = context};
        ki_write_text(&w, "#?RADIANCE\n%s\n%s %d %s %d\n",
                      i < 9 ? "" : "EXPOSURE=2\nFORMAT=32-bit_rle_xyze\n", first[turn],
                      columns ? width : height, second[turn], columns ? height : width);
        for (int line = 0; line < (columns ? width : height); line++) {
            int length = columns ? height : width;
            if (coding)
                ki_write(&w, (const uint8_t[4]){2, 2, 0, (uint8_t)length}, 4);
            for (int c = 0; c < 4 && coding; c++) {
                // a run over the first half and single bytes after it
                ki_write_u8(&w, (uint8_t)(128 + length / 2));
                ki_write_u8(&w, (uint8_t)(c < 3 ? 9 * line + c : 127));
                ki_write_u8(&w, (uint8_t)(length - length / 2));
                for (int x = length / 2; x < length; x++)
                    ki_write_u8(&w, (uint8_t)(c < 3 ? 7 * x + 31 * line : 128));
            }
            for (int x = 0; x < length && !coding; x++)
                ki_write(&w, (const uint8_t[4]){(uint8_t)(3 * x), (uint8_t)(5 * line), 77, 129}, 4);
        }
        write_file(path, w.bytes, coding == 2 ? w.size - 9 : w.size);
        ki_writer_free(&w);
        assert_int_equal(passes(path, &(kiln_load_def){0}), !columns && coding != 2);
        compare(path, KILN_LAYOUT_AUTO, KILN_NEGATIVE_KEEP);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_compression_and_order),
        cmocka_unit_test(windows),
        cmocka_unit_test(values_that_are_no_radiance),
        cmocka_unit_test(damage),
        cmocka_unit_test(other_pictures),
        cmocka_unit_test(every_hdr),
    };
    return cmocka_run_group_tests(tests, set_up_folder, tear_down_folder);
}

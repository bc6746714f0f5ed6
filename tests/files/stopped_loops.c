// Loops over the content of large files can be stopped: over texels, blocks, rows of faces, tiles of
// one pixel, markers, attributes and the bytes themselves. As in stopped.c, the tests count how
// often a reading asks whether to go on, and compare that with a smaller file of the same kind.
#include "codec/codec.h"
#include "codec/galacean_env.h"
#include "codec/gltf.h"
#include "kit/context.h"
#include "kit/folder.h"
#include "kit/stopping.h"

#include "exr_make.h"
#include "exr_plain.h"

#include <stdio.h>

static countdown reports;
static kiln_context *own;

static void begin(void)
{
    kiln_context_def def = {.thread_count = 1, .progress = count_down, .progress_user = &reports};
    CHECK_OK(kiln_context_create(&def, &own, &error));
}

static kiln_result decode(const void *file)
{
    const ki_writer *w = file;
    kiln_map map;
    assert_false(w->failed);
    kiln_result result = kiln_map_decode(own, w->bytes, w->size, "a", NULL, &map, &error);
    assert_true(result == KILN_OK || !map.level[0]);
    kiln_map_free(&map);
    return result;
}

// Returns the number of questions of long work, and stops the work at some of them: at the first,
// the second, the fourth and so on.
static int count_long(kiln_result (*work)(const void *data), const void *data)
{
    reports = (countdown){.left = 1 << 30};
    CHECK_OK(work(data));
    int asked = reports.calls;
    for (int stop = 1; stop < asked / 2; stop *= 2) {
        reports = (countdown){.left = stop - 1};
        assert_int_equal(work(data), KILN_ERROR_CANCELLED);
        assert_int_equal(reports.calls, stop);
    }
    return asked;
}

// Returns the number of questions of the decoding of a file, and frees the file.
static int count_and_free(kiln_result (*work)(const void *data), ki_writer *w)
{
    int asked = count_questions(&reports, work, w);
    ki_writer_free(w);
    return asked;
}

// Checks that one reading asks at least `more` times more than another.
static void check_more(const char *what, int asked, int less, int more)
{
    if (asked < less + more)
        fail_msg("%s: %d questions, and %d without", what, asked, less);
}

// ------------------------------------------------------------------------------------------- cubes

static kiln_map constant_cube(int size)
{
    kiln_map cube = make_map(context, KILN_SHAPE_CUBE, size, 1);
    fill_constant(&cube, 0.5F);
    return cube;
}

static kiln_result decode_galacean(const void *file)
{
    const ki_writer *w = file;
    kiln_map map;
    kiln_result result = ki_galacean_env_decode(own, w->bytes, w->size, &map, &error);
    assert_true(result == KILN_OK || !map.level[0]);
    kiln_map_free(&map);
    return result;
}

static kiln_result decode_gltf(const void *file)
{
    const ki_writer *w = file;
    kiln_map map;
    kiln_result result = ki_gltf_decode(own, w->bytes, w->size, "a", &map, &error);
    assert_true(result == KILN_OK || !map.level[0]);
    kiln_map_free(&map);
    return result;
}

static ki_writer galacean(int size)
{
    ki_writer w = {.context = context};
    kiln_sh sh = {.bands = 3};
    kiln_map cube = make_map(context, KILN_SHAPE_CUBE, size, 0);
    CHECK_OK(ki_galacean_env_encode(&cube, &sh, &w, &error));
    kiln_map_free(&cube);
    return w;
}

static ki_writer gltf(const char *intensity)
{
    static const char one[] = "\"intensity\":1,";
    ki_writer w = {.context = context};
    kiln_sh sh = {.bands = 3};
    kiln_map cube = make_map(context, KILN_SHAPE_CUBE, 128, 5);
    CHECK_OK(ki_gltf_encode(&cube, &sh, NULL, &w, &error));
    kiln_map_free(&cube);
    for (size_t i = 0; i + sizeof one < w.size; i++)
        if (!memcmp(w.bytes + i, one, sizeof one - 1)) {
            w.bytes[i + sizeof one - 3] = (uint8_t)*intensity;
            return w;
        }
    fail_msg("no intensity");
    return w;
}

// Texels are counted by 2^16, and so are their values and blocks of 16 texels.
static void texels_can_be_stopped(void **state)
{
    (void)state;
    begin();
    ki_writer small = galacean(64), large = galacean(256);
    check_more("galacean", count_and_free(decode_galacean, &large),
               count_and_free(decode_galacean, &small), 6 - 1 + 2 - 1);
    ki_writer plain = gltf("1"), bright = gltf("2");
    check_more("gltf", count_and_free(decode_gltf, &bright), count_and_free(decode_gltf, &plain),
               5 + 2 + 3);
    kiln_context_destroy(own);
}

static ki_writer cube_of_blocks(kiln_format format)
{
    ki_writer w = {.context = context};
    kiln_map cube = constant_cube(512);
    const kiln_save_def def = {.format = format};
    kiln_files files;
    CHECK_OK(kiln_map_encode(context, &cube, "a.ktx2", &def, &files, NULL, &error));
    ki_write(&w, files.file[0].bytes, files.file[0].size);
    kiln_files_free(&files);
    kiln_map_free(&cube);
    return w;
}

// The blocks of UASTC are checked before they are decoded, those of BC6H are not.
static void checks_of_blocks_can_be_stopped(void **state)
{
    (void)state;
    begin();
    ki_writer bc6h = cube_of_blocks(KILN_FORMAT_BC6H), uastc = cube_of_blocks(KILN_FORMAT_UASTC);
    check_more("blocks", count_long(decode, &uastc), count_long(decode, &bc6h), 2);
    ki_writer_free(&uastc);
    ki_writer_free(&bc6h);
    kiln_context_destroy(own);
}

static kiln_result load_faces(const void *paths)
{
    kiln_map map;
    kiln_result result = kiln_map_load_faces(own, paths, NULL, &map, &error);
    assert_true(result == KILN_OK || !map.level[0]);
    kiln_map_free(&map);
    return result;
}

static ki_writer grey_hdr(int width, int height)
{
    ki_writer w = {.context = context};
    ki_write_text(&w, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n", height, width);
    for (int i = 0; i < width * height; i++)
        ki_write(&w, "\x40\x80\xc0\x80", 4);
    return w;
}

// Faces are placed row by row, whether they come as six files or as a cross. Pictures as wide as a
// panorama, and not cut, have the questions of the reading itself.
static void faces_can_be_stopped(void **state)
{
    (void)state;
    enum { N = 32 };
    const char *paths[6];
    begin();
    folder_make();
    ki_writer face = grey_hdr(N, N), cross = grey_hdr(4 * N, 3 * N), whole = grey_hdr(4 * N, 2 * N);
    for (int i = 0; i < 6; i++) {
        char name[16];
        snprintf(name, sizeof name, "%s.hdr",
                 (const char *[]){"rt", "lf", "up", "dn", "ft", "bk"}[i]);
        paths[i] = in_folder(name);
        write_file(paths[i], face.bytes, face.size);
    }
    int panorama = count_and_free(decode, &whole);
    check_more("cross", count_and_free(decode, &cross), panorama, 6 * N);
    assert_true(count_questions(&reports, load_faces, paths) >= 6 * N);
    ki_writer_free(&face);
    folder_remove();
    kiln_context_destroy(own);
}

// ------------------------------------------------------------------------------------------ tables

static kiln_result load_image(const void *path)
{
    kiln_image image = {0};
    kiln_result result = kiln_image_load(own, path, &image, &error);
    assert_true(result == KILN_OK || !image.pixels);
    kiln_image_free(&image);
    return result;
}

static void save_table(const char *path, int height)
{
    kiln_table table;
    kiln_table_def def = {.kind = KILN_TABLE_DFG, .width = 8, .height = height};
    CHECK_OK(kiln_table_create(context, &def, &table, &error));
    CHECK_OK(kiln_table_save(context, &table, path, NULL, &error));
    kiln_table_free(&table);
}

static void tables_can_be_stopped(void **state)
{
    (void)state;
    begin();
    folder_make();
    save_table(in_folder("low.ktx2"), 8);
    save_table(in_folder("high.ktx2"), 64);
    check_more("table", count_questions(&reports, load_image, in_folder("high.ktx2")),
               count_questions(&reports, load_image, in_folder("low.ktx2")), 64 - 8);
    folder_remove();
    kiln_context_destroy(own);
}

// --------------------------------------------------------------------------------------------- EXR

static kiln_result decode_exr(const void *file)
{
    const ki_writer *w = file;
    kiln_image image = {0};
    assert_false(w->failed);
    kiln_result result =
        ki_exr_decode(own, w->bytes, w->size, "a", NULL, &image, NULL, NULL, &error);
    assert_true(result == KILN_OK || !image.pixels);
    kiln_image_free(&image);
    return result;
}

static float stripes(int x, int y, const char *channel)
{
    return (float)((x / 8 + y + *channel) % 8);
}

// 65536 tiles of 48 bytes, 64 for each of the tasks that decode them. What a tile costs by itself
// is counted, so that 32 tiles are a question.
static void small_tiles_can_be_stopped(void **state)
{
    (void)state;
    enum { TASKS = 1024 };
    static const exr_make_channel rgb[] = {{"B", EXR_PIXEL_HALF, 0, false},
                                           {"G", EXR_PIXEL_HALF, 0, false},
                                           {"R", EXR_PIXEL_HALF, 0, false}};
    exr_make make = {.width = 1024,
                     .height = 512,
                     .compression = EXR_COMPRESSION_ZIP,
                     .tile_width = 8,
                     .tile_height = 1,
                     .channels = rgb,
                     .channel_count = 3,
                     .value = stripes};
    ki_writer w = {.context = context};
    size_t size;
    uint8_t *bytes = exr_make_file(&make, &size);
    begin();
    ki_write(&w, bytes, size);
    free(bytes);
    assert_true(count_long(decode_exr, &w) >= 2 * TASKS);
    ki_writer_free(&w);
    kiln_context_destroy(own);
}

static ki_writer chroma_with_border(int border)
{
    plain_file file = {.width = 64,
                       .height = 64,
                       .display = {border, border, 63 - border, 63 - border},
                       .part_count = 1,
                       .parts = {{.channels = {"BY", "RY", "Y"}}},
                       .sampling = 2};
    ki_writer w = {.context = context};
    plain_write(&file, &w);
    return w;
}

// Colours that were made of luminance and chroma are copied to the display window row by row.
static void copies_can_be_stopped(void **state)
{
    (void)state;
    begin();
    ki_writer same = chroma_with_border(0), cut = chroma_with_border(2);
    check_more("copies", count_and_free(decode_exr, &cut), count_and_free(decode_exr, &same), 60);
    kiln_context_destroy(own);
}

// ------------------------------------------------------------------------------------------- bytes

static kiln_result load(const void *path)
{
    kiln_map map;
    kiln_result result = kiln_map_load(own, path, NULL, &map, &error);
    kiln_map_free(&map);
    return result;
}

// A file is read in parts of 2^24 bytes. Bytes after the lines of a picture in Radiance's format
// are of no use to it, but are read.
static void reading_can_be_stopped(void **state)
{
    (void)state;
    enum { MORE = 3 << 24 };
    begin();
    folder_make();
    ki_writer w = grey_hdr(16, 8);
    write_file(in_folder("a.hdr"), w.bytes, w.size);
    int less = count_questions(&reports, load, in_folder("a.hdr"));
    uint8_t *room = ki_write_room(&w, MORE);
    assert_non_null(room);
    memset(room, 0, MORE);
    write_file(in_folder("a.hdr"), w.bytes, w.size);
    check_more("bytes", count_questions(&reports, load, in_folder("a.hdr")), less, 3);
    ki_writer_free(&w);
    folder_remove();
    kiln_context_destroy(own);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(texels_can_be_stopped, set_up, tear_down),
        cmocka_unit_test_setup_teardown(checks_of_blocks_can_be_stopped, set_up, tear_down),
        cmocka_unit_test_setup_teardown(faces_can_be_stopped, set_up, tear_down),
        cmocka_unit_test_setup_teardown(tables_can_be_stopped, set_up, tear_down),
        cmocka_unit_test_setup_teardown(small_tiles_can_be_stopped, set_up, tear_down),
        cmocka_unit_test_setup_teardown(copies_can_be_stopped, set_up, tear_down),
        cmocka_unit_test_setup_teardown(reading_can_be_stopped, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

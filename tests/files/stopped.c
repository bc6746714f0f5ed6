// The reading of a picture can be stopped while its data are decompressed, its colours converted
// and its faces turned. The tests count how often a reading asks whether to go on. A picture of 64
// rows whose colours are converted asks at least 64 times more than the same picture without the
// conversion; texels of cubes are converted and turned in strips of 64 rows.
#include "codec/codec.h"
#include "codec/deflate.h"
#include "image/pack.h"
#include "kit/context.h"
#include "kit/folder.h"
#include "kit/stopping.h"

#include "exr_make.h"
#include "exr_plain.h"

#include <pthread.h>

enum { WIDTH = 128, HEIGHT = 64, PNG_HEAD = 8 + 25 };

static const float acescg[8] = {0.713F, 0.293F, 0.165F, 0.830F, 0.128F, 0.044F, 0.32168F, 0.33767F};

static void put_exr(ki_writer *w, const float *chromaticities, int envmap, bool chroma)
{
    plain_file file = {.width = WIDTH,
                       .height = HEIGHT,
                       .part_count = 1,
                       .parts = {{.channels = {"B", "G", "R"}}},
                       .chromaticities = chromaticities,
                       .envmap = envmap};
    if (chroma) {
        file.parts[0] = (plain_part){.channels = {"BY", "RY", "Y"}};
        file.sampling = 2;
    }
    plain_write(&file, w);
}

static void put_large_exr(ki_writer *w, float (*value)(int part, const char *channel, int x, int y))
{
    plain_file file = {.width = 512,
                       .height = 256,
                       .part_count = 1,
                       .parts = {{.channels = {"B", "G", "R"}}},
                       .value = value};
    plain_write(&file, w);
}

static float board(int part, const char *channel, int x, int y)
{
    (void)part, (void)channel;
    return (x + y) % 2 ? NAN : 1;
}

static void put_whole_exr(ki_writer *w)
{
    put_large_exr(w, NULL);
}

// Half of the texels are no number, and all of these are neighbours of known ones.
static void put_holes_exr(ki_writer *w)
{
    put_large_exr(w, board);
}

static void put_plain_exr(ki_writer *w)
{
    put_exr(w, NULL, 0, false);
}

static void put_acescg(ki_writer *w)
{
    put_exr(w, acescg, 0, false);
}

static void put_chroma(ki_writer *w)
{
    put_exr(w, NULL, 0, true);
}

static void put_envmap(ki_writer *w)
{
    put_exr(w, NULL, 1, false);
}

static void put_hdr_with(ki_writer *w, const char *line)
{
    ki_write_text(w, "#?RADIANCE\n%sFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n", line, HEIGHT, WIDTH);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        ki_write(w, "\x40\x80\xc0\x80", 4);
}

static void put_hdr(ki_writer *w)
{
    put_hdr_with(w, "");
}

static void put_wide_hdr(ki_writer *w)
{
    put_hdr_with(w, "PRIMARIES=0.708 0.292 0.170 0.797 0.131 0.046 0.3127 0.3290\n");
}

// A file whose lines do not end where it ends, so that they are looked for by the second rule too,
// and then by the first rule again.
static void put_long_hdr(ki_writer *w)
{
    put_hdr(w);
    ki_write(w, "more", 4);
}

static void put_u32(uint8_t *to, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(value >> (24 - 8 * i));
}

// Writes a picture whose chunk cICP says primaries and transfer function.
static void put_png_with(ki_writer *w, uint8_t primaries, uint8_t transfer)
{
    static float pixels[3 * WIDTH * HEIGHT];
    const uint8_t cicp[4] = {primaries, transfer, 0, 1};
    ki_crc32_table table;
    uint8_t chunk[16] = {0};
    ki_writer whole = {.context = context};
    for (size_t i = 0; i < sizeof pixels / sizeof *pixels; i++)
        pixels[i] = (float)(i % 256) / 255;
    CHECK_OK(ki_png_encode(pixels, WIDTH, HEIGHT, 3, KI_PNG_PLAIN8, &whole, &error));
    put_u32(chunk, 4);
    memcpy(chunk + 4, "cICP", 4);
    memcpy(chunk + 8, cicp, 4);
    ki_crc32_fill(&table);
    put_u32(chunk + 12, ki_crc32(&table, 0, chunk + 4, 8));
    ki_write(w, whole.bytes, PNG_HEAD);
    ki_write(w, chunk, sizeof chunk);
    ki_write(w, whole.bytes + PNG_HEAD, whole.size - PNG_HEAD);
    ki_writer_free(&whole);
}

static void put_png(ki_writer *w)
{
    put_png_with(w, 1, 13);
}

static void put_wide_png(ki_writer *w)
{
    put_png_with(w, 9, 13);
}

static void put_hlg_png(ki_writer *w)
{
    put_png_with(w, 9, 18);
}

static void put_cube(ki_writer *w, int size, kiln_format format, int zstd)
{
    kiln_map cube = make_map(context, KILN_SHAPE_CUBE, size, 1);
    const kiln_save_def def = {.format = format, .zstd = zstd};
    kiln_files files;
    fill_constant(&cube, 1);
    CHECK_OK(kiln_map_encode(context, &cube, "a.ktx2", &def, &files, NULL, &error));
    ki_write(w, files.file[0].bytes, files.file[0].size);
    kiln_files_free(&files);
    kiln_map_free(&cube);
}

// The texels of a face are unpacked in strips of 64 rows: one strip for a cube of 64, four for a
// cube of 256.
static void put_small_cube(ki_writer *w)
{
    put_cube(w, 64, KILN_FORMAT_B10G11R11, 0);
}

static void put_large_cube(ki_writer *w)
{
    put_cube(w, 256, KILN_FORMAT_B10G11R11, 0);
}

static void put_cube_of_128(ki_writer *w)
{
    put_cube(w, 128, KILN_FORMAT_B10G11R11, 0);
}

// Cubes whose faces must be turned: rows from the bottom and columns from the right.
static void put_turned_cube(ki_writer *w)
{
    static const char key[] = "KTXorientation";
    put_cube_of_128(w);
    for (size_t i = 0; i + sizeof key + 2 < w->size; i++)
        if (!memcmp(w->bytes + i, key, sizeof key)) {
            memcpy(w->bytes + i + sizeof key, "lu", 2);
            return;
        }
    fail_msg("no orientation");
}

// KTX 1 of 8 bits sRGB, as its specification gives the header.
static void put_ktx1_with(ki_writer *w, const char *orientation)
{
    static const uint32_t head[] = {0x04030201, 0x1401, 1, 0x1908, 0x8c43, 0x1908, 128,
                                    128,        0,      0, 6,      1,      32};
    ki_write(w, "\xabKTX 11\xbb\r\n\x1a\n", 12);
    for (size_t i = 0; i < sizeof head / sizeof *head; i++)
        ki_write_u32(w, head[i]);
    ki_write_u32(w, 27);
    ki_write(w, "KTXorientation", 15);
    ki_write(w, orientation, 12);
    ki_write_u8(w, 0);
    ki_write_u32(w, 128 * 128 * 4);
    uint8_t *texels = ki_write_room(w, 6 * 128 * 128 * 4);
    assert_non_null(texels);
    memset(texels, 50, 6 * 128 * 128 * 4);
}

static void put_ktx1(ki_writer *w)
{
    put_ktx1_with(w, "S=r,T=d\0\0\0\0");
}

static void put_turned_ktx1(ki_writer *w)
{
    put_ktx1_with(w, "S=l,T=u\0\0\0\0");
}

// A cube whose level has 12.6 million bytes.
static void put_halfs(ki_writer *w)
{
    put_cube(w, 512, KILN_FORMAT_RGBA16F, 0);
}

static void put_zstd_halfs(ki_writer *w)
{
    put_cube(w, 512, KILN_FORMAT_RGBA16F, KILN_TEST_ZSTD);
}

static const struct {
    void (*plain)(ki_writer *w), (*converted)(ki_writer *w);
    int more; // least number of further questions
} cases[] = {
    {put_plain_exr, put_acescg, HEIGHT},
    {put_plain_exr, put_chroma, HEIGHT / 2 + HEIGHT}, // pairs of lines, then strips
    {put_plain_exr, put_envmap, HEIGHT},
    // Of 2^17 texels and 2^16 holes: the texels are looked at twice, and so are the holes.
    {put_whole_exr, put_holes_exr, 2 + 2 + 1 + 1},
    {put_hdr, put_wide_hdr, HEIGHT},
    {put_hdr, put_long_hdr, 1},
    {put_png, put_wide_png, HEIGHT},
    {put_png, put_hlg_png, 2 * HEIGHT}, // the system gamma, then the primaries
    {put_small_cube, put_large_cube, 6 * 3},
    {put_cube_of_128, put_turned_cube, 6 * (2 + 1)}, // columns, then rows, in strips of 64 rows
    {put_ktx1, put_turned_ktx1, 6 * (2 + 1)},
    {put_halfs, put_zstd_halfs, 3 * KILN_TEST_ZSTD},
};

static countdown reports;
static kiln_context *own;

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

// Decodes the pixels of an EXR file, without what makes a map of them.
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

static int count_questions_of(void (*put)(ki_writer *w))
{
    ki_writer w = {.context = context};
    put(&w);
    int asked = count_questions(&reports, decode, &w);
    ki_writer_free(&w);
    return asked;
}

static void conversions_can_be_stopped(void **state)
{
    (void)state;
    kiln_context_def def = {.thread_count = 1, .progress = count_down, .progress_user = &reports};
    CHECK_OK(kiln_context_create(&def, &own, &error));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        int plain = count_questions_of(cases[i].plain);
        int all = count_questions_of(cases[i].converted);
        if (all < plain + cases[i].more)
            fail_msg("case %zu: %d questions, and %d without the conversion", i, all, plain);
    }
    kiln_context_destroy(own);
}

enum { TILE_WIDTH = 2048, TILE_HEIGHT = 1024, TILE_BYTES = 6 * TILE_WIDTH * TILE_HEIGHT };

static float sawtooth(int x, int y, const char *channel)
{
    return (float)((5 * x + 3 * y + *channel) % 64) / 64;
}

// Writes zlib data of the two bytes of `pair`, repeated `count` times, with `first` in place of the
// very first byte.
static void put_zlib(ki_writer *w, size_t count, int first, const uint8_t pair[2])
{
    ki_deflater *deflater = ki_deflater_create(context);
    uint8_t *plain = malloc(2 * count), *packed = malloc(ki_deflate_bound(2 * count));
    assert_true(deflater && plain && packed);
    for (size_t i = 0; i < 2 * count; i++)
        plain[i] = i ? pair[i % 2] : (uint8_t)first;
    ki_write(w, packed,
             ki_deflate(deflater, plain, 2 * count, packed, ki_deflate_bound(2 * count)));
    free(plain);
    free(packed);
    ki_deflater_free(deflater);
}

// Copies a file of one uncompressed tile, and replaces the tile by black pixels that are compressed
// by DWAA, which OpenEXRCore 3.1 cannot write. Each block of 8 x 8 pixels has the mean 0 and no
// further coefficient.
static void put_black_dwaa(ki_writer *w, const uint8_t *bytes, size_t size)
{
    enum { BLOCKS = 3 * (TILE_WIDTH / 8) * (TILE_HEIGHT / 8), TILE_HEAD = 20 };
    static const char name[] = "compression\0compression\0\1\0\0";
    const uint8_t differences[2] = {128, 128}, ends[2] = {0, 0xff};
    ki_writer means = {.context = context}, rest = {.context = context};
    put_zlib(&means, BLOCKS, 0, differences);
    put_zlib(&rest, BLOCKS, 0, ends);
    size_t before = size - TILE_BYTES - TILE_HEAD, at = 0;
    while (memcmp(bytes + at, name, sizeof name) != 0)
        at++;
    ki_write(w, bytes, before + TILE_HEAD - 4);
    w->bytes[at + sizeof name] = EXR_COMPRESSION_DWAA;
    ki_write_u32(w, (uint32_t)(11 * 8 + rest.size + means.size));
    // version, zlib, packed; ac, dc, runs packed; runs, unpacked; ac, dc; 1: ac by zlib
    const uint64_t counts[11] = {1, 0, 0, rest.size, means.size, 0, 0, 0, BLOCKS, BLOCKS, 1};
    for (int i = 0; i < 11; i++)
        ki_write_u64(w, counts[i]);
    ki_write(w, rest.bytes, rest.size);
    ki_write(w, means.bytes, means.size);
    ki_writer_free(&means);
    ki_writer_free(&rest);
}

// Makes a picture of TILE_HEIGHT rows, in tiles of its width and `rows` rows.
static void put_tile(ki_writer *w, int width, int rows, exr_compression_t compression)
{
    static const exr_make_channel rgb[] = {{"B", EXR_PIXEL_HALF, 0, false},
                                           {"G", EXR_PIXEL_HALF, 0, false},
                                           {"R", EXR_PIXEL_HALF, 0, false}};
    bool dwa = compression == EXR_COMPRESSION_DWAA;
    exr_make make = {.width = width,
                     .height = TILE_HEIGHT,
                     .compression = dwa ? EXR_COMPRESSION_NONE : compression,
                     .tile_width = width,
                     .tile_height = rows,
                     .channels = rgb,
                     .channel_count = 3,
                     .value = sawtooth};
    size_t size;
    uint8_t *bytes = exr_make_file(&make, &size);
    if (dwa)
        put_black_dwaa(w, bytes, size);
    else
        ki_write(w, bytes, size);
    free(bytes);
}

// A picture of 12.6 million bytes in one tile, by each method of compression. A step that writes as
// many bytes asks after each 2^22 of them, or a row later: 2.5 times or more, as a mean of steps.
// The questions of a small picture are those outside of these steps.
static void large_tiles_can_be_stopped(void **state)
{
    (void)state;
    enum { SMALL = 64 };
    static const struct {
        exr_compression_t compression;
        int steps; // 2 of them are the conversion to floats, which are twice as many bytes
    } methods[] = {
        {EXR_COMPRESSION_NONE, 2},     {EXR_COMPRESSION_RLE, 3 + 2},   {EXR_COMPRESSION_ZIP, 2 + 2},
        {EXR_COMPRESSION_PIZ, 4 + 2},  {EXR_COMPRESSION_PXR24, 1 + 2}, {EXR_COMPRESSION_B44, 2 + 2},
        {EXR_COMPRESSION_DWAA, 1 + 2},
    };
    kiln_context_def def = {.thread_count = 1, .progress = count_down, .progress_user = &reports};
    CHECK_OK(kiln_context_create(&def, &own, &error));
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        int asked[2];
        for (int large = 0; large < 2; large++) {
            ki_writer w = {.context = context};
            put_tile(&w, large ? TILE_WIDTH : SMALL, TILE_HEIGHT,
                     large ? methods[i].compression : EXR_COMPRESSION_NONE);
            asked[large] = count_questions(&reports, decode_exr, &w);
            ki_writer_free(&w);
        }
        if (2 * (asked[1] - asked[0]) < 5 * methods[i].steps)
            fail_msg("compression %d: %d questions, and %d of a small picture",
                     (int)methods[i].compression, asked[1], asked[0]);
    }
    kiln_context_destroy(own);
}

// Work that is told once to stop, on the thread that called the library.
typedef struct watched {
    single_stop once;
    pthread_t caller;
} watched;

static bool stop_on_caller(void *user, const char *stage, double fraction)
{
    watched *o = user;
    assert_true(pthread_equal(o->caller, pthread_self()));
    return stop_once(&o->once, stage, fraction);
}

// Does work again and again, and stops it once: at its first question, at its second, and so on,
// by after_stop. Returns the number of questions of the whole work.
static int stop_at_each(watched *o, kiln_result (*work)(const void *data), const void *data)
{
    *o = (watched){.caller = pthread_self()};
    CHECK_OK(work(data));
    int asked = o->once.calls;
    for (int at = 1; at <= asked; at = after_stop(at)) {
        *o = (watched){.once.stop_at = at, .caller = pthread_self()};
        kiln_result result = work(data);
        // busy machines may make the work ask more often one time than the next
        if (o->once.calls < at)
            CHECK_OK(result);
        else
            assert_int_equal(result, KILN_ERROR_CANCELLED);
    }
    return asked;
}

// Two threads decode two large tiles. Only the thread that called the library asks, and the other
// learns the answer.
static void a_stop_reaches_other_threads(void **state)
{
    (void)state;
    watched o;
    ki_writer w = {.context = context};
    kiln_context_def def = {.thread_count = 2, .progress = stop_on_caller, .progress_user = &o};
    put_tile(&w, TILE_WIDTH, TILE_HEIGHT / 2, EXR_COMPRESSION_ZIP);
    assert_false(w.failed);
    CHECK_OK(kiln_context_create(&def, &own, &error));
    assert_true(stop_at_each(&o, decode_exr, &w) >= 2);
    kiln_context_destroy(own);
    ki_writer_free(&w);
}

static kiln_result bake_file(const void *path)
{
    kiln_environment environment;
    const kiln_bake_def def = {.levels = {.size = 8, .level_count = 1}};
    kiln_result result = kiln_bake_file(own, path, NULL, &def, NULL, &environment, &error);
    kiln_environment_free(&environment);
    return result;
}

// A file with texels that are no number is baked by rows first, and then as a whole. A stop of the
// first bake does not begin the second.
static void a_stopped_bake_does_not_begin_again(void **state)
{
    (void)state;
    watched o;
    ki_writer w = {.context = context};
    kiln_context_def def = {.thread_count = 1, .progress = stop_on_caller, .progress_user = &o};
    put_holes_exr(&w);
    assert_false(w.failed);
    folder_make();
    write_file(in_folder("holes.exr"), w.bytes, w.size);
    CHECK_OK(kiln_context_create(&def, &own, &error));
    assert_true(stop_at_each(&o, bake_file, in_folder("holes.exr")) >= 10);
    folder_remove();
    kiln_context_destroy(own);
    ki_writer_free(&w);
}

// Writes a chunk of a PNG file.
static void put_chunk(ki_writer *w, const char *type, const uint8_t *data, uint32_t size)
{
    ki_crc32_table table;
    uint8_t number[4];
    size_t start = w->size + 4;
    put_u32(number, size);
    ki_write(w, number, 4);
    ki_write(w, type, 4);
    ki_write(w, data, size);
    ki_crc32_fill(&table);
    put_u32(number, ki_crc32(&table, 0, w->bytes + start, size + 4));
    ki_write(w, number, 4);
}

// A PNG of 82 million bytes, the last of which are missing: if inflating could not be stopped, each
// of these readings would end with that damage. The block of deflate has fixed codes: a literal 0,
// then matches of 258 bytes at distance 1, of 13 bits each. After the block's 3 bits and the
// literal's 8 the next 8 * 13 bits repeat.
static void inflating_can_be_stopped(void **state)
{
    (void)state;
    enum { COLUMNS = 32768, ROWS = 20000, PACKED = (COLUMNS / 8 + 1) / 258 * ROWS / 8 * 13 };
    static const char match[] = "1100010100000", first[] = "11000110000";
    static uint8_t packed[PACKED] = {0x78, 0x01};
    for (size_t bit = 0; bit < 8 * (PACKED - 2); bit++) {
        char c = bit < sizeof first - 1 ? first[bit] : match[(bit - (sizeof first - 1)) % 13];
        packed[2 + bit / 8] |= (uint8_t)((c == '1') << bit % 8);
    }
    uint8_t head[13] = {0, 0, COLUMNS >> 8, 0, 0, 0, ROWS >> 8, ROWS & 255, 1};
    kiln_context_def def = {.thread_count = 1, .progress = count_down, .progress_user = &reports};
    ki_writer w = {.context = context};
    ki_write(&w, "\x89PNG\r\n\x1a\n", 8);
    put_chunk(&w, "IHDR", head, sizeof head);
    put_chunk(&w, "IDAT", packed, sizeof packed);
    put_chunk(&w, "IEND", NULL, 0);
    CHECK_OK(kiln_context_create(&def, &own, &error));
    reports = (countdown){.left = 1 << 30};
    assert_int_equal(decode(&w), KILN_ERROR_FORMAT);
    CHECK_SAYS(error.message, "does not inflate to the picture's size");
    int asked = reports.calls;
    assert_true(asked >= 4); // a question after each 2^24 of the 82 million bytes
    for (int stop = 0; stop < asked; stop++) {
        reports = (countdown){.left = stop};
        assert_int_equal(decode(&w), KILN_ERROR_CANCELLED);
        assert_int_equal(reports.calls, stop + 1);
    }
    kiln_context_destroy(own);
    ki_writer_free(&w);
}

// A grey PNG of 4 x 2 pixels with `more` bytes in a chunk that kiln does not know, and `blocks`
// stored blocks without content before the pixels.
static void put_long_png(ki_writer *w, size_t more, size_t blocks)
{
    enum { STORED = 5, ROWS = 10 };
    static const uint8_t head[13] = {0, 0, 0, 4, 0, 0, 0, 2, 8};
    static const uint8_t last[5] = {1, ROWS, 0, 0xff - ROWS, 0xff};
    size_t size = 2 + STORED * blocks + sizeof last + ROWS + 4;
    uint8_t *unknown = calloc(more + 1, 1), *packed = calloc(size, 1), *at = packed + 2;
    assert_true(unknown && packed);
    memcpy(packed, "\x78\x01", 2);
    for (size_t i = 0; i < blocks; i++, at += STORED)
        memset(at + 3, 0xff, 2);
    memcpy(at, last, sizeof last);
    at += sizeof last + ROWS;
    put_u32(at, ki_adler32(1, at - ROWS, ROWS));
    ki_write(w, "\x89PNG\r\n\x1a\n", 8);
    put_chunk(w, "IHDR", head, sizeof head);
    put_chunk(w, "kiLn", unknown, (uint32_t)more);
    put_chunk(w, "IDAT", packed, (uint32_t)size);
    put_chunk(w, "IEND", NULL, 0);
    free(unknown);
    free(packed);
}

// Checksums of chunks are computed in parts of 2^24 bytes; the caller is asked between blocks of
// deflate too, which may have no content.
static void long_chunks_can_be_stopped(void **state)
{
    (void)state;
    static const size_t sizes[3][2] = {{0, 0}, {(3 << 24) + 1, 0}, {0, 1 << 20}};
    kiln_context_def def = {.thread_count = 1, .progress = count_down, .progress_user = &reports};
    CHECK_OK(kiln_context_create(&def, &own, &error));
    int asked[3];
    for (int i = 0; i < 3; i++) {
        ki_writer w = {.context = context};
        put_long_png(&w, sizes[i][0], sizes[i][1]);
        asked[i] = count_questions(&reports, decode, &w);
        ki_writer_free(&w);
    }
    assert_true(asked[1] >= asked[0] + 3);
    assert_true(asked[2] >= asked[0] + 10);
    kiln_context_destroy(own);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(conversions_can_be_stopped, set_up, tear_down),
        cmocka_unit_test_setup_teardown(large_tiles_can_be_stopped, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_stop_reaches_other_threads, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_stopped_bake_does_not_begin_again, set_up, tear_down),
        cmocka_unit_test_setup_teardown(inflating_can_be_stopped, set_up, tear_down),
        cmocka_unit_test_setup_teardown(long_chunks_can_be_stopped, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

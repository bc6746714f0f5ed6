// Cubes and pictures in KTX2, DDS and KTX 1 files as other programs write them: each file is put
// together here, byte by byte from the specifications, and each texel that is read has the value
// that was written.
#include "codec/codec.h"
#include "codec/deflate.h"

#include "kit/context.h"

enum { N = 5 }; // size of the faces: rows of three bytes a texel then need padding in KTX 1

typedef enum container { KTX2, DDS, KTX1 } container;
typedef enum channel { BYTE, SHORT, HALF, FLOAT } channel;

typedef struct sample_file {
    container container;
    channel channel;
    int channels;
    bool blue_first, srgb;
    uint32_t number; // vkFormat, DXGI format, or glInternalFormat; 0 for the older header of DDS
    int faces, levels;
    const char *orientation;
    uint32_t scheme;  // supercompression of KTX2: 0 or 3
    const char *said; // in the first note; NULL for no note
} sample_file;

// Value i of a file, as its channel stores the value. The floats are exact halves, some negative.
static uint32_t stored(const sample_file *f, size_t i)
{
    uint32_t step = (uint32_t)(i * 37 + 11);
    return f->channel == BYTE ? step % 256 : f->channel == SHORT ? step * 97 % 65536 : step % 2048;
}

static double value_of(const sample_file *f, uint32_t bits)
{
    double v = f->channel == BYTE ? bits / 255.0 : bits / 65535.0;
    if (f->channel >= HALF)
        return (double)bits / 8 - 16;
    return f->srgb ? v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4) : v;
}

static void put_channel(ki_writer *w, const sample_file *f, uint32_t bits)
{
    float value = (float)value_of(f, bits);
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    // A half from a float whose value a half holds: sign, exponent less 112, and ten bits.
    uint32_t half =
        word & 0x7fffffff ? (word >> 16 & 0x8000) | ((word >> 13 & 0x3ffff) - (112 << 10)) : 0;
    if (f->channel == BYTE)
        ki_write_u8(w, (uint8_t)bits);
    else if (f->channel == FLOAT)
        ki_write_u32(w, word);
    else
        ki_write_u16(w, (uint16_t)(f->channel == HALF ? half : bits));
}

// Number of the channel of texel t at position c of its bytes, in the order red, green, blue of all
// texels.
static size_t index_of(const sample_file *f, size_t t, int c)
{
    return 3 * t + (size_t)(f->blue_first ? 2 - c : c);
}

static void put_face(ki_writer *w, const sample_file *f, int face, int level)
{
    int n = N >> level;
    size_t first = 1000 * (size_t)level + (size_t)face * (size_t)n * (size_t)n;
    for (int y = 0; y < n; y++) {
        for (int x = 0; x < n; x++)
            for (int c = 0; c < f->channels; c++)
                put_channel(w, f,
                            c == 3 ? 7 : stored(f, index_of(f, first + (size_t)(y * n + x), c)));
        if (f->container == KTX1)
            ki_write_align(w, 4);
    }
}

static void put_words(ki_writer *w, const uint32_t *words, int count)
{
    for (int i = 0; i < count; i++)
        ki_write_u32(w, words[i]);
}

static void put_pair(ki_writer *w, const char *key, const char *value)
{
    ki_write_u32(w, (uint32_t)(strlen(key) + strlen(value) + 2));
    ki_write(w, key, strlen(key) + 1);
    ki_write(w, value, strlen(value) + 1);
    ki_write_align(w, 4);
}

static void write_dds(ki_writer *w, const sample_file *f)
{
    bool ten = f->number != 0, cube = f->faces == 6;
    uint32_t red = f->blue_first ? 0xff0000 : 0xff, blue = f->blue_first ? 0xff : 0xff0000;
    uint32_t bits = (uint32_t)(8 * f->channels);
    const uint32_t header[31] = {124,
                                 0x1007,
                                 N,
                                 N,
                                 0,
                                 0,
                                 (uint32_t)f->levels,
                                 [18] = 32,
                                 ten ? 4 : 0x40,
                                 ten ? 0x30315844 : 0,
                                 bits,
                                 red,
                                 0xff00,
                                 blue,
                                 0,
                                 0x1000,
                                 cube ? 0xfe00 : 0};
    ki_write(w, "DDS ", 4);
    put_words(w, header, 31);
    if (ten)
        put_words(w, (const uint32_t[]){f->number, 3, cube ? 4 : 0, 1, 0}, 5);
    for (int face = 0; face < f->faces; face++)
        for (int k = 0; k < f->levels; k++)
            put_face(w, f, face, k);
}

static void write_ktx1(ki_writer *w, const sample_file *f)
{
    static const uint32_t types[] = {0x1401, 0x1403, 0x140b, 0x1406};
    uint32_t format = f->channels == 4 ? f->blue_first ? 0x80e1 : 0x1908
                      : f->blue_first  ? 0x80e0
                                       : 0x1907;
    ki_write(w, "\xabKTX 11\xbb\r\n\x1a\n", 12);
    put_words(w,
              (const uint32_t[]){0x04030201, types[f->channel], 1, format, f->number, format, N, N,
                                 0, 0, (uint32_t)f->faces, (uint32_t)f->levels},
              12);
    size_t place = w->size;
    ki_write_u32(w, 0);
    if (f->orientation)
        put_pair(w, "KTXorientation", f->orientation);
    ki_patch_u32(w, place, (uint32_t)(w->size - place - 4));
    for (int k = 0; k < f->levels; k++) {
        place = w->size;
        ki_write_u32(w, 0);
        for (int face = 0; face < f->faces; face++)
            put_face(w, f, face, k);
        ki_patch_u32(w, place, (uint32_t)((w->size - place - 4) / (size_t)f->faces));
    }
}

static void write_level(ki_writer *w, const sample_file *f, int level, size_t entry)
{
    ki_writer plain = {.context = context};
    for (int face = 0; face < f->faces; face++)
        put_face(&plain, f, face, level);
    ki_patch_u64(w, entry, w->size);
    ki_patch_u64(w, entry + 16, plain.size);
    size_t size = plain.size, bound = ki_deflate_bound(plain.size);
    if (f->scheme == 3) {
        uint8_t *packed = malloc(bound);
        ki_deflater *deflater = ki_deflater_create(context);
        size = ki_deflate(deflater, plain.bytes, plain.size, packed, bound);
        ki_write(w, packed, size);
        ki_deflater_free(deflater);
        free(packed);
    } else {
        ki_write(w, plain.bytes, size);
    }
    ki_patch_u64(w, entry + 8, size);
    ki_writer_free(&plain);
}

static void write_ktx2(ki_writer *w, const sample_file *f)
{
    ki_write(w, "\xabKTX 20\xbb\r\n\x1a\n", 12);
    put_words(w,
              (const uint32_t[]){f->number, 1, N, N, 0, 0, (uint32_t)f->faces, (uint32_t)f->levels,
                                 f->scheme},
              9);
    size_t index = w->size;
    for (int i = 0; i < 8 + 6 * f->levels; i++)
        ki_write_u32(w, 0);
    // The basic descriptor block without samples: model 1, primaries 1 (BT.709), and the transfer
    // function.
    ki_patch_u32(w, index, (uint32_t)w->size);
    ki_patch_u32(w, index + 4, 28);
    put_words(
        w, (const uint32_t[]){28, 0, 2 | 24 << 16, 1 | 1 << 8 | (f->srgb ? 2u : 1u) << 16, 0, 0, 0},
        7);
    ki_patch_u32(w, index + 8, (uint32_t)w->size);
    size_t metadata = w->size;
    if (f->orientation)
        put_pair(w, "KTXorientation", f->orientation);
    ki_patch_u32(w, index + 12, (uint32_t)(w->size - metadata));
    for (int k = f->levels - 1; k >= 0; k--)
        write_level(w, f, k, index + 32 + 24 * (size_t)k);
}

static void check_file(const sample_file *f)
{
    ki_writer w = {.context = context};
    void (*const writers[])(ki_writer *, const sample_file *) = {write_ktx2, write_dds, write_ktx1};
    writers[f->container](&w, f);
    ki_decoded decoded;
    kiln_file_info info;
    kiln_result result = ki_decode(context, w.bytes, w.size, "made", &decoded, &info, &error);
    if (result != KILN_OK)
        fail_msg("container %d, format %u: %s", (int)f->container, f->number, error.message);
    assert_int_equal(decoded.is_map, f->faces == 6);
    assert_int_equal(info.level_count, f->levels);
    assert_int_equal(info.channel_count, f->channels);
    const float *rgb = decoded.is_map ? decoded.map.level[0] : decoded.image.pixels;
    bool up = f->orientation && strchr(f->orientation, 'u'),
         left = f->orientation && strchr(f->orientation, 'l');
    for (size_t t = 0; t < (size_t)f->faces * N * N; t++)
        for (size_t c = 0; c < 3; c++) {
            size_t face = t / (N * N), y = t / N % N, x = t % N;
            size_t from = face * N * N + (up ? N - 1 - y : y) * N + (left ? N - 1 - x : x);
            CHECK_NEAR((double)rgb[3 * t + c], value_of(f, stored(f, 3 * from + c)), 1e-6);
        }
    assert_int_equal(decoded.report.note_count, f->said != NULL);
    if (f->said)
        CHECK_SAYS(decoded.report.note[0].text, f->said);
    ki_decoded_free(&decoded);
    ki_writer_free(&w);
}

static const char *const linear = "values of 8 bits are taken as linear";
static const char *const assumed =
    "values of 8 bits are taken as sRGB, since the file does not say";
static const char *const levels = "level 0 of 2 levels is the environment";
static const char *const turned = "was turned to rows from the top";

static void every_format_is_read(void **state)
{
    (void)state;
    const sample_file files[] = {
        {KTX2, BYTE, 3, false, false, 23, 6, 1, NULL, 0, linear},
        {KTX2, BYTE, 3, false, true, 29, 6, 1, "rd", 0, NULL},
        {KTX2, BYTE, 3, true, true, 36, 6, 2, "rd", 0, levels},
        {KTX2, BYTE, 4, false, true, 37, 6, 1, NULL, 0, NULL}, // by the transfer function
        {KTX2, BYTE, 4, false, true, 43, 1, 1, NULL, 3, NULL},
        {KTX2, BYTE, 4, true, false, 44, 6, 1, NULL, 0, linear},
        {KTX2, BYTE, 4, true, true, 50, 6, 1, "ru", 0, turned},
        {KTX2, SHORT, 3, false, false, 84, 6, 1, NULL, 0, NULL},
        {KTX2, SHORT, 4, false, false, 91, 6, 1, NULL, 0, NULL},
        {KTX2, HALF, 3, false, false, 90, 6, 2, NULL, 3, levels},
        {KTX2, HALF, 4, false, false, 97, 1, 1, "lu", 0, turned},
        {KTX2, FLOAT, 3, false, false, 106, 6, 1, NULL, 3, NULL},
        {KTX2, FLOAT, 4, false, false, 109, 6, 1, NULL, 0, NULL},
        {DDS, BYTE, 3, true, true, 0, 6, 1, NULL, 0, assumed},
        {DDS, BYTE, 3, false, true, 0, 1, 1, NULL, 0, assumed},
        {DDS, BYTE, 4, true, true, 0, 6, 1, NULL, 0, assumed},
        {DDS, BYTE, 4, false, false, 28, 6, 1, NULL, 0, linear},
        {DDS, BYTE, 4, false, true, 29, 6, 2, NULL, 0, levels},
        {DDS, BYTE, 4, true, true, 91, 6, 1, NULL, 0, NULL},
        {DDS, BYTE, 4, true, true, 93, 1, 2, NULL, 0, levels},
        {DDS, SHORT, 4, false, false, 11, 6, 1, NULL, 0, NULL},
        {DDS, HALF, 4, false, false, 10, 6, 2, NULL, 0, levels},
        {DDS, FLOAT, 3, false, false, 6, 6, 1, NULL, 0, NULL},
        {DDS, FLOAT, 4, false, false, 2, 1, 1, NULL, 0, NULL},
        {KTX1, BYTE, 3, false, true, 0x8c41, 6, 1, NULL, 0, NULL},
        {KTX1, BYTE, 4, true, true, 0x8c43, 6, 2, NULL, 0, levels},
        {KTX1, BYTE, 3, false, false, 0x8051, 1, 1, NULL, 0, linear},
        {KTX1, SHORT, 4, false, false, 0x805b, 6, 1, NULL, 0, NULL},
        {KTX1, HALF, 3, false, false, 0x881b, 6, 2, NULL, 0, levels},
        {KTX1, HALF, 4, false, false, 0x881a, 6, 1, "S=r,T=u", 0, turned},
        {KTX1, FLOAT, 3, false, false, 0x8815, 1, 1, "S=r,T=d", 0, NULL},
        {KTX1, FLOAT, 4, false, false, 0x8814, 6, 1, NULL, 0, NULL},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        check_file(&files[i]);
}

// A 2-D texture of two to one is a panorama, and a cut one is refused before its memory is
// allocated.
static void a_flat_texture_is_a_panorama(void **state)
{
    (void)state;
    const uint32_t header[31] = {124, 0x1007, 2, 4, 0, 0, 0, [18] = 32, 4, 116, [26] = 0x1000};
    ki_writer w = {.context = context};
    ki_write(&w, "DDS ", 4);
    put_words(&w, header, 31);
    for (int i = 0; i < 32; i++)
        ki_write(&w, &(float){(float)i}, 4);
    kiln_map map;
    CHECK_OK(kiln_map_decode(context, w.bytes, w.size, "flat", NULL, &map, &error));
    assert_int_equal(map.shape, KILN_SHAPE_PANORAMA);
    assert_int_equal(map.size, 2);
    for (int i = 0; i < 8; i++)
        for (int c = 0; c < 3; c++)
            CHECK_NEAR((double)map.level[0][3 * i + c], 4 * i + c, 0);
    kiln_map_free(&map);
    assert_int_equal(kiln_map_decode(context, w.bytes, w.size - 1, "flat", NULL, &map, &error),
                     KILN_ERROR_FORMAT);
    CHECK_SAYS(error.message, "its levels need 128 bytes, but only 127 bytes follow the header");
    ki_writer_free(&w);
}

// What a KTX2 file states about its texels and kiln does not read is refused.
static void what_the_descriptor_states_is_heeded(void **state)
{
    (void)state;
    const sample_file f = {KTX2, HALF, 4, false, false, 97, 6, 1, NULL, 0, NULL};
    static const struct {
        int at; // after the begin of the descriptor
        uint8_t value;
        const char *sentence;
    } cases[] = {{12, 166, "holds UASTC texels; expand the file first"},
                 {13, 4, "states colour primaries 4 and transfer function 1"},
                 {14, 5, "states colour primaries 1 and transfer function 5"}};
    for (int i = 0; i < 3; i++) {
        ki_writer w = {.context = context};
        ki_decoded decoded;
        write_ktx2(&w, &f);
        w.bytes[80 + 24 + cases[i].at] = cases[i].value;
        assert_int_equal(ki_decode(context, w.bytes, w.size, "made", &decoded, NULL, &error),
                         KILN_ERROR_UNSUPPORTED);
        CHECK_SAYS(error.message, cases[i].sentence);
        ki_writer_free(&w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_format_is_read),
        cmocka_unit_test(a_flat_texture_is_a_panorama),
        cmocka_unit_test(what_the_descriptor_states_is_heeded),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}

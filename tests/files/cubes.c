// KTX2 and DDS: every format and compression there and back, and the bytes that specifications
// fix.
#include "codec/codec.h"
#include "codec/pixel_format.h"
#include "image/pack.h"

#if KILN_TEST_ZSTD
#include <zstd.h>
#endif

#include "kit/context.h"

static void make_cube(int size, int levels, kiln_map *map)
{
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, size, levels, map, &error));
    for (int k = 0; k < map->level_count; k++) {
        map->roughness[k] = (float)k / 7;
        for (size_t i = 0; i < kiln_map_texels(map, k) * 3; i++)
            map->level[k][i] = (float)((i * 7919 + (size_t)k) % 1000) / 100;
    }
}

// What a texel becomes in a format.
static void store(kiln_format format, const float rgb[3], float stored[3])
{
    memcpy(stored, rgb, 3 * sizeof *stored);
    if (format == KILN_FORMAT_RGBA16F || format == KILN_FORMAT_AUTO)
        for (int c = 0; c < 3; c++)
            stored[c] = ki_float_from_half(ki_half_from_float(rgb[c]));
    if (format == KILN_FORMAT_RGB9E5)
        ki_float_from_rgb9e5(ki_rgb9e5_from_float(rgb), stored);
    if (format == KILN_FORMAT_B10G11R11)
        ki_float_from_b10g11r11(ki_b10g11r11_from_float(rgb), stored);
}

// A level as blocks hold it, face by face.
static void store_blocks(kiln_map *map, int level, kiln_format format)
{
    const ki_pixel_format *pixel = ki_pixel_format_of(format);
    int n = kiln_map_level_size(map, level);
    size_t face = 3 * kiln_map_texels(map, level) / 6;
    uint8_t *bytes = malloc((size_t)ki_pixels_size(pixel, n, n));
    for (size_t f = 0; f < 6; f++) {
        assert_true(ki_pixels_pack(context, pixel, map->level[level] + f * face, n, n, 1, bytes));
        ki_pixels_unpack(pixel, bytes, n, n, map->level[level] + f * face);
    }
    free(bytes);
}

typedef kiln_result encoder(const kiln_map *map, const kiln_save_def *def, ki_writer *writer,
                            kiln_error *failure);

static void there_and_back(encoder *encode, const kiln_save_def *def, int size, int levels,
                           const char *encoding)
{
    kiln_map map;
    make_cube(size, levels, &map);
    ki_writer w = {.context = context}, again = {.context = context};
    CHECK_OK(encode(&map, def, &w, &error));
    CHECK_OK(encode(&map, def, &again, &error));
    assert_int_equal(w.size, again.size);
    assert_memory_equal(w.bytes, again.bytes, w.size);

    ki_decoded decoded;
    kiln_file_info info;
    CHECK_OK(ki_decode(context, w.bytes, w.size, "cube", &decoded, &info, &error));
    assert_true(decoded.is_map);
    assert_string_equal(info.encoding, encoding);
    assert_string_equal(info.layout, "cube");
    assert_int_equal(info.face_count, 6);
    assert_int_equal(info.level_count, map.level_count);
    assert_int_equal(decoded.map.size, size);
    assert_int_equal(decoded.map.level_count, map.level_count);
    for (int k = 0; k < map.level_count && ki_pixel_format_of(def->format)->block > 1; k++)
        store_blocks(&map, k, def->format);
    for (int k = 0; k < map.level_count; k++)
        for (size_t i = 0; i < kiln_map_texels(&map, k); i++) {
            float stored[3];
            store(def->format, map.level[k] + 3 * i, stored);
            assert_memory_equal(decoded.map.level[k] + 3 * i, stored, sizeof stored);
        }
    ki_decoded_free(&decoded);
    ki_writer_free(&w);
    ki_writer_free(&again);
    kiln_map_free(&map);
}

static void every_format_comes_back(void **state)
{
    (void)state;
    for (int format = KILN_FORMAT_RGBA16F; format <= KILN_FORMAT_UASTC; format++)
        for (int zstd = 0; zstd <= KILN_TEST_ZSTD; zstd++) {
            kiln_save_def def = {.format = (kiln_format)format, .zstd = zstd * 5};
            const ki_pixel_format *pixel = ki_pixel_format_of(def.format);
            if (!pixel->vk)
                continue;
            const char *name = ki_format_names[def.format ? def.format : KILN_FORMAT_RGBA16F];
            char encoding[48];
            snprintf(encoding, sizeof encoding, "%s%s", name, zstd ? ", zstd" : "");
            there_and_back(ki_ktx2_encode, &def, 16, 0, encoding);
            there_and_back(ki_ktx2_encode, &def, 5, 2, encoding);
            there_and_back(ki_ktx2_encode, &def, 1, 1, encoding);
            if (!zstd && pixel->dxgi) {
                there_and_back(ki_dds_encode, &def, 16, 0, encoding);
                there_and_back(ki_dds_encode, &def, 5, 2, encoding);
                there_and_back(ki_dds_encode, &def, 1, 1, encoding);
            }
        }
}

static uint32_t word(const ki_writer *w, size_t at)
{
    ki_reader r = ki_reader_make(w->bytes + at, 4);
    return ki_read_u32(&r);
}

static uint64_t long_word(const ki_writer *w, size_t at)
{
    return word(w, at) | (uint64_t)word(w, at + 4) << 32;
}

// The size that a frame of zstd states, as libzstd reads the frame. Without libzstd no level is
// compressed.
static uint64_t frame_size(const uint8_t *frame, size_t size)
{
#if KILN_TEST_ZSTD
    return ZSTD_getFrameContentSize(frame, size);
#else
    (void)frame, (void)size;
    return 0;
#endif
}

// KTX 2.0 section 3: the header's fields, the level index and the order of the levels.
static void ktx2_is_laid_out_as_specified(void **state)
{
    (void)state;
    kiln_map map;
    make_cube(16, 0, &map);
    for (int format = KILN_FORMAT_RGBA16F; format <= KILN_FORMAT_UASTC; format++)
        for (int zstd = 0; zstd <= KILN_TEST_ZSTD; zstd++) {
            const ki_pixel_format *texel = ki_pixel_format_of((kiln_format)format);
            if (!ki_pixel_format_of((kiln_format)format)->vk)
                continue;
            kiln_save_def def = {.format = texel->format, .zstd = 3 * zstd, .lobe = "ggx"};
            ki_writer w = {.context = context};
            CHECK_OK(ki_ktx2_encode(&map, &def, &w, &error));
            const uint32_t header[9] = {texel->vk,   (uint32_t)texel->type_size, 16, 16, 0, 0, 6, 5,
                                        zstd ? 2 : 0};
            for (int i = 0; i < 9; i++)
                assert_int_equal(word(&w, 12 + 4 * (size_t)i), header[i]);
            uint32_t dfd = word(&w, 48), dfd_size = word(&w, 52);
            uint32_t kvd = word(&w, 56), kvd_size = word(&w, 60);
            assert_int_equal(dfd, 80 + 5 * 24);
            assert_int_equal(word(&w, dfd), dfd_size);
            assert_int_equal(kvd, dfd + dfd_size);
            assert_int_equal(long_word(&w, 64), 0);
            assert_int_equal(long_word(&w, 72), 0);
            uint64_t end = kvd + kvd_size;
            for (int k = 4; k >= 0; k--) { // smallest first
                size_t entry = 80 + 24 * (size_t)k;
                uint64_t offset = long_word(&w, entry), length = long_word(&w, entry + 8);
                uint64_t edge = (uint64_t)((16 >> k) + texel->block - 1) / (uint64_t)texel->block;
                uint64_t plain = 6 * edge * edge * (uint64_t)texel->bytes;
                assert_int_equal(long_word(&w, entry + 16), plain);
                if (zstd) {
                    assert_int_equal(offset, end);
                    assert_int_equal(frame_size(w.bytes + offset, length), plain);
                } else {
                    assert_int_equal(offset % (uint64_t)texel->bytes, 0);
                    assert_true(offset >= end && offset < end + (uint64_t)texel->bytes);
                    assert_int_equal(length, plain);
                }
                end = offset + length;
            }
            assert_int_equal(end, w.size);
            ki_writer_free(&w);
        }
    kiln_map_free(&map);
}

// Khronos Data Format 1.3: samples of each format as its section on the Vulkan formats lists them.
static void data_formats_are_as_specified(void **state)
{
    (void)state;
    static const struct {
        kiln_format format;
        int count;
        uint32_t samples[6][3]; // offset, length and channel; lower; upper
    } wanted[] = {
        {KILN_FORMAT_RGBA16F,
         4,
         {{0xc00f0000, 0xbf800000, 0x3f800000},
          {0xc10f0010, 0xbf800000, 0x3f800000},
          {0xc20f0020, 0xbf800000, 0x3f800000},
          {0xcf0f0030, 0xbf800000, 0x3f800000}}},
        {KILN_FORMAT_RGBA32F,
         4,
         {{0xc01f0000, 0xbf800000, 0x3f800000},
          {0xc11f0020, 0xbf800000, 0x3f800000},
          {0xc21f0040, 0xbf800000, 0x3f800000},
          {0xcf1f0060, 0xbf800000, 0x3f800000}}},
        {KILN_FORMAT_RGB9E5,
         6,
         {{0x00080000, 0, 8448},
          {0x2004001b, 15, 31},
          {0x01080009, 0, 8448},
          {0x2104001b, 15, 31},
          {0x02080012, 0, 8448},
          {0x2204001b, 15, 31}}},
        {KILN_FORMAT_B10G11R11,
         3,
         {{0x800a0000, 0, 0x3f800000}, {0x810a000b, 0, 0x3f800000}, {0x82090016, 0, 0x3f800000}}},
        {KILN_FORMAT_BC6H, 1, {{0x807f0000, 0, 0x3f800000}}},
        {KILN_FORMAT_UASTC, 1, {{0x807f0000, 0, 0x3f800000}}},
    };
    kiln_map map;
    make_cube(4, 1, &map);
    for (size_t f = 0; f < sizeof wanted / sizeof *wanted; f++) {
        kiln_save_def def = {.format = wanted[f].format};
        ki_writer w = {.context = context};
        CHECK_OK(ki_ktx2_encode(&map, &def, &w, &error));
        size_t at = word(&w, 48);
        uint32_t block = 24 + 16 * (uint32_t)wanted[f].count;
        bool blocks = wanted[f].count == 1;
        // colour models 133 (BC6H) and 167 (UASTC HDR 4x4)
        uint32_t model = wanted[f].format == KILN_FORMAT_UASTC ? 0x000101a7 : 0x00010185;
        const uint32_t words[7] = {4 + block,
                                   0,
                                   2 | block << 16,
                                   blocks ? model : 0x00010101,
                                   blocks ? 0x0303 : 0,
                                   (uint32_t)ki_pixel_format_of(wanted[f].format)->bytes,
                                   0};
        for (int i = 0; i < 7; i++)
            assert_int_equal(word(&w, at + 4 * (size_t)i), words[i]);
        for (int i = 0; i < wanted[f].count; i++) {
            size_t sample = at + 28 + 16 * (size_t)i;
            assert_int_equal(word(&w, sample), wanted[f].samples[i][0]);
            assert_int_equal(word(&w, sample + 4), 0);
            assert_int_equal(word(&w, sample + 8), wanted[f].samples[i][1]);
            assert_int_equal(word(&w, sample + 12), wanted[f].samples[i][2]);
        }
        ki_writer_free(&w);
    }
    kiln_map_free(&map);
}

static void metadata_comes_back(void **state)
{
    (void)state;
    kiln_sh sh = {.bands = 3, .irradiance = true, .window = 2.5};
    for (int i = 0; i < 27; i++)
        sh.c[i / 3][i % 3] = (i - 13) * 1.2345678901e-3;
    kiln_map map;
    make_cube(8, 0, &map);
    kiln_save_def def = {.sh = &sh, .lobe = "charlie"};
    ki_writer w = {.context = context};
    CHECK_OK(ki_ktx2_encode(&map, &def, &w, &error));
    ki_decoded decoded;
    kiln_file_info info;
    CHECK_OK(ki_decode(context, w.bytes, w.size, "cube", &decoded, &info, &error));
    assert_string_equal(info.format, "ktx2");
    assert_string_equal(info.writer, "kiln 0.2.0");
    assert_string_equal(info.orientation, "rd");
    assert_int_equal(info.sh_bands, 3);
    for (int i = 0; i < 27; i++)
        CHECK_NEAR((double)info.sh[i / 3][i % 3], (double)(float)sh.c[i / 3][i % 3], 1e-9);
    for (int k = 0; k < KILN_MAX_LEVELS; k++) {
        assert_true(info.roughness[k] == (k < 4 ? map.roughness[k] : -1));
        if (k < 4)
            assert_true(decoded.map.roughness[k] == map.roughness[k]);
    }
    // Keys in the order of their bytes.
    static const char *const keys[] = {"KTXorientation", "KTXwriter", "kiln:lobe", "kiln:roughness",
                                       "kiln:sh"};
    size_t at = word(&w, 56);
    for (int i = 0; i < 5; i++) {
        assert_string_equal((const char *)w.bytes + at + 4, keys[i]);
        at += 4 + ((size_t)word(&w, at) + 3) / 4 * 4;
    }
    assert_int_equal(at, word(&w, 56) + word(&w, 60));
    ki_decoded_free(&decoded);
    ki_writer_free(&w);
    kiln_map_free(&map);
}

// The DX10 header, field by field, and the order of the texels: face, then level.
static void dds_is_laid_out_as_specified(void **state)
{
    (void)state;
    kiln_map map;
    make_cube(4, 0, &map);
    kiln_save_def def = {.format = KILN_FORMAT_RGBA32F};
    ki_writer w = {.context = context};
    CHECK_OK(ki_dds_encode(&map, &def, &w, &error));
    assert_memory_equal(w.bytes, "DDS ", 4);
    assert_int_equal(word(&w, 4), 124);
    assert_int_equal(word(&w, 8), 0x2100f);
    assert_int_equal(word(&w, 12), 4);
    assert_int_equal(word(&w, 16), 4);
    assert_int_equal(word(&w, 20), 64);
    assert_int_equal(word(&w, 28), 3);
    assert_int_equal(word(&w, 76), 32);
    assert_int_equal(word(&w, 80), 4);
    assert_memory_equal(w.bytes + 84, "DX10", 4);
    assert_int_equal(word(&w, 108), 0x401008);
    assert_int_equal(word(&w, 112), 0xfe00);
    const uint32_t extended[5] = {2, 3, 4, 1, 0};
    for (int i = 0; i < 5; i++)
        assert_int_equal(word(&w, 128 + 4 * (size_t)i), extended[i]);
    size_t at = 148;
    for (int face = 0; face < 6; face++)
        for (int k = 0; k < 3; k++) {
            size_t count = (size_t)(4 >> k) * (size_t)(4 >> k);
            for (size_t i = 0; i < count; i++, at += 16) {
                assert_memory_equal(w.bytes + at, map.level[k] + 3 * (count * (size_t)face + i),
                                    12);
                assert_int_equal(word(&w, at + 12), 0x3f800000);
            }
        }
    assert_int_equal(at, w.size);

    // The two older codes, without the extended header.
    static const uint32_t codes[2] = {116, 113};
    for (int i = 0; i < 2; i++) {
        ki_writer_free(&w);
        w.context = context;
        def.format = i ? KILN_FORMAT_RGBA16F : KILN_FORMAT_RGBA32F;
        CHECK_OK(ki_dds_encode(&map, &def, &w, &error));
        memmove(w.bytes + 128, w.bytes + 148, w.size - 148);
        w.size -= 20;
        ki_patch_u32(&w, 84, codes[i]);
        ki_decoded decoded;
        CHECK_OK(ki_decode(context, w.bytes, w.size, "old.dds", &decoded, NULL, &error));
        for (size_t t = 0; t < 96; t++) {
            float stored[3];
            store(def.format, map.level[0] + 3 * t, stored);
            assert_memory_equal(decoded.map.level[0] + 3 * t, stored, sizeof stored);
        }
        ki_decoded_free(&decoded);
    }
    ki_writer_free(&w);
    kiln_map_free(&map);
}

static void refused(ki_writer *w, size_t at, uint32_t value, kiln_result wanted,
                    const char *sentence)
{
    uint32_t before = word(w, at);
    ki_patch_u32(w, at, value);
    ki_decoded decoded;
    assert_int_equal(ki_decode(context, w->bytes, w->size, "bad", &decoded, NULL, &error), wanted);
    assert_string_equal(error.message, sentence);
    assert_null(decoded.map.owner);
    ki_patch_u32(w, at, before);
}

// A file of general ASTC, whose blocks have modes that UASTC HDR lacks, is refused with the block's
// number, and never read wrongly.
static void other_astc_is_refused(void **state)
{
    (void)state;
    kiln_map map;
    make_cube(16, 1, &map);
    ki_writer w = {.context = context};
    kiln_save_def def = {.format = KILN_FORMAT_UASTC};
    CHECK_OK(ki_ktx2_encode(&map, &def, &w, &error));
    ki_reader r = ki_reader_make(w.bytes + 80, 8);
    size_t begin = (size_t)ki_read_u64(&r);
    memset(w.bytes + begin + 5 * (size_t)16, 0x42, 16); // a grid of 2 x 5 weights
    ki_decoded decoded;
    assert_int_equal(ki_decode(context, w.bytes, w.size, "astc", &decoded, NULL, &error),
                     KILN_ERROR_UNSUPPORTED);
    assert_string_equal(error.message,
                        "astc: block 5 of 96 in level 0 is not in one of the 24 modes of UASTC HDR "
                        "4x4; kiln reads no other ASTC, expand the file first");
    ki_writer_free(&w);
    kiln_map_free(&map);
}

static void what_is_not_read_is_said(void **state)
{
    (void)state;
    kiln_map map;
    make_cube(8, 2, &map);
    ki_writer w = {.context = context};
    kiln_save_def def = {0};
    CHECK_OK(ki_ktx2_encode(&map, &def, &w, &error));
    refused(&w, 12, 38, KILN_ERROR_UNSUPPORTED,
            "bad: has vkFormat 38; kiln reads RGB and RGBA of 8 and 16 bits, of 16-bit and 32-bit "
            "floats, and the formats 122, 123, 143 and 1000066000");
    refused(&w, 12, 144, KILN_ERROR_UNSUPPORTED,
            "bad: holds signed BC6H; kiln reads unsigned BC6H, and floats");
    refused(&w, 36, 3, KILN_ERROR_UNSUPPORTED,
            "bad: has 3 faces, 0 layers and depth 0; kiln reads single cubes, pictures and tables "
            "only");
    refused(&w, 28, 2, KILN_ERROR_UNSUPPORTED,
            "bad: has 6 faces, 0 layers and depth 2; kiln reads single cubes, pictures and tables "
            "only");
    refused(&w, 36, 1, KILN_ERROR_FORMAT,
            "bad: level 0 holds 3072 bytes, but its texels need 512 bytes");
    refused(&w, 44, 1, KILN_ERROR_UNSUPPORTED,
            "bad: is compressed by BasisLZ; expand the file first, for example by 'ktx transcode "
            "--target rgba8'");
    refused(&w, 44, 4, KILN_ERROR_UNSUPPORTED,
            "bad: has supercompression scheme 4; kiln reads the schemes 0 (none), 2 (zstd) and 3 "
            "(zlib)");
    refused(&w, 24, 4, KILN_ERROR_FORMAT,
            "bad: faces are 8 x 4, they must be square with sides of 1 to 32768");
    refused(&w, 40, 5, KILN_ERROR_FORMAT,
            "bad: has 5 levels, which is too many for faces of size 8");
    refused(&w, 88, 16, KILN_ERROR_FORMAT,
            "bad: level 0 holds 16 bytes, but its six faces need 3072 bytes");
    ki_writer_free(&w);
    w.context = context;
    CHECK_OK(ki_dds_encode(&map, &def, &w, &error));
    refused(
        &w, 128, 71, KILN_ERROR_UNSUPPORTED,
        "bad: has pixel format 71; kiln reads the DXGI formats 2, 6, 10, 11, 26, 28, 29, 67, 87, "
        "88, 91, 93 and 95, the older codes 36, 113 and 116, and RGB and RGBA of 8 bits by masks");
    refused(&w, 128, 96, KILN_ERROR_UNSUPPORTED,
            "bad: holds signed BC6H; kiln reads unsigned BC6H, and floats");
    refused(&w, 140, 2, KILN_ERROR_UNSUPPORTED,
            "bad: kiln reads DDS files of one cube with six faces or of one picture, and this file "
            "holds something else");
    w.size -= 8;
    refused(&w, 128, 10, KILN_ERROR_FORMAT,
            "bad: its levels need 3840 bytes, but only 3832 bytes follow the header");
    ki_writer_free(&w);
    w.context = context;
    def.zstd = 3;
    assert_int_equal(ki_dds_encode(&map, &def, &w, &error), KILN_ERROR_ARGUMENT);
    ki_writer_free(&w);
    kiln_map_free(&map);
}

#if !KILN_TEST_ZSTD
// A build without zstd refuses to write a compressed file, and to read one that others wrote.
static void without_zstd_it_is_said(void **state)
{
    (void)state;
    static const char *const sentence =
        ": this build of kiln has no zstd, which the CMake option KILN_ZSTD adds";
    kiln_map map;
    make_cube(8, 2, &map);
    const kiln_save_def def = {.zstd = 3}, plain = {0};
    kiln_files files;
    kiln_error asked = {0};
    char wanted[128];
    snprintf(wanted, sizeof wanted, "a.ktx2%s", sentence);
    assert_int_equal(kiln_map_save_check("a.ktx2", KILN_SHAPE_CUBE, &def, &asked),
                     KILN_ERROR_UNSUPPORTED);
    assert_string_equal(asked.message, wanted);
    assert_int_equal(kiln_map_encode(context, &map, "a.ktx2", &def, &files, NULL, &error),
                     KILN_ERROR_UNSUPPORTED);
    assert_string_equal(error.message, wanted);
    assert_int_equal(files.count, 0);
    ki_writer w = {.context = context};
    CHECK_OK(ki_ktx2_encode(&map, &plain, &w, &error));
    snprintf(wanted, sizeof wanted, "bad%s", sentence);
    refused(&w, 44, 2, KILN_ERROR_UNSUPPORTED, wanted);
    ki_writer_free(&w);
    kiln_map_free(&map);
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_format_comes_back, set_up, tear_down),
        cmocka_unit_test_setup_teardown(ktx2_is_laid_out_as_specified, set_up, tear_down),
        cmocka_unit_test_setup_teardown(data_formats_are_as_specified, set_up, tear_down),
        cmocka_unit_test_setup_teardown(metadata_comes_back, set_up, tear_down),
        cmocka_unit_test_setup_teardown(dds_is_laid_out_as_specified, set_up, tear_down),
        cmocka_unit_test_setup_teardown(other_astc_is_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_not_read_is_said, set_up, tear_down),
#if !KILN_TEST_ZSTD
        cmocka_unit_test_setup_teardown(without_zstd_it_is_said, set_up, tear_down),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

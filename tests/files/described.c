// Files that kiln describes without reading them, in hostile hands: cut off, damaged, and made to lie.
#include "codec/engine_text.h"
#include "codec/env.h"
#include "codec/formats.h"
#include "codec/gltf.h"
#include "codec/ktx1.h"
#include "codec/png_text.h"

#include "kit/context.h"

static kiln_map make_cube(int size, int level_count)
{
    kiln_map map = make_map(context, KILN_SHAPE_CUBE, size, level_count);
    for (int k = 0; k < map.level_count; k++) {
        map.roughness[k] = map.level_count > 1 ? (float)k / (float)(map.level_count - 1) : 0;
        for (size_t i = 0; i < 3 * kiln_map_texels(&map, k); i++)
            map.level[k][i] = (float)(i * i % 251) / 16;
    }
    return map;
}

enum { ENV, GLB, KTX1, ATLAS, SAMPLES };
static const char *const names[SAMPLES] = {"a.env", "a.glb", "a.ktx", "a.dds"};

static ki_writer make_sample(int which)
{
    ki_writer w = {.context = context};
    kiln_map map = make_cube(16, 0);
    kiln_sh sh = {.bands = 3, .c = {{1, 2, 3}, {0.5, 0, -0.5}}};
    kiln_image atlas = {16, 16, 4, map.level[0], NULL};
    if (which == ENV)
        CHECK_OK(ki_env_encode(&map, 0.8, &sh, &w, &error));
    else if (which == GLB)
        CHECK_OK(ki_gltf_encode(&map, &sh, &w, &error));
    else if (which == KTX1)
        CHECK_OK(ki_ktx1_encode(&map, &sh, "filament", KILN_FORMAT_RGBA16F, &w, &error));
    else
        CHECK_OK(ki_dds_encode_atlas(&atlas, "playcanvas-dds", &w, &error));
    kiln_map_free(&map);
    return w;
}

// In memory that ends where the bytes end, so that checkers see a read behind it.
static kiln_result describe(const void *bytes, size_t size, const char *name, kiln_file_info *info)
{
    uint8_t *exact = malloc(size ? size : 1);
    memcpy(exact, bytes, size);
    error.message[0] = 0;
    kiln_result result = ki_decode(context, exact, size, name, NULL, info, &error);
    free(exact);
    if (result != KILN_OK && !strstr(error.message, name))
        fail_msg("the sentence does not name the file %s: %s", name, error.message);
    return result;
}

static void cut_files_are_refused(void **state)
{
    (void)state;
    kiln_file_info info;
    for (int i = 0; i < SAMPLES; i++) {
        ki_writer w = make_sample(i);
        CHECK_OK(describe(w.bytes, w.size, names[i], &info));
        assert_int_equal(info.width, 16);
        for (size_t size = 0; size < w.size; size += size < 3000 ? 1 : 97) {
            kiln_result result = describe(w.bytes, size, names[i], &info);
            if (result != KILN_ERROR_FORMAT)
                fail_msg("%s cut to %zu of %zu bytes gives %d", names[i], size, w.size,
                         (int)result);
        }
        ki_writer_free(&w);
    }
}

static void check_said(const kiln_file_info *info)
{
    assert_in_range(info->level_count, 1, KILN_MAX_LEVELS);
    assert_in_range(info->width, 1, KILN_MAX_SIZE);
    for (int k = 0; k < KILN_MAX_LEVELS; k++)
        assert_true(info->roughness[k] == -1 ||
                    (info->roughness[k] >= 0 && info->roughness[k] <= 1));
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            assert_true(isfinite(info->sh[i][c]));
}

static void damaged_files_do_no_harm(void **state)
{
    (void)state;
    uint64_t seed = 1;
    kiln_file_info info;
    for (int i = 0; i < SAMPLES; i++) {
        ki_writer w = make_sample(i);
        uint8_t *bytes = malloc(w.size);
        size_t head = w.size < 2500 ? w.size : 2500;
        for (int round = 0; round < 4000; round++) {
            memcpy(bytes, w.bytes, w.size);
            for (int k = 0; k <= round % 3; k++) {
                uint64_t bits = random_bits(&seed);
                bytes[(size_t)(bits >> 8) % head] = (uint8_t)bits;
            }
            if (describe(bytes, w.size, names[i], &info) == KILN_OK)
                check_said(&info);
        }
        free(bytes);
        ki_writer_free(&w);
    }
}

// ---------------------------------------------------------------------------------------- manifests

static kiln_result describe_env(const char *manifest, kiln_file_info *info)
{
    char bytes[8192];
    const size_t length = strlen(manifest);
    assert_true(length + 209 < sizeof bytes);
    memset(bytes, 0, sizeof bytes);
    memcpy(bytes, "\x86\x16\x87\x96\xf6\xd6\x96\x36", 8);
    memcpy(bytes + 8, manifest, length);
    return describe(bytes, 8 + length + 1 + 200, "m.env", info);
}

#define IMAGE "{\"length\":100,\"position\":100}"
#define SIX IMAGE "," IMAGE "," IMAGE "," IMAGE "," IMAGE "," IMAGE
#define FULL "{\"version\":2,\"width\":4,\"specular\":{\"mipmaps\":[" SIX "]}}"

static void manifests_are_checked(void **state)
{
    (void)state;
    static const struct {
        const char *manifest;
        kiln_result result;
        const char *sentence;
    } cases[] = {
        {FULL, KILN_OK, ""},
        {"{\"x\":[[{\"y\":\"}]\\\"\"}],null,-1e5],\"version\":1,\"width\":4,\"specular\":"
         "{\"mipmaps\":[" SIX "],\"lodGenerationScale\":1}}",
         KILN_OK, ""},
        {"", KILN_ERROR_FORMAT, "damaged at byte 8"},
        {"[]", KILN_ERROR_FORMAT, "damaged at byte 8"},
        {"{\"version\":2", KILN_ERROR_FORMAT, "damaged at byte 20"},
        {"{\"version\":-1}", KILN_ERROR_FORMAT, "damaged"},
        {"{\"version\":2.5}", KILN_ERROR_FORMAT, "damaged"},
        {"{\"version\":1e400}", KILN_ERROR_FORMAT, "damaged"},
        {"{\"version\":\"2\"}", KILN_ERROR_FORMAT, "damaged"},
        {"{\"version\":3}", KILN_ERROR_UNSUPPORTED,
         "is an .env file of version 3, kiln reads the versions 1 and 2"},
        {"{\"version\":2,\"width\":0}", KILN_ERROR_FORMAT, "faces are 0 wide"},
        {"{\"version\":2,\"width\":40000}", KILN_ERROR_FORMAT, "faces are 40000 wide"},
        {"{\"version\":2,\"width\":4}", KILN_ERROR_FORMAT, "has 0 images for faces of size 4"},
        {"{\"version\":2,\"width\":4,\"specular\":{\"mipmaps\":[" IMAGE "]}}", KILN_ERROR_FORMAT,
         "has 1 images for faces of size 4"},
        {"{\"version\":2,\"width\":1,\"specular\":{\"mipmaps\":[" SIX "," SIX "]}}",
         KILN_ERROR_FORMAT, "has 12 images for faces of size 1"},
        {"{\"version\":2,\"width\":4,\"specular\":{\"mipmaps\":[" SIX
         ",{\"length\":1,\"position\":4294967295}," IMAGE "," IMAGE "," IMAGE "," IMAGE "," IMAGE
         "]}}",
         KILN_ERROR_FORMAT,
         "need 4294967296 bytes after the manifest, but only 200 bytes follow it"},
    };
    kiln_file_info info;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        kiln_result result = describe_env(cases[i].manifest, &info);
        if (result != cases[i].result || !strstr(error.message, cases[i].sentence))
            fail_msg("%s gives %d: %s", cases[i].manifest, (int)result, error.message);
        if (result == KILN_OK) {
            assert_int_equal(info.level_count, 1);
            assert_int_equal(info.sh_bands, 0);
            assert_string_equal(info.encoding, "rgbd, png");
        }
    }
    // Depth without end, which needs no stack.
    char deep[7000] = "{\"x\":";
    memset(deep + 5, '[', sizeof deep - 6);
    assert_int_equal(describe_env(deep, &info), KILN_ERROR_FORMAT);
    // A scale of which no roughness comes.
    CHECK_OK(describe_env("{\"version\":2,\"width\":4,\"specular\":{\"lodGenerationScale\":1e9,"
                          "\"mipmaps\":[" SIX "]}}",
                          &info));
    assert_true(info.roughness[0] == -1);
}

// -------------------------------------------------------------------------------------------- glTF

static kiln_result describe_glb(const char *json, kiln_file_info *info)
{
    ki_writer w = {.context = context};
    size_t length = strlen(json), padded = (length + 3) / 4 * 4;
    ki_write(&w, "glTF", 4);
    ki_write_u32(&w, 2);
    ki_write_u32(&w, (uint32_t)(12 + 8 + padded + 8 + 16));
    ki_write_u32(&w, (uint32_t)padded);
    ki_write_u32(&w, 0x4e4f534a);
    ki_write_text(&w, "%s%*s", json, (int)(padded - length), "");
    ki_write_u32(&w, 16);
    ki_write_u32(&w, 0x004e4942);
    ki_write(&w, "0123456789abcdef", 16);
    kiln_result result = describe(w.bytes, w.size, "m.glb", info);
    ki_writer_free(&w);
    return result;
}

#define LIGHT(images, size, more)                                                                  \
    "{\"bufferViews\":[{\"byteOffset\":4,\"byteLength\":12}],\"extensions\":{\"KHR_x\":[1],"       \
    "\"EXT_lights_image_based\":{\"lights\":[{\"specularImageSize\":" size                         \
    ",\"specularImages\":[" images "]" more "},{\"specularImageSize\":\"other\"}]}}}"

static void gltf_is_checked(void **state)
{
    (void)state;
    static const struct {
        const char *json;
        kiln_result result;
        const char *sentence;
    } cases[] = {
        {LIGHT("[0,1,2,3,4,5],[0,1,2,3,4,5]", "8", ""), KILN_OK, ""},
        {"{\"asset\":{}}", KILN_ERROR_UNSUPPORTED, "without a light of EXT_lights_image_based"},
        {"{\"extensions\":{\"EXT_lights_image_based\":{\"lights\":[]}}}", KILN_ERROR_UNSUPPORTED,
         "without a light"},
        {"{\"extensions\":{\"EXT_lights_image_based\":[]}}", KILN_ERROR_FORMAT, "damaged at byte"},
        {LIGHT("[0,1,2,3,4]", "8", ""), KILN_ERROR_FORMAT, "each level must have six images"},
        {LIGHT("[0,1,2,3,4,5,6]", "8", ""), KILN_ERROR_FORMAT, "each level must have six images"},
        {LIGHT("", "8", ""), KILN_ERROR_FORMAT, "has 0 levels for faces of size 8"},
        {LIGHT("[0,1,2,3,4,5],[0,1,2,3,4,5]", "1", ""), KILN_ERROR_FORMAT,
         "has 2 levels for faces of size 1"},
        {"{\"bufferViews\":[{\"byteOffset\":5,\"byteLength\":12}],\"extensions\":"
         "{\"EXT_lights_image_based\":{\"lights\":[{\"specularImageSize\":4,\"specularImages\":"
         "[[0,0,0,0,0,0]]}]}}}",
         KILN_ERROR_FORMAT, "its images need 17 bytes of the buffer, which has 16 bytes"},
    };
    kiln_file_info info;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        kiln_result result = describe_glb(cases[i].json, &info);
        if (result != cases[i].result || !strstr(error.message, cases[i].sentence))
            fail_msg("%s gives %d: %s", cases[i].json, (int)result, error.message);
    }
    // Eight coefficients are none.
    CHECK_OK(describe_glb(LIGHT("[0,1,2,3,4,5]", "8",
                                ",\"irradianceCoefficients\":[[1,1,1],[1,1,1],[1,1,1],[1,1,1],"
                                "[1,1,1],[1,1,1],[1,1,1],[1,1,1]]"),
                          &info));
    assert_int_equal(info.sh_bands, 0);
    assert_int_equal(
        describe_glb(LIGHT("[0,1,2,3,4,5]", "8", ",\"irradianceCoefficients\":[[1,1]]"), &info),
        KILN_ERROR_FORMAT); // a triple of two, and one of four
    assert_int_equal(
        describe_glb(LIGHT("[0,1,2,3,4,5]", "8", ",\"irradianceCoefficients\":[[1,1,1,1]]"), &info),
        KILN_ERROR_FORMAT);
}

// ------------------------------------------------------------------------------------- KTX 1, texts

static void ktx1_is_checked(void **state)
{
    (void)state;
    static const struct {
        size_t at;
        uint32_t value;
        kiln_result result;
    } cases[] = {{12, 0x01020304, KILN_ERROR_FORMAT},  // the other byte order
                 {28, 0x8c3a, KILN_ERROR_UNSUPPORTED}, // internal format
                 {36, 15, KILN_ERROR_FORMAT},          // width, not the height
                 {36, 0, KILN_ERROR_FORMAT},           {52, 1, KILN_ERROR_UNSUPPORTED}, // faces
                 {56, 6, KILN_ERROR_FORMAT},           {56, 17, KILN_ERROR_FORMAT},     // levels
                 {60, 0xffffffff, KILN_ERROR_FORMAT},  // bytes of pairs
                 {64, 0xfffffff0, KILN_ERROR_FORMAT}}; // of the first pair
    kiln_file_info info;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ki_writer w = make_sample(KTX1);
        ki_patch_u32(&w, cases[i].at, cases[i].value);
        kiln_result result = describe(w.bytes, w.size, "m.ktx", &info);
        if (result != cases[i].result)
            fail_msg("%u at %zu gives %d: %s", cases[i].value, cases[i].at, (int)result,
                     error.message);
        ki_writer_free(&w);
    }
}

// Six faces of 2^31 bytes, of which the file has none: 6 * 2^31 is 0 in 32 bits.
static void faces_beyond_32_bits_are_missed(void **state)
{
    (void)state;
    enum { WIDTH = 36, HEIGHT = 40, LEVELS = 56, PAIR_BYTES = 60, PAIRS = 64 };
    ki_writer w = make_sample(KTX1);
    kiln_file_info info;
    ki_patch_u32(&w, WIDTH, 16384);
    ki_patch_u32(&w, HEIGHT, 16384);
    ki_patch_u32(&w, LEVELS, 1);
    size_t levels = PAIRS + (size_t)w.bytes[PAIR_BYTES] + 256 * (size_t)w.bytes[PAIR_BYTES + 1];
    ki_patch_u32(&w, levels, 0x80000000);
    assert_int_equal(describe(w.bytes, levels + 4, "m.ktx", &info), KILN_ERROR_FORMAT);
    assert_string_equal(error.message, "m.ktx: its 1 levels are cut off or damaged");
    ki_writer_free(&w);
}

static void lines_are_taken_as_far_as_they_make_sense(void **state)
{
    (void)state;
    static const struct {
        const char *line, *engine, *layout;
        int levels;
        float last;
    } cases[] = {
        {"engine=a layout=atlas roughness=0,0.5,1", "a", "atlas", 3, 1},
        {"layout=cubeuv", "", "cubeuv", 1, -1},
        {"layout=table engine=b", "b", "", 1, -1},
        {"roughness=0,0.25", "", "", 2, 0.25F},
        {"roughness=", "", "", 1, -1},
        {"roughness=0,1.5", "", "", 1, -1},
        {"roughness=0,-1", "", "", 1, -1},
        {"roughness=0;1", "", "", 1, -1},
        {"roughness=0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,1", "", "", 1, -1},
        {"xengine=a engine", "", "", 1, -1},
        {"engine=an-engine-whose-name-is-long", "an-engine-whose-name-is", "", 1, -1},
        {"", "", "", 1, -1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        kiln_file_info info = {.level_count = 1, .roughness = {-1, -1, -1}};
        ki_engine_text_read(cases[i].line, &info);
        assert_string_equal(info.engine, cases[i].engine);
        assert_string_equal(info.layout, cases[i].layout);
        assert_int_equal(info.level_count, cases[i].levels);
        assert_true(info.roughness[cases[i].levels - 1] == cases[i].last);
    }
}

// A text goes between the header and the pixels, which stay what they were, and any reader passes over it.
static void texts_stand_in_a_png(void **state)
{
    (void)state;
    kiln_map map = make_cube(8, 1);
    ki_writer plain = {.context = context}, texts = plain;
    CHECK_OK(ki_png_encode(map.level[0], 8, 8, 3, KI_PNG_PLAIN8, &plain, &error));
    ki_write(&texts, plain.bytes, plain.size);
    ki_png_add_text(&texts, 0, "kiln:engine", "engine=x layout=atlas roughness=0.25");
    ki_png_add_text(&texts, 0, "Software", "kiln 9.9.9");
    // Chunks are data and 12 bytes.
    assert_int_equal(texts.size, plain.size + 8 + 1 + 10 + 12 + 11 + 1 + 36 + 12);
    assert_memory_equal(texts.bytes, plain.bytes, 33);
    assert_memory_equal(texts.bytes + 33, "\0\0\0\x13tEXtSoftware\0kiln 9.9.9", 27);
    assert_memory_equal(texts.bytes + texts.size - (plain.size - 33), plain.bytes + 33,
                        plain.size - 33);
    kiln_file_info info;
    ki_decoded decoded[2];
    CHECK_OK(ki_decode(context, plain.bytes, plain.size, "p", &decoded[0], NULL, &error));
    CHECK_OK(ki_decode(context, texts.bytes, texts.size, "t", &decoded[1], &info, &error));
    assert_memory_equal(decoded[0].image.pixels, decoded[1].image.pixels, 64 * 3 * sizeof(float));
    assert_string_equal(info.engine, "x");
    assert_string_equal(info.layout, "atlas");
    assert_string_equal(info.writer, "kiln 9.9.9");
    assert_true(info.roughness[0] == 0.25F);
    ki_decoded_free(&decoded[0]);
    ki_decoded_free(&decoded[1]);
    ki_writer_free(&plain);
    ki_writer_free(&texts);
    kiln_map_free(&map);
}

// The writer that a file names is printed on terminals, which obey control characters: the name ends
// before the first of them, in every format that has such a name.
static void control_characters_end_a_writers_name(void **state)
{
    (void)state;
    const ki_exr_options options = {.half = true, .roughness = -1};
    const kiln_save_def def = {0};
    kiln_map map = make_cube(4, 1);
    for (int i = 0; i < 3; i++) {
        ki_writer w = {.context = context};
        kiln_file_info info;
        if (i == 0)
            CHECK_OK(ki_ktx2_encode(&map, &def, &w, &error));
        else if (i == 1)
            CHECK_OK(ki_exr_encode(map.level[0], 4, 4, 3, &options, &w, &error));
        else
            CHECK_OK(ki_hdr_encode(map.level[0], 4, 4, &w, &error));
        char wanted[32];
        snprintf(wanted, sizeof wanted, "kiln %s", kiln_version());
        size_t at = 0, length = strlen(wanted);
        while (at + length < w.size && memcmp(w.bytes + at, wanted, length) != 0)
            at++;
        CHECK_OK(describe(w.bytes, w.size, "w", &info));
        assert_string_equal(info.writer, wanted);
        w.bytes[at + 6] = 0x1b;
        wanted[6] = 0;
        CHECK_OK(describe(w.bytes, w.size, "w", &info));
        assert_string_equal(info.writer, wanted);
        ki_writer_free(&w);
    }
    kiln_map_free(&map);
}

// Harmonics of irradiance in a file are described as what they are.
static void irradiance_is_not_called_radiance(void **state)
{
    (void)state;
    kiln_map map = make_cube(4, 1);
    for (int irradiance = 0; irradiance < 2; irradiance++) {
        const kiln_sh sh = {.bands = 2, .irradiance = irradiance, .c = {{1, 2, 3}, {4, 5, 6}}};
        const kiln_save_def def = {.sh = &sh};
        ki_writer w = {.context = context};
        kiln_file_info info;
        CHECK_OK(ki_ktx2_encode(&map, &def, &w, &error));
        CHECK_OK(describe(w.bytes, w.size, "i.ktx2", &info));
        assert_int_equal(info.sh_bands, 2);
        assert_int_equal(info.sh_irradiance, irradiance);
        assert_true(info.sh[1][2] == 6);
        ki_writer_free(&w);
    }
    kiln_map_free(&map);
}

// Every text that kiln writes harmonics as, with each number of bands: what was saved is what is said.
static void harmonics_in_text_are_described(void **state)
{
    (void)state;
    static const char *const endings[3][2] = {{"json", "json"}, {"txt", "text"}, {"h", "c"}};
    folder_make();
    for (int e = 0; e < 3; e++)
        for (int bands = 1; bands <= KILN_MAX_BANDS; bands++)
            for (int irradiance = 0; irradiance < 2; irradiance++) {
                char name[16], path[128];
                kiln_sh sh = {.bands = bands, .irradiance = irradiance, .window = 1.5 * irradiance};
                for (int i = 0; i < 3 * bands * bands; i++)
                    sh.c[i / 3][i % 3] = (i % 2 ? -1 : 1) * pow(10, i % 13 - 8) / 3;
                kiln_file_info info;
                snprintf(name, sizeof name, "sh.%s", endings[e][0]);
                strcpy(path, in_folder(name));
                CHECK_OK(kiln_sh_save(context, &sh, path, &error));
                CHECK_OK(kiln_file_describe(context, path, &info, &error));
                assert_string_equal(info.format, endings[e][1]);
                assert_string_equal(info.layout, "harmonics");
                assert_int_equal(info.width, bands * bands);
                assert_int_equal(info.sh_bands, bands);
                // Lines do not say what they are of.
                assert_int_equal(info.sh_irradiance, e == 1 ? 0 : irradiance);
                for (int i = 0; i < bands * bands; i++)
                    for (int c = 0; c < 3; c++)
                        CHECK_NEAR((double)info.sh[i][c], sh.c[i][c], 1e-7 * fabs(sh.c[i][c]));
            }
    folder_remove();
}

static void harmonics_in_text_are_checked(void **state)
{
    (void)state;
    static const struct {
        const char *text, *sentence;
    } cases[] = {
        {"{\"bands\": 2, \"coefficients\": [[1,2,3],[1,2,3]]}", "holds 2 complete coefficients"},
        {"{\"bands\": 1, \"coefficients\": [[1,2]]}", "damaged at byte 35"},
        {"{\"bands\": 1", "damaged at byte 11"},
        {"{\"bands\": 1}", "holds 0 complete coefficients"},
        {"1 2 3 ; Y0,0\n1 2\n", "holds 0 complete coefficients"},
        {"1 2 ; Y0,0\n", "holds 0 complete coefficients"},
        {"(1, 2, 3); // L00, irradiance, pre-scaled base\n(1, 2, 3)\n", "holds 0 complete"},
        {"// Spherical harmonics of radiance, 1 bands", "holds 0 complete coefficients"},
        {"// Spherical harmonics of radiance\nx = {\n{1, 2, x},", "holds 0 complete coefficients"},
        {"{\"json\": 1}", "do not begin like"},
        {"// other", "do not begin like"},
    };
    kiln_file_info info;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        kiln_result result = describe(cases[i].text, strlen(cases[i].text), "m.txt", &info);
        if (result != KILN_ERROR_FORMAT || !strstr(error.message, cases[i].sentence))
            fail_msg("%s gives %d: %s", cases[i].text, (int)result, error.message);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cut_files_are_refused),
        cmocka_unit_test(damaged_files_do_no_harm),
        cmocka_unit_test(manifests_are_checked),
        cmocka_unit_test(gltf_is_checked),
        cmocka_unit_test(ktx1_is_checked),
        cmocka_unit_test(faces_beyond_32_bits_are_missed),
        cmocka_unit_test(lines_are_taken_as_far_as_they_make_sense),
        cmocka_unit_test(texts_stand_in_a_png),
        cmocka_unit_test(control_characters_end_a_writers_name),
        cmocka_unit_test(irradiance_is_not_called_radiance),
        cmocka_unit_test(harmonics_in_text_are_described),
        cmocka_unit_test(harmonics_in_text_are_checked),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}

// Files that kiln describes without reading their pixels, in hostile hands: cut off, damaged, and
// made to lie.
#include "codec/engine_text.h"
#include "codec/env.h"
#include "codec/gltf.h"
#include "codec/ktx1.h"

#include "kit/describe.h"

#include "kit/context.h"

enum { ENV, GLB, KTX1, ATLAS, SAMPLES };

static const char *const names[SAMPLES] = {"a.env", "a.glb", "a.ktx", "a.dds"};

static ki_writer make_sample(int which)
{
    ki_writer w = {.context = context};
    kiln_map map = make_steps(context, KILN_SHAPE_CUBE, 16, 0);
    kiln_sh sh = {.bands = 3, .c = {{1, 2, 3}, {0.5, 0, -0.5}}};
    kiln_image atlas = {16, 16, 4, map.level[0], NULL};
    if (which == ENV)
        CHECK_OK(ki_env_encode(&map, 0.8, &sh, &w, &error));
    else if (which == GLB)
        CHECK_OK(ki_gltf_encode(&map, &sh, NULL, &w, &error));
    else if (which == KTX1)
        CHECK_OK(ki_ktx1_encode(&map, &sh, "filament", KILN_FORMAT_RGBA16F, &w, &error));
    else
        CHECK_OK(ki_dds_encode_atlas(&atlas, "playcanvas-dds", &w, &error));
    kiln_map_free(&map);
    return w;
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

static void ktx1_is_checked(void **state)
{
    (void)state;
    static const struct {
        size_t at;
        uint32_t value;
        kiln_result result;
    } cases[] = {{12, 0x01020304, KILN_ERROR_UNSUPPORTED}, // the other byte order
                 {16, 0x1400, KILN_ERROR_UNSUPPORTED},     // signed bytes
                 {36, 15, KILN_ERROR_FORMAT},              // width, not the height
                 {36, 0, KILN_ERROR_FORMAT},
                 {52, 2, KILN_ERROR_UNSUPPORTED}, // faces
                 {56, 6, KILN_ERROR_FORMAT},
                 {56, 17, KILN_ERROR_FORMAT},          // levels
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
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}

// Hostile bytes and missing memory: every decoder returns, says which file, and leaks nothing.
#include "codec/codec.h"
#include "kit/kit.h"

static kiln_error error;

typedef folder_file sample;

enum { MAX_SAMPLES = 128 };
static sample good[MAX_SAMPLES];
static int good_count;

static void add_good(const char *name, const ki_writer *w)
{
    sample *s = &good[good_count++];
    snprintf(s->name, sizeof s->name, "%s", name);
    s->size = w->size;
    s->bytes = malloc(w->size);
    memcpy(s->bytes, w->bytes, w->size);
}

// The files in good/ and one of each kind that kiln writes.
static int make_samples(void **state)
{
    (void)state;
    kiln_context *context = make_context(1);
    good_count = read_folder(KILN_GOOD_FILES, good, MAX_SAMPLES);
    kiln_map map;
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 16, 0, &map, &error));
    for (size_t i = 0; i < kiln_map_texels(&map, 0) * 3; i++)
        map.level[0][i] = (float)(i * i % 1001) / 64;
    ki_writer w = {.context = context};
    ki_exr_options options = {.half = true, .roughness = 1};
    kiln_sh sh = {.bands = 5};
    for (int i = 0; i < 10; i++) {
        w.size = 0;
        kiln_save_def def = {.format = (kiln_format)(1 + i % 4), .sh = &sh, .lobe = "ggx"};
        if (i > 6)
            def.format = i == 9 ? KILN_FORMAT_UASTC : KILN_FORMAT_BC6H;
        def.zstd = i == 1 ? 3 * KILN_TEST_ZSTD : 0;
        static const char *const names[] = {"dds",       "ktx2 zstd", "ktx2", "hdr",
                                            "png grey",  "png rgb",   "exr",  "dds bc6h",
                                            "ktx2 bc6h", "ktx2 uastc"};
        if (i == 0 || i == 7)
            CHECK_OK(ki_dds_encode(&map, &def, &w, &error));
        else if (i < 3 || i > 7)
            CHECK_OK(ki_ktx2_encode(&map, &def, &w, &error));
        else if (i == 3)
            CHECK_OK(ki_hdr_encode(map.level[0], 32, 16, &w, &error));
        else if (i < 6)
            CHECK_OK(ki_png_encode(map.level[0], 32, 16, i == 4 ? 1 : 3, KI_PNG_SRGB8, &w, &error));
        else
            CHECK_OK(ki_exr_encode(map.level[0], 32, 16, 3, &options, &w, &error));
        add_good(names[i], &w);
    }
    const kiln_image image = {32, 16, 2, map.level[0], NULL};
    for (int i = 0; i < 2; i++) {
        w.size = 0;
        CHECK_OK(ki_ktx2_encode_table(&image, i ? 4 : 1, "kind=dfg", (kiln_table_format)(1 + 2 * i),
                                      i ? 3 * KILN_TEST_ZSTD : 0, &w, &error));
        add_good(i ? "ktx2 table zstd" : "ktx2 table", &w);
    }
    ki_writer_free(&w);
    kiln_map_free(&map);
    kiln_context_destroy(context);
    return 0;
}

static int free_samples(void **state)
{
    (void)state;
    for (int i = 0; i < good_count; i++)
        free(good[i].bytes);
    return 0;
}

// Whatever comes of it, nothing is held afterwards, and a failure has a sentence and no output.
static kiln_result decode(kiln_context *context, failing *f, const uint8_t *bytes, size_t size,
                          const char *name)
{
    // In memory that ends where the bytes end, so that checkers see a read behind it.
    uint8_t *exact = malloc(size ? size : 1);
    memcpy(exact, bytes, size);
    ki_decoded decoded;
    error.message[0] = 0;
    kiln_result result = ki_decode(context, exact, size, name, &decoded, NULL, &error);
    if (result != KILN_OK) {
        if (!strstr(error.message, name))
            fail_msg("the sentence does not name the file %s: %s", name, error.message);
        assert_null(decoded.image.owner);
        assert_null(decoded.map.owner);
    }
    ki_decoded_free(&decoded);
    assert_int_equal(f->held, f->idle);
    free(exact);
    return result;
}

static void bad_files_are_refused(void **state)
{
    (void)state;
    static sample bad[MAX_SAMPLES];
    int count = read_folder(KILN_BAD_FILES, bad, MAX_SAMPLES);
    assert_true(count > 60);
    failing f;
    kiln_context *context = failing_context(&f);
    for (int i = 0; i < count; i++) {
        kiln_result result = decode(context, &f, bad[i].bytes, bad[i].size, bad[i].name);
        // Without zstd, what is compressed by it (scheme 2 at byte 44 of a KTX2 file) may be
        // refused as such.
        bool lacks_zstd = !KILN_TEST_ZSTD && strstr(bad[i].name, ".ktx2") && bad[i].size > 44 &&
                          bad[i].bytes[44] == 2 && result == KILN_ERROR_UNSUPPORTED;
        if (result != KILN_ERROR_FORMAT && !lacks_zstd)
            fail_msg("%s gives %d: %s", bad[i].name, (int)result, error.message);
        free(bad[i].bytes);
    }
    kiln_context_destroy(context);
}

static void cut_files_are_refused(void **state)
{
    (void)state;
    failing f;
    kiln_context *context = failing_context(&f);
    for (int i = 0; i < good_count; i++) {
        const sample *s = &good[i];
        assert_int_equal(decode(context, &f, s->bytes, s->size, s->name), KILN_OK);
        size_t step = s->size / 400 + 1;
        for (size_t size = 0; size < s->size; size += step) {
            // Only a PNG's last 12 bytes say nothing about the picture, and its check sums before.
            bool end = !strncmp(s->name, "png", 3) && size + 20 > s->size;
            if (decode(context, &f, s->bytes, size, s->name) == KILN_OK && !end)
                fail_msg("%s is read when cut to %zu of %zu bytes", s->name, size, s->size);
        }
    }
    kiln_context_destroy(context);
}

static void damaged_files_do_no_harm(void **state)
{
    (void)state;
    failing f;
    kiln_context *context = failing_context(&f);
    uint64_t seed = 1;
    for (int i = 0; i < good_count; i++) {
        sample *s = &good[i];
        uint8_t *bytes = malloc(s->size);
        for (int round = 0; round < 300; round++) {
            memcpy(bytes, s->bytes, s->size);
            for (int k = 0; k < 1 + round % 4; k++) {
                uint64_t bits = random_bits(&seed);
                // Half of them in the first 400 bytes, where headers are.
                size_t range = round % 2 && s->size > 400 ? 400 : s->size;
                size_t at = (size_t)(bits >> 8) % range;
                bytes[at] = (uint8_t)(round % 3 ? bytes[at] ^ (1U << (bits & 7)) : bits & 255);
            }
            (void)decode(context, &f, bytes, s->size, s->name);
        }
        free(bytes);
    }
    kiln_context_destroy(context);
}

// A call, repeated with its first, second, third ... allocation failing until none does.
typedef kiln_result attempt(kiln_context *context, const char *path);

static void check_allocations(const char *what, attempt *call, const char *path)
{
    long most = 0;
    for (long n = 1;; n++) {
        failing f;
        kiln_context *context = failing_context(&f);
        f.calls = 0;
        f.fail_at = n;
        kiln_result result = call(context, path);
        if (f.held != f.idle)
            fail_msg("%s leaks %ld blocks when allocation %ld fails", what, f.held - f.idle, n);
        bool reached = f.calls >= n;
        kiln_context_destroy(context);
        if (!reached) {
            if (result != KILN_OK)
                fail_msg("%s: %s", what, error.message);
            break;
        }
        if (result != KILN_ERROR_MEMORY)
            fail_msg("%s gives %d when allocation %ld fails: %s", what, (int)result, n,
                     error.message);
        most = n;
    }
    assert_true(most >= 1);
}

static const sample *decoded_sample;

static kiln_result decode_sample(kiln_context *context, const char *path)
{
    (void)path;
    kiln_map map;
    kiln_load_def def = {.layout = KILN_LAYOUT_AUTO};
    kiln_result result = kiln_map_decode(context, decoded_sample->bytes, decoded_sample->size,
                                         decoded_sample->name, &def, &map, &error);
    kiln_map_free(&map);
    // That it is no panorama is known after it was read.
    bool flat = result == KILN_ERROR_FORMAT && strstr(error.message, "sides must be");
    bool table = result == KILN_ERROR_UNSUPPORTED && strstr(error.message, "holds a table");
    return flat || table ? KILN_OK : result;
}

static void decoding_survives_missing_memory(void **state)
{
    (void)state;
    for (int i = 0; i < good_count; i++) {
        decoded_sample = &good[i];
        check_allocations(good[i].name, decode_sample, NULL);
    }
}

static kiln_result save(kiln_context *context, const char *path)
{
    // The map is made by another context, whose memory does not fail.
    kiln_context *other = make_context(1);
    kiln_map map = make_map(other, KILN_SHAPE_CUBE, 4, 1);
    kiln_sh sh = {.bands = 3};
    kiln_save_def def = {
        .zstd = strstr(path, "zstd") ? 3 * KILN_TEST_ZSTD : 0, .sh = &sh, .lobe = "ggx"};
    kiln_result result = kiln_map_save(context, &map, path, &def, NULL, &error);
    kiln_map_free(&map);
    kiln_context_destroy(other);
    return result;
}

static kiln_result save_sh(kiln_context *context, const char *path)
{
    kiln_sh sh = {.bands = 3};
    return kiln_sh_save(context, &sh, path, &error);
}

static kiln_result save_image(kiln_context *context, const char *path)
{
    float pixels[12] = {0};
    kiln_image image = {2, 2, 3, pixels, NULL};
    return kiln_image_save(context, &image, path, &error);
}

static kiln_result save_table(kiln_context *context, const char *path)
{
    float pixels[24] = {0};
    kiln_table table = {{.kind = KILN_TABLE_DFG, .width = 4, .height = 3, .depth = 1},
                        {4, 3, 2, pixels, NULL}};
    kiln_table_save_def def = {.zstd = strstr(path, "zstd") ? 3 * KILN_TEST_ZSTD : 0};
    return kiln_table_save(context, &table, path, &def, &error);
}

static kiln_result save_lookup(kiln_context *context, const char *path)
{
    const kiln_table_def def = {.width = 4, .height = 3, .depth = 1};
    return kiln_table_lookup_save(context, &def, path, NULL, &error);
}

static kiln_result load_table(kiln_context *context, const char *path)
{
    kiln_table table;
    kiln_result result = kiln_table_load(context, path, &table, &error);
    kiln_table_free(&table);
    return result;
}

static kiln_result load(kiln_context *context, const char *path)
{
    kiln_map map;
    kiln_result result = kiln_map_load(context, path, NULL, &map, &error);
    kiln_map_free(&map);
    return result;
}

static kiln_result describe(kiln_context *context, const char *path)
{
    kiln_file_info info;
    return kiln_file_describe(context, path, &info, &error);
}

static void files_survive_missing_memory(void **state)
{
    (void)state;
    folder_make();
    static const struct {
        const char *name;
        attempt *call;
    } calls[] = {{"a.ktx2", save},
                 {"zstd.ktx2", save},
                 {"a.dds", save},
                 {"f/", save},
                 {"b.hdr", save},
                 {"c.png", save},
                 {"a.json", save_sh},
                 {"a.txt", save_sh},
                 {"a.h", save_sh},
                 {"i.exr", save_image},
                 {"i.hdr", save_image},
                 {"i.png", save_image},
                 {"a.ktx2", load},
                 {"f", load},
                 {"f/{face}.exr", load},
                 {"f/px.exr", describe},
                 {"a.ktx2", describe},
                 {"t.ktx2", save_table},
                 {"t-zstd.ktx2", save_table},
                 {"t.exr", save_table},
                 {"t.hdr", save_table},
                 {"t.png", save_table},
                 {"t.raw", save_table},
                 {"t.h", save_table},
                 {"t.glsl", save_table},
                 {"l.h", save_lookup},
                 {"l.glsl", save_lookup},
                 {"t.ktx2", load_table},
                 {"t-zstd.ktx2", load_table}};
    for (size_t i = 0; i < sizeof calls / sizeof *calls; i++) {
        char path[128];
        snprintf(path, sizeof path, "%s", in_folder(calls[i].name));
        check_allocations(calls[i].name, calls[i].call, path);
    }
    folder_remove();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_files_are_refused),
        cmocka_unit_test(cut_files_are_refused),
        cmocka_unit_test(damaged_files_do_no_harm),
        cmocka_unit_test(decoding_survives_missing_memory),
        cmocka_unit_test(files_survive_missing_memory),
    };
    return cmocka_run_group_tests(tests, make_samples, free_samples);
}

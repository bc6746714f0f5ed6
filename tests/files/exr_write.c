// OpenEXR files as they are written: what kiln writes comes back, is the same by any number of
// threads, needs no more memory than there is, and can be stopped.
#include "codec/codec.h"
#include "image/pack.h"

#include "kit/context.h"

// What is written is read, by OpenEXRCore's header and by our reader.
static void what_is_written_comes_back(void **state)
{
    (void)state;
    enum { W = 45, H = 37 };
    float pixels[W * H * 4];
    uint64_t seed = 1;
    for (int i = 0; i < W * H * 4; i++)
        pixels[i] = (float)random_between(&seed, 0, 4);
    for (int channels = 1; channels <= 4; channels++)
        for (int half = 0; half < 2; half++) {
            ki_writer w = {.context = context};
            ki_exr_options options = {.half = half, .panorama = true, .roughness = 0.25f};
            CHECK_OK(ki_exr_encode(pixels, W, H, channels, &options, &w, &error));
            ki_decoded decoded;
            kiln_file_info info;
            CHECK_OK(ki_decode(context, w.bytes, w.size, "back.exr", &decoded, &info, &error));
            assert_string_equal(info.writer, "kiln 0.2.0");
            CHECK_NEAR((double)info.roughness[0], 0.25, 0);
            for (int i = 0; i < W * H; i++)
                for (int c = 0; c < 3; c++) {
                    // One channel is grey, of two there is no blue.
                    int from = channels == 1 ? 0 : c;
                    float wanted = from < channels ? pixels[i * channels + from] : 0;
                    wanted = half ? ki_float_from_half(ki_half_from_float(wanted)) : wanted;
                    assert_true(decoded.image.pixels[3 * i + c] == wanted);
                }
            ki_decoded_free(&decoded);
            ki_writer_free(&w);
        }
}

// Smooth in the first lines, then noise, which does not become smaller and is stored as it is.
static float half_noise(uint32_t i, uint32_t count)
{
    uint32_t noise = i * 2654435761U;
    noise = (noise ^ noise >> 15) * 2246822519U;
    return i < count / 2 ? (float)i / (float)count : (float)(noise >> 8) / 256 + 1;
}

// Encodes a picture of 21 chunks, the last of 5 lines, by a context of its own.
static kiln_result encode_by(const kiln_context_def *def, bool half, ki_writer *w, size_t *peak)
{
    enum { W = 70, H = 20 * 16 + 5, COUNT = W * H * 3 };
    static float pixels[COUNT];
    for (uint32_t i = 0; i < COUNT; i++)
        pixels[i] = half_noise(i, COUNT);
    kiln_context *own;
    CHECK_OK(kiln_context_create(def, &own, &error));
    *w = (ki_writer){.context = own};
    ki_exr_options options = {.half = half, .roughness = -1};
    kiln_result result = ki_exr_encode(pixels, W, H, 3, &options, w, &error);
    size_t held;
    kiln_context_memory(own, &held, peak);
    assert_int_equal(held, w->bytes ? ki_block_size(w->capacity, 1) : 0); // only the file is left
    kiln_context_destroy(own);
    return result;
}

static void check_same_file(const kiln_context_def *def, bool half, const ki_writer *wanted)
{
    ki_writer w;
    CHECK_OK(encode_by(def, half, &w, NULL));
    assert_int_equal(w.size, wanted->size);
    assert_memory_equal(w.bytes, wanted->bytes, w.size);
    ki_writer_free(&w);
}

static void a_file_is_the_same_by_any_number_of_threads(void **state)
{
    (void)state;
    static const int threads[] = {2, 3, 7, 40}; // 40 threads are more than there are chunks
    for (int half = 0; half < 2; half++) {
        ki_writer one;
        CHECK_OK(encode_by(&(kiln_context_def){.thread_count = 1}, half, &one, NULL));
        for (size_t i = 0; i < sizeof threads / sizeof *threads; i++)
            check_same_file(&(kiln_context_def){.thread_count = threads[i]}, half, &one);
        ki_writer_free(&one);
    }
}

// What a single thread needs is enough for any number of threads. A little less is refused.
static void threads_ask_for_no_more_memory_than_there_is(void **state)
{
    (void)state;
    ki_writer one, none;
    size_t peak, all;
    CHECK_OK(encode_by(&(kiln_context_def){.thread_count = 1}, true, &one, &peak));
    kiln_context_def def = {.thread_count = 7};
    CHECK_OK(encode_by(&def, true, &none, &all));
    ki_writer_free(&none);
    CHECK_BELOW(2.0 * (double)peak, (double)all); // without a limit the threads take more
    for (size_t i = 0; i <= 40; i++) {
        def.memory_limit = peak + i * (all - peak) / 40;
        check_same_file(&def, true, &one);
    }
    def.memory_limit = peak - 1;
    assert_int_equal(encode_by(&def, true, &none, NULL), KILN_ERROR_MEMORY);
    CHECK_SAYS(error.message, "out of memory: an EXR file: ");
    ki_writer_free(&none);
    ki_writer_free(&one);
}

static void writing_by_threads_can_be_stopped(void **state)
{
    (void)state;
    countdown c = {.left = 1};
    kiln_context_def def = {.thread_count = 3, .progress = count_down, .progress_user = &c};
    ki_writer w;
    assert_int_equal(encode_by(&def, true, &w, NULL), KILN_ERROR_CANCELLED);
    assert_string_equal(error.message, "stopped while writing");
    assert_int_equal(c.calls, 2);
    ki_writer_free(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(what_is_written_comes_back, set_up, tear_down),
        cmocka_unit_test(a_file_is_the_same_by_any_number_of_threads),
        cmocka_unit_test(threads_ask_for_no_more_memory_than_there_is),
        cmocka_unit_test(writing_by_threads_can_be_stopped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

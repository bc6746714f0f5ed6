// What holds for every format of blocks of 4 x 4 texels: the same bits on every machine, and
// pictures of any size. The encoder of UASTC HDR gives up some accuracy for blocks that are
// accurate after conversion to BC6H.
#include "codec/bc6h.h"
#include "codec/uastc.h"
#include "kit/kit.h"

static const struct {
    const char *name;
    bool (*encode)(kiln_context *context, const float *rgb, int width, int height,
                   int picture_count, uint8_t *bytes);
    void (*decode)(const uint8_t *bytes, int width, int height, float *rgb);
    double off, rms; // largest relative error of a slope's texel, and largest RMS error of a slope
} formats[] = {{"bc6h", ki_bc6h_encode, ki_bc6h_decode, 0.02, 0.006},
               {"uastc", ki_uastc_encode, ki_uastc_decode, 0.03, 0.0135}};
enum { FORMATS = sizeof formats / sizeof *formats };

static void make_picture(int width, int height, float *rgb)
{
    uint64_t seed = 3;
    for (int i = 0; i < width * height * 3; i++) {
        int x = i / 3 % width, y = i / 3 / width;
        rgb[i] =
            (float)exp2((double)(random_bits(&seed) % 4000) / 1000 + sin(x / 9.0) + cos(y / 7.0));
    }
    rgb[0] = -1;
    rgb[1] = NAN;
    rgb[2] = INFINITY;
}

static void same_bits_for_every_machine_and_thread_count(void **state)
{
    (void)state;
    enum { WIDTH = 57, HEIGHT = 35, FACES = 2 };
    static float rgb[3 * WIDTH * HEIGHT * FACES];
    for (int f = 0; f < FACES; f++)
        make_picture(WIDTH, HEIGHT, rgb + (size_t)(3 * WIDTH * HEIGHT * f));
    size_t size = FACES * ki_blocks_size(WIDTH, HEIGHT);
    assert_int_equal(size, FACES * 15 * 9 * 16);
    uint8_t *first = calloc(size, 1), *next = calloc(size, 1);
    for (int n = 0; n < FORMATS; n++) {
        print_message("%s\n", formats[n].name);
        for (int cpu = KILN_CPU_SCALAR; cpu <= KILN_CPU_AVX512; cpu++)
            for (int threads = 1; threads <= 5; threads += 2) {
                kiln_context *context = make_context_for(threads, (enum kiln_cpu)cpu);
                bool begin = cpu == KILN_CPU_SCALAR && threads == 1;
                uint8_t *bytes = begin ? first : next;
                assert_true(formats[n].encode(context, rgb, WIDTH, HEIGHT, FACES, bytes));
                assert_memory_equal(first, bytes, size);
                kiln_context_destroy(context);
            }
    }
    assert_int_equal(ki_uastc_first_unknown(first, size / 16), size / 16);
    free(first);
    free(next);
}

// Texels beyond the edge cost nothing: sizes that are no multiples of 4 come back as well as
// others.
static void any_size_comes_back(void **state)
{
    (void)state;
    kiln_context *context = make_context(0);
    for (int n = 0; n < FORMATS; n++)
        for (int height = 1; height <= 6; height++)
            for (int width = 1; width <= 9; width++) {
                float rgb[3 * 54], back[3 * 54];
                uint8_t bytes[3 * 2 * 16];
                for (int i = 0; i < width * height; i++)
                    for (int c = 0; c < 3; c++) {
                        int rise = (c + 1) * (i % width + i / width);
                        rgb[3 * i + c] = 2 + (float)rise / 16;
                    }
                assert_int_equal(ki_blocks_size(width, height),
                                 (width + 3) / 4 * ((height + 3) / 4) * 16);
                assert_true(formats[n].encode(context, rgb, width, height, 1, bytes));
                formats[n].decode(bytes, width, height, back);
                double square = 0;
                for (int i = 0; i < 3 * width * height; i++) {
                    double off = (double)back[i] / (double)rgb[i] - 1;
                    CHECK_BELOW(fabs(off), formats[n].off);
                    square += off * off / (3 * width * height);
                }
                CHECK_BELOW(sqrt(square), formats[n].rms);
            }
    kiln_context_destroy(context);
}

// A block is a dim sky, but for one texel, which is a sun up to 2^20 times as bright. The sky must be
// decoded with a relative error of at most an eighth. Both formats store the ends of lines that reach
// so far in steps of up to 11 %.
static void a_sky_beside_a_sun_stays_dark(void **state)
{
    (void)state;
    static const float sun[3] = {60000, 55000, 45000};
    kiln_context *context = make_context(0);
    for (int n = 0; n < FORMATS; n++)
        for (int at = 0; at < 16; at++)
            for (int dim = 0; dim < 3; dim++) {
                float rgb[48], back[48];
                uint8_t bytes[16];
                for (int i = 0; i < 48; i++) {
                    float sky = 0.25f + 0.1f * (float)(i % 3) + 0.002f * (float)(i / 3);
                    rgb[i] = i / 3 == at ? sun[i % 3] : sky / (float)(1 << dim);
                }
                assert_true(formats[n].encode(context, rgb, 4, 4, 1, bytes));
                formats[n].decode(bytes, 4, 4, back);
                for (int i = 0; i < 48; i++)
                    CHECK_NEAR(back[i] / rgb[i], 1, 0.125);
            }
    kiln_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_bits_for_every_machine_and_thread_count),
        cmocka_unit_test(any_size_comes_back),
        cmocka_unit_test(a_sky_beside_a_sun_stays_dark),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

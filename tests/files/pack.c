// Small floats against brute force, in double precision.
#include "image/pack.h"
#include "kit/kit.h"

static float from_bits(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

// The value of a float of 5 exponent bits and `m` mantissa bits, by its definition.
static double small_value(uint32_t bits, int m)
{
    int exponent = (int)(bits >> m);
    double mantissa = (double)(bits & ((1U << m) - 1)) / (1 << m);
    return exponent ? ldexp(1 + mantissa, exponent - 15) : ldexp(mantissa, -14);
}

static void every_half_comes_back(void **state)
{
    (void)state;
    for (uint32_t h = 0; h < 65536; h++) {
        float value = ki_float_from_half((uint16_t)h);
        uint32_t magnitude = h & 0x7fff;
        if (magnitude > 0x7c00) {
            assert_true(isnan(value));
            assert_int_equal(ki_half_from_float(value), 0);
        } else if (magnitude == 0x7c00) {
            assert_true(isinf(value));
            assert_int_equal(ki_half_from_float(value), (h & 0x8000) | 0x7bff);
        } else {
            CHECK_NEAR((double)value, (h & 0x8000 ? -1 : 1) * small_value(magnitude, 10), 0);
            assert_int_equal(signbit(value) != 0, h >> 15);
            assert_int_equal(ki_half_from_float(value), h);
        }
    }
}

// Between two neighbours: the nearer one, and in the middle the even one.
static void check_between(uint32_t low, int m, uint32_t (*pack)(float))
{
    double a = small_value(low, m), b = small_value(low + 1, m);
    float middle = (float)((a + b) / 2);
    assert_int_equal(pack((float)a), low);
    assert_int_equal(pack(middle), low + (low & 1));
    assert_int_equal(pack(nextafterf(middle, 0)), low);
    assert_int_equal(pack(nextafterf(middle, 1e9F)), low + 1);
}

static uint32_t pack_half(float value)
{
    return ki_half_from_float(value);
}

static uint32_t pack_red(float value)
{
    return ki_b10g11r11_from_float((const float[3]){value, 0, 0}) & 0x7ff;
}

static uint32_t pack_green(float value)
{
    return ki_b10g11r11_from_float((const float[3]){0, value, 0}) >> 11 & 0x7ff;
}

static uint32_t pack_blue(float value)
{
    return ki_b10g11r11_from_float((const float[3]){0, 0, value}) >> 22;
}

static void packing_rounds_to_nearest_even(void **state)
{
    (void)state;
    for (uint32_t h = 0; h < 0x7bff; h++)
        check_between(h, 10, pack_half);
    for (uint32_t h = 0; h < 0x7bf; h++) {
        check_between(h, 6, pack_red);
        check_between(h, 6, pack_green);
    }
    for (uint32_t h = 0; h < 0x3df; h++)
        check_between(h, 5, pack_blue);
    for (uint32_t i = 0; i < 2048; i++) {
        float rgb[3];
        ki_float_from_b10g11r11(i | (i >> 1) << 22 | i << 11, rgb);
        if (i >> 6 < 31) {
            CHECK_NEAR((double)rgb[0], small_value(i, 6), 0);
            CHECK_NEAR((double)rgb[1], small_value(i, 6), 0);
            CHECK_NEAR((double)rgb[2], small_value(i >> 1, 5), 0);
        }
    }
}

static void what_is_outside_is_clamped(void **state)
{
    (void)state;
    const float strange[3] = {NAN, -3, INFINITY};
    float rgb[3];
    ki_float_from_b10g11r11(ki_b10g11r11_from_float(strange), rgb);
    assert_true(rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 64512);
    ki_float_from_rgb9e5(ki_rgb9e5_from_float(strange), rgb);
    assert_true(rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 65408);
    assert_int_equal(pack_red(1e20F), 0x7bf);
    assert_int_equal(ki_half_from_float(1e20F), 0x7bff);
    assert_int_equal(ki_half_from_float(-1e20F), 0xfbff);
    assert_int_equal(ki_half_from_float(65519.996F), 0x7bff);
}

static double shared_value(uint32_t mantissa, uint32_t exponent)
{
    return ldexp((double)mantissa, (int)exponent - 24);
}

// The exponent is the smallest that holds the largest channel, and each mantissa the nearest one.
static void shared_exponents_are_nearest(void **state)
{
    (void)state;
    uint64_t seed = 12345;
    for (int i = 0; i < 200000; i++) {
        float rgb[3], back[3];
        for (int c = 0; c < 3; c++) {
            uint32_t exponent = 95 + (uint32_t)(random_bits(&seed) % 50); // 2^-32 to 2^17
            rgb[c] = from_bits(exponent << 23 | (uint32_t)(random_bits(&seed) & 0x7fffff));
            if (i % 3 == 0) // close to where mantissas carry
                rgb[c] =
                    from_bits(exponent << 23 | (uint32_t)(0x7fffff - random_bits(&seed) % 0x10000));
        }
        uint32_t packed = ki_rgb9e5_from_float(rgb), exponent = packed >> 27;
        ki_float_from_rgb9e5(packed, back);
        uint32_t largest = 0;
        double most = 0;
        for (int c = 0; c < 3; c++) {
            uint32_t mantissa = packed >> (9 * c) & 511;
            double value = (double)rgb[c] < 65408 ? (double)rgb[c] : 65408;
            CHECK_NEAR((double)back[c], shared_value(mantissa, exponent), 0);
            double best = fabs(shared_value(mantissa, exponent) - value);
            double step = shared_value(1, exponent);
            assert_true(best <= step / 2);
            if (best == step / 2)
                assert_int_equal(mantissa % 2, 0);
            largest = mantissa > largest ? mantissa : largest;
            most = value > most ? value : most;
        }
        // With the next smaller exponent the largest would not fit any more.
        if (exponent > 0) {
            assert_true(largest >= 256);
            assert_true(most >=
                        shared_value(511, exponent - 1) + shared_value(1, exponent - 1) / 2);
        }
    }
}

static void texels_pack_as_single_values_do(void **state)
{
    (void)state;
    enum { COUNT = 1000, RGB = COUNT * 3, RGBA = COUNT * 4 };
    static float rgb[RGB], values[RGB];
    static uint16_t rgba[RGBA], halfs[RGB];
    uint64_t seed = 99;
    for (int i = 0; i < RGB; i++)
        rgb[i] = from_bits((uint32_t)random_bits(&seed));
    static const size_t counts[] = {0, 1, 3, 63, 64, 65, COUNT};
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        memset(rgba, 0xab, sizeof rgba);
        ki_pack_rgba16f(rgb, counts[k], rgba);
        for (size_t i = 0; i < counts[k] * 4; i++)
            assert_int_equal(rgba[i],
                             i % 4 == 3 ? 0x3c00 : ki_half_from_float(rgb[i / 4 * 3 + i % 4]));
        for (size_t i = counts[k] * 4; i < RGBA; i++)
            assert_int_equal(rgba[i], 0xabab);
    }
    static uint32_t words[COUNT];
    static void (*const pack[2])(const float *, size_t, uint32_t *) = {ki_pack_rgb9e5,
                                                                       ki_pack_b10g11r11};
    static uint32_t (*const pack_one[2])(const float *) = {ki_rgb9e5_from_float,
                                                           ki_b10g11r11_from_float};
    for (int format = 0; format < 2; format++)
        for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
            memset(words, 0xab, sizeof words);
            pack[format](rgb, counts[k], words);
            for (size_t i = 0; i < COUNT; i++)
                assert_int_equal(words[i],
                                 i < counts[k] ? pack_one[format](rgb + 3 * i) : 0xabababab);
        }
    ki_halfs_from_floats(rgb, RGB, halfs);
    ki_floats_from_halfs(halfs, RGB, values);
    for (int i = 0; i < RGB; i++) {
        assert_int_equal(halfs[i], ki_half_from_float(rgb[i]));
        float wanted = ki_float_from_half(halfs[i]);
        assert_memory_equal(&values[i], &wanted, 4);
    }
}

// IEC 61966-2-1, with libm's pow.
static void srgb_is_the_standards_curve(void **state)
{
    (void)state;
    for (int i = 0; i < 65536; i++) {
        double v = (double)((float)i / 65535);
        double linear = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
        double curved = v <= 0.0031308 ? v * 12.92 : 1.055 * pow(v, 1 / 2.4) - 0.055;
        CHECK_NEAR((double)ki_linear_from_srgb((float)v), linear, linear * 6e-8);
        CHECK_NEAR((double)ki_srgb_from_linear((float)v), curved, curved * 6e-8);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_half_comes_back),
        cmocka_unit_test(packing_rounds_to_nearest_even),
        cmocka_unit_test(what_is_outside_is_clamped),
        cmocka_unit_test(shared_exponents_are_nearest),
        cmocka_unit_test(texels_pack_as_single_values_do),
        cmocka_unit_test(srgb_is_the_standards_curve),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

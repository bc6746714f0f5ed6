// Radiance in four bytes, as it comes back.
#include "codec/rgbx.h"
#include "kit/kit.h"

typedef struct coding {
    void (*pack)(const float rgb[3], float packed[4]);
    void (*unpack)(const float packed[4], float rgb[3]);
    double largest, power;
} coding;

static const coding codings[] = {
    {ki_rgbm_from_float, ki_float_from_rgbm, KI_RGBM_MAX, 2},
    {ki_rgbp_from_float, ki_float_from_rgbp, KI_RGBP_MAX, 2},
    {ki_rgbd_from_float, ki_float_from_rgbd, KI_RGBD_MAX, 2.2},
};
enum { CODINGS = sizeof codings / sizeof *codings };

// As a PNG of 8 bits has it.
static void store(const float packed[4], float stored[4])
{
    for (int c = 0; c < 4; c++) {
        assert_true(packed[c] >= 0 && packed[c] <= 1);
        stored[c] = floorf(packed[c] * 255 + 0.5f) / 255;
    }
}

// What radiance the colours are shares of; with `less`, by the alpha that makes it smaller next, 0
// where there is none.
static double scale_of(const coding *k, const float packed[4], int less)
{
    float full[4] = {1, 1, 1, packed[3]}, rgb[3];
    float step = (float)less / 255;
    full[3] += k->unpack == ki_float_from_rgbm ? -step : step;
    if (less && (full[3] < 0.5f / 255 || full[3] > 1.001f))
        return 0;
    k->unpack(full, rgb);
    return (double)rgb[0];
}

static double root(const coding *k, double value)
{
    return pow(value, 1 / k->power);
}

// Each channel's root is as near as 8 bits of its scale's allow, and no smaller scale holds the
// texel.
static void roots_come_back_to_half_a_step(void **state)
{
    (void)state;
    uint64_t seed = 1;
    for (int i = 0; i < CODINGS * 200000; i++) {
        const coding *k = &codings[i % CODINGS];
        float rgb[3], packed[4], stored[4], back[3];
        double most = 0;
        for (int c = 0; c < 3; c++) {
            rgb[c] = (float)(k->largest * pow(2, -(double)(random_bits(&seed) % 20000) / 1000));
            most = fmax(most, (double)rgb[c]);
        }
        k->pack(rgb, packed);
        store(packed, stored);
        CHECK_NEAR((double)stored[3], (double)packed[3], 1e-7);
        k->unpack(stored, back);
        double scale = root(k, scale_of(k, packed, 0));
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(root(k, (double)back[c]), root(k, (double)rgb[c]), scale * 0.50001 / 255);
        CHECK_BELOW(scale_of(k, packed, 1), most * 1.00001);
    }
}

// The largest channel errs by less than 1 % from 1 up: of its root by 1/510 of the scale, which is
// above the root by one step of alpha at most, and for RGBD twice the radiance at most.
static void bright_channels_are_good(void **state)
{
    (void)state;
    for (int i = 0; i < CODINGS; i++) {
        const coding *k = &codings[i];
        for (int n = 0; n <= 100000; n++) {
            double value = exp2(log2(k->largest) * n / 100000);
            float rgb[3] = {(float)value, 0, (float)value / 2}, packed[4], stored[4], back[3];
            k->pack(rgb, packed);
            store(packed, stored);
            k->unpack(stored, back);
            CHECK_NEAR((double)back[0] / value, 1, 0.006);
            assert_true(back[1] == 0);
        }
    }
}

static void ends_are_exact(void **state)
{
    (void)state;
    for (int i = 0; i < CODINGS; i++) {
        const coding *k = &codings[i];
        const float ends[3] = {0, (float)k->largest, 1e30F};
        for (int e = 0; e < 3; e++) {
            float rgb[3] = {ends[e], ends[e], ends[e]}, packed[4], stored[4], back[3];
            k->pack(rgb, packed);
            store(packed, stored);
            k->unpack(stored, back);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR((double)back[c], e ? k->largest : 0, 1e-4);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roots_come_back_to_half_a_step),
        cmocka_unit_test(bright_channels_are_good),
        cmocka_unit_test(ends_are_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

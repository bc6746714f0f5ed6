// UASTC HDR: its bits, what is decoded, and how near the encoder comes.
#include "codec/uastc.h"

#include "codec/bc6h.h"
#include "image/pack.h"
#include "kit/kit.h"

static kiln_error error;

enum { TEXELS = 16, CODES = 0x7c00 };

// -------------------------------------------------------------------------------------------- bits

// Sets a block to random content of a mode that ki_uastc_unpack takes.
static void random_block(uint64_t *seed, int mode, ki_uastc_block *b)
{
    uint8_t bytes[16];
    ki_uastc_block back;
    do {
        *b = (ki_uastc_block){.mode = mode};
        const ki_uastc_mode *m = &ki_uastc_modes[mode];
        b->partition = m->subsets == 2 ? (int)(random_bits(seed) % KI_UASTC_PARTITIONS) : 0;
        for (int s = 0; s < m->subsets; s++)
            for (int i = 0; i < (m->ends == 11 ? 6 : 4); i++)
                b->value[s][i] =
                    (uint8_t)ki_uastc_quantize((int)(random_bits(seed) % 256), m->values, 0);
        for (int i = 0; i < TEXELS; i++)
            b->index[i] = (uint8_t)(random_bits(seed) % ki_uastc_levels[m->weights]);
        ki_uastc_pack(b, bytes);
    } while (!ki_uastc_unpack(bytes, &back));
}

// Every field of every mode comes back, and the block's other bits stay 0.
static void every_mode_comes_back(void **state)
{
    (void)state;
    uint64_t seed = 7;
    for (int n = 0; n < 500 * KI_UASTC_MODES; n++) {
        ki_uastc_block b, back;
        uint8_t bytes[16], again[16];
        random_block(&seed, n % KI_UASTC_MODES, &b);
        ki_uastc_pack(&b, bytes);
        assert_true(ki_uastc_unpack(bytes, &back));
        assert_memory_equal(&b, &back, sizeof b);
        ki_uastc_pack(&back, again);
        assert_memory_equal(bytes, again, 16);
    }
}

// Whatever 128 bits say: the block is refused, or it is one whose colours are finite and whose
// content, written again, decodes to the same texels. Heads of valid modes are put before three
// quarters of the blocks, since random bits are hardly ever a block.
static void any_bits_are_refused_or_decoded(void **state)
{
    (void)state;
    uint64_t seed = 3;
    int taken = 0, seen[24] = {0};
    for (int n = 0; n < 200000; n++) {
        uint8_t bytes[16], again[16];
        ki_uastc_block b;
        float rgb[TEXELS][3], back[TEXELS][3];
        for (int i = 0; i < 16; i++)
            bytes[i] = (uint8_t)(random_bits(&seed) >> 8);
        if (n % 4) {
            uint8_t head[16];
            random_block(&seed, n % KI_UASTC_MODES, &b);
            ki_uastc_pack(&b, head);
            memcpy(bytes, head, 3);
            bytes[3] = head[3] & 0x1f ? head[3] : bytes[3];
        }
        ki_uastc_decode(bytes, 4, 4, rgb[0]);
        bool known = ki_uastc_unpack(bytes, &b);
        assert_int_equal(ki_uastc_first_unknown(bytes, 1), known);
        for (int i = 0; i < 3 * TEXELS; i++)
            assert_true(rgb[i / 3][i % 3] >= 0 && rgb[i / 3][i % 3] <= (known ? 65504 : 0));
        if (!known)
            continue;
        ki_uastc_pack(&b, again);
        ki_uastc_decode(again, 4, 4, back[0]);
        assert_memory_equal(rgb, back, sizeof rgb);
        taken++;
        seen[b.mode]++;
    }
    assert_true(taken > 20000);
    for (int m = 0; m < KI_UASTC_MODES; m++)
        assert_true(seen[m] > 0);
}

// The rule by which ASTC makes partitions from their numbers, from "ASTC partition pattern
// generation" of the Khronos Data Format Specification, for two subsets of small blocks.
static int subset_of(uint32_t number, int x, int y)
{
    uint32_t r = number + 1024;
    r ^= r >> 15;
    r *= 0xeede0891U;
    r ^= r >> 5;
    r += r << 16;
    r ^= r >> 7;
    r ^= r >> 3;
    r ^= r << 6;
    r ^= r >> 17;
    int seed[4], shift[2];
    for (int i = 0; i < 4; i++)
        seed[i] = (int)((r >> (4 * i)) & 15) * (int)((r >> (4 * i)) & 15);
    int even = number & 2 ? 4 : 5;
    shift[0] = number & 1 ? even : 5;
    shift[1] = number & 1 ? 5 : even;
    for (int i = 0; i < 4; i++)
        seed[i] >>= shift[i % 2];
    int a = seed[0] * 2 * x + seed[1] * 2 * y + (int)(r >> 14);
    int b = seed[2] * 2 * x + seed[3] * 2 * y + (int)(r >> 10);
    return (a & 63) < (b & 63);
}

static void partitions_are_those_of_astc(void **state)
{
    (void)state;
    for (int p = 0; p < KI_UASTC_PARTITIONS; p++)
        for (int i = 0; i < TEXELS; i++)
            assert_int_equal(ki_uastc_mask(p) >> i & 1,
                             subset_of(ki_uastc_partitions[p].number, i % 4, i / 4));
}

// ---------------------------------------------------------------------------------------- encoding

// What becomes of a block given as half floats' bits.
static int there_and_back(int code[TEXELS][3], int back[TEXELS][3])
{
    float rgb[TEXELS][3], out[TEXELS][3];
    uint8_t bytes[16];
    ki_uastc_block b;
    for (int i = 0; i < TEXELS; i++)
        for (int c = 0; c < 3; c++)
            rgb[i][c] = ki_float_from_half((uint16_t)code[i][c]);
    ki_uastc_row_scalar(rgb[0], 4, 4, 0, bytes);
    assert_true(ki_uastc_unpack(bytes, &b));
    ki_uastc_decode(bytes, 4, 4, out[0]);
    for (int i = 0; i < TEXELS; i++)
        for (int c = 0; c < 3; c++)
            back[i][c] = ki_half_from_float(out[i][c]);
    return b.mode;
}

// Denormal numbers, 0 and 65504 among them.
static void constant_blocks_are_exact(void **state)
{
    (void)state;
    for (int n = 0; n < CODES; n++) {
        int code[TEXELS][3], back[TEXELS][3];
        for (int i = 0; i < TEXELS; i++) {
            code[i][0] = n;
            code[i][1] = (int)((unsigned)n * 7919U % CODES);
            code[i][2] = CODES - 1 - n;
        }
        assert_int_equal(there_and_back(code, back), KI_UASTC_SOLID);
        assert_memory_equal(code, back, sizeof code);
    }
}

// A slope along a line. Weights step by up to 6/64 of the rise, so that a texel errs by half of
// that; ends err by half a step of the coarsest layout that stores such colours (8 of the 128
// numbers for each factor of two, that is 64 half floats), and by as much again where 192 values
// round them.
static void gradients_err_by_half_a_step(void **state)
{
    (void)state;
    for (int rise = 0; rise <= 1500; rise++)
        for (int way = 0; way < 3; way++) {
            int code[TEXELS][3], back[TEXELS][3];
            for (int i = 0; i < TEXELS; i++) {
                int at = way == 0 ? i % 4 : way == 1 ? i / 4 : i % 4 + i / 4;
                for (int c = 0; c < 3; c++)
                    code[i][c] = 14000 + 700 * c + at * rise / (way == 2 ? 6 : 3);
            }
            there_and_back(code, back);
            for (int i = 0; i < TEXELS; i++)
                for (int c = 0; c < 3; c++)
                    CHECK_NEAR(back[i][c], code[i][c], rise * 6 / 128.0 + 64);
        }
}

static double relative(int a, int b)
{
    double x = (double)ki_float_from_half((uint16_t)a), y = (double)ki_float_from_half((uint16_t)b);
    return fabs(x - y) / fmax(x, 1e-9);
}

// One bright texel among dark ones, as the sun is. Layouts that reach so far store red and green by
// 8 numbers for each factor of two and blue by 4: the texel errs by half a step. The numbers are
// not quite logarithmic: 8 steps are 10.5 % apart at most.
static void a_bright_texel_keeps_its_light(void **state)
{
    (void)state;
    uint64_t seed = 21;
    for (int n = 0; n < 2000; n++) {
        int code[TEXELS][3], back[TEXELS][3], at = (int)(random_bits(&seed) % 16);
        for (int i = 0; i < TEXELS; i++)
            for (int c = 0; c < 3; c++)
                code[i][c] =
                    i == at ? 0x7900 - 200 * c - n : 9000 + (int)(random_bits(&seed) % 900);
        there_and_back(code, back);
        for (int c = 0; c < 3; c++)
            CHECK_BELOW(relative(code[at][c], back[at][c]), c == 2 ? 0.107 : 0.054);
    }
}

// A texel of 65504, the largest half float, among texels that are 2^step darker. Ends that lie up
// to 8 factors of two apart are stored in steps of 4 of 128 numbers for each factor of two, of
// which the last finite one is 64256. Ends further apart are stored in steps of 16, in blue of 32:
// 60416 and 55296 are the last ones.
static void the_brightest_texel_keeps_its_light(void **state)
{
    (void)state;
    for (int step = 1; step < 30; step++)
        for (int at = 0; at < TEXELS; at++) {
            int code[TEXELS][3], back[TEXELS][3];
            for (int i = 0; i < TEXELS; i++)
                for (int c = 0; c < 3; c++)
                    code[i][c] = i == at ? CODES - 1 : ki_max(CODES - 1 - 1024 * step, 0);
            there_and_back(code, back);
            for (int c = 0; c < 3; c++)
                CHECK_BELOW(relative(code[at][c], back[at][c]), step <= 8 ? 0.0191
                                                                : c < 2   ? 0.0777
                                                                          : 0.1559);
        }
}

// A value is rounded to the nearest number of a range among those that are equal in the upper bits,
// by a search over all numbers. All modes have one of these ranges.
static void values_are_rounded_to_the_nearest(void **state)
{
    (void)state;
    static const uint8_t numbers[] = {12, 14, 15, 17, 19, 20};
    for (size_t n = 0; n < sizeof numbers; n++)
        for (int i = 0; i < 4 * 256; i++) {
            const int number = numbers[n];
            const ki_uastc_range range = ki_uastc_ranges[number];
            int kept = i / 256, value = i % 256, least = 256;
            for (unsigned stored = 0; stored < (unsigned)range.base << range.bits; stored++) {
                int have = ki_uastc_value(stored, range);
                if (have >> (8 - kept) == value >> (8 - kept))
                    least = abs(have - value) < least ? abs(have - value) : least;
            }
            int got = ki_uastc_quantize(value, number, kept);
            assert_int_equal(abs(got - value), least);
            assert_int_equal(got >> (8 - kept), value >> (8 - kept));
            assert_int_equal(got, ki_uastc_value(ki_uastc_nearest(value, number, kept), range));
        }
}

// Noise of every range: the texels err by less than the noise's own spread, and twice as little as
// the mean of the block would.
static void noise_errs_less_than_its_range(void **state)
{
    (void)state;
    uint64_t seed = 99;
    for (int bits = 5; bits < 13; bits++) {
        double off = 0, spread = 0;
        for (int n = 0; n < 400; n++) {
            int code[TEXELS][3], back[TEXELS][3], range = 1 << bits;
            for (int c = 0; c < 3; c++) {
                int base = 14000 + (int)(random_bits(&seed) % 300);
                for (int i = 0; i < TEXELS; i++)
                    code[i][c] = base + (int)(random_bits(&seed) % (unsigned)range);
            }
            there_and_back(code, back);
            for (int i = 0; i < TEXELS; i++)
                for (int c = 0; c < 3; c++)
                    off += (double)(code[i][c] - back[i][c]) * (code[i][c] - back[i][c]);
            spread += TEXELS * 3 * (double)range * range / 12;
        }
        CHECK_BELOW(sqrt(off / spread), bits < 7 ? 1 : 0.75);
    }
}

// ---------------------------------------------------------------------------------- whole pictures

// The levels of a sky with its sun: the error relative to the RMS radiance. Level 0 has the sun,
// whose block spans so many factors of two that its ends are 8 steps apart for each. The other
// levels err less than BC6H does.
static void a_sky_errs_little(void **state)
{
    (void)state;
    kiln_context *context = make_context(0);
    kiln_sky_def sky = {.size = 256, .elevation = 20};
    kiln_prefilter_def def = {.size = 64, .level_count = 4};
    kiln_map panorama, cube;
    CHECK_OK(kiln_sky(context, &sky, &panorama, &error));
    CHECK_OK(kiln_prefilter(context, &panorama, &def, &cube, &error));
    static const double bounds[4] = {0.036, 0.024, 0.0145, 0.0205};
    for (int k = 0; k < 4; k++) {
        int n = 64 >> k;
        size_t texels = kiln_map_texels(&cube, k), face = ki_blocks_size(n, n);
        uint8_t *bytes = malloc(6 * face), *others = malloc(6 * face);
        float *back = malloc(3 * texels * sizeof *back), *bc6h = malloc(3 * texels * sizeof *bc6h);
        assert_true(ki_uastc_encode(context, cube.level[k], n, n, 6, bytes));
        assert_true(ki_bc6h_encode(context, cube.level[k], n, n, 6, others));
        for (size_t f = 0; f < 6; f++) {
            ki_uastc_decode(bytes + f * face, n, n, back + f * texels / 2);
            ki_bc6h_decode(others + f * face, n, n, bc6h + f * texels / 2);
        }
        double off = 0, all = 0, bound = 0;
        for (size_t i = 0; i < 3 * texels; i++) {
            double truth = (double)cube.level[k][i];
            off += (truth - (double)back[i]) * (truth - (double)back[i]);
            bound += (truth - (double)bc6h[i]) * (truth - (double)bc6h[i]);
            all += truth * truth;
        }
        if (k)
            CHECK_BELOW(sqrt(off / all), sqrt(bound / all));
        CHECK_BELOW(sqrt(off / all), bounds[k]);
        free(bytes);
        free(others);
        free(back);
        free(bc6h);
    }
    kiln_map_free(&panorama);
    kiln_map_free(&cube);
    kiln_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_mode_comes_back),
        cmocka_unit_test(any_bits_are_refused_or_decoded),
        cmocka_unit_test(partitions_are_those_of_astc),
        cmocka_unit_test(constant_blocks_are_exact),
        cmocka_unit_test(gradients_err_by_half_a_step),
        cmocka_unit_test(a_bright_texel_keeps_its_light),
        cmocka_unit_test(the_brightest_texel_keeps_its_light),
        cmocka_unit_test(values_are_rounded_to_the_nearest),
        cmocka_unit_test(noise_errs_less_than_its_range),
        cmocka_unit_test(a_sky_errs_little),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

// BC6H: its bits, what is decoded, and how near the encoder comes.
#include "codec/bc6h.h"
#include "image/pack.h"
#include "kit/kit.h"

static kiln_error error;

enum { TEXELS = 16, CODES = 0x7c00 };

static void random_bytes(uint64_t *seed, uint8_t bytes[16])
{
    for (int i = 0; i < 16; i++)
        bytes[i] = (uint8_t)(random_bits(seed) >> 8);
}

// -------------------------------------------------------------------------------------------- bits

// Whatever 128 bits say, they are said again: each bit is read once, and written where it was.
static void every_bit_comes_back(void **state)
{
    (void)state;
    uint64_t seed = 7;
    int seen[KI_BC6H_MODES] = {0};
    for (int n = 0; n < 200000; n++) {
        uint8_t bytes[16], again[16];
        ki_bc6h_block block;
        random_bytes(&seed, bytes);
        if (!ki_bc6h_unpack(bytes, &block)) {
            assert_int_equal(bytes[0] & 0x13, 0x13); // 19, 23, 27, 31
            continue;
        }
        ki_bc6h_pack(&block, again);
        assert_memory_equal(bytes, again, 16);
        seen[block.mode]++;
    }
    for (int m = 0; m < KI_BC6H_MODES; m++)
        assert_true(seen[m] > 1000);
}

// One bit of the tables "Interpretation of lower bits" and "of upper bits" set.
typedef struct place {
    int number, bit, end, channel, value;
} place;

static void bits_are_where_the_tables_have_them(void **state)
{
    (void)state;
    static const place places[] = {
        {0, 2, 2, 1, 1 << 4},    {0, 4, 3, 2, 1 << 4},    {0, 60, 3, 2, 1 << 1},
        {1, 2, 2, 1, 1 << 5},    {1, 33, 3, 2, 1 << 5},   {1, 75, 3, 0, 1 << 4},
        {2, 40, 0, 0, 1 << 10},  {6, 75, 2, 1, 1 << 4},   {10, 69, 3, 2, 1 << 1},
        {14, 40, 3, 1, 1 << 4},  {18, 33, 3, 2, 1 << 3},  {22, 33, 3, 1, 1 << 5},
        {26, 60, 1, 2, 1 << 5},  {30, 40, 1, 0, 1 << 5},  {3, 64, 1, 2, 1 << 9},
        {7, 44, 0, 0, 1 << 10},  {11, 43, 0, 0, 1 << 11}, {15, 39, 0, 0, 1 << 15},
        {15, 40, 0, 0, 1 << 14}, {15, 64, 0, 2, 1 << 10},
    };
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        const place *p = &places[i];
        uint8_t bytes[16] = {(uint8_t)p->number};
        ki_bc6h_block block;
        bytes[p->bit / 8] |= (uint8_t)(1 << (p->bit % 8));
        assert_true(ki_bc6h_unpack(bytes, &block));
        const ki_bc6h_mode *mode = &ki_bc6h_modes[block.mode];
        assert_int_equal(mode->number, p->number);
        int wanted = p->value, bits = mode->delta_bits[p->channel];
        if (p->end && mode->relative && wanted == 1 << (bits - 1)) // a sign
            wanted = (1 << mode->bits) - (1 << (bits - 1));
        assert_int_equal(block.endpoint[p->end / 2][p->end % 2][p->channel], wanted);
    }
}

// ---------------------------------------------------------------------------------------- encoding

// What becomes of a block given as codes of half floats.
static void there_and_back(int code[TEXELS][3], int back[TEXELS][3])
{
    float rgb[TEXELS][3], out[TEXELS][3];
    uint8_t bytes[16];
    for (int i = 0; i < TEXELS; i++)
        for (int c = 0; c < 3; c++)
            rgb[i][c] = ki_float_from_half((uint16_t)code[i][c]);
    ki_bc6h_row_scalar(rgb[0], 4, 4, 0, bytes);
    ki_bc6h_decode(bytes, 4, 4, out[0]);
    for (int i = 0; i < TEXELS; i++)
        for (int c = 0; c < 3; c++)
            back[i][c] = ki_half_from_float(out[i][c]);
}

static int largest_of(int code[TEXELS][3])
{
    int largest = 1;
    for (int i = 0; i < 3 * TEXELS; i++)
        largest = ki_max(largest, code[i / 3][i % 3]);
    return largest;
}

// Sets the weights with which the encoder counts the squared errors of a block: each value divided by
// the block's largest, plus 0.015.
static void weigh(int code[TEXELS][3], double weight[TEXELS][3])
{
    double most = (double)ki_float_from_half((uint16_t)largest_of(code));
    for (int i = 0; i < 3 * TEXELS; i++)
        weight[i / 3][i % 3] =
            (double)ki_float_from_half((uint16_t)code[i / 3][i % 3]) / most + 0.015;
}

// Raises codes to 20 factors of two below `largest`. The encoder does not tell lower ones from this
// limit.
static void raise_darks(int code[TEXELS][3], int largest)
{
    for (int i = 0; i < 3 * TEXELS; i++)
        code[i / 3][i % 3] = ki_max(code[i / 3][i % 3], largest - 20 * 1024);
}

// Returns the weighted sum of squared differences.
static double squared(int a[TEXELS][3], int b[TEXELS][3], double weight[TEXELS][3])
{
    double sum = 0;
    for (int i = 0; i < TEXELS; i++)
        for (int c = 0; c < 3; c++)
            sum += weight[i][c] * (a[i][c] - b[i][c]) * (a[i][c] - b[i][c]);
    return sum;
}

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
        there_and_back(code, back);
        assert_memory_equal(code, back, sizeof code);
    }
}

// A slope along a line: half of the sixteenth that an index steps by, and half a step of the ends,
// which is 15.5 codes in the coarsest mode whose differences must reach here.
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
                    CHECK_NEAR(back[i][c], code[i][c], rise / 30.0 + 15.5 / 2 + 2);
        }
}

// The mode of absolute ends and ten bits, a corner of the box of all colours to the opposite one,
// for each of its diagonals, and for each texel the best of sixteen.
static double plain_error(int code[TEXELS][3], double weight[TEXELS][3])
{
    double least = HUGE_VAL;
    for (int diagonal = 0; diagonal < 4; diagonal++) {
        int end[2][3];
        for (int c = 0; c < 3; c++) {
            int low = CODES, high = 0;
            for (int i = 0; i < TEXELS; i++) {
                low = low < code[i][c] ? low : code[i][c];
                high = high > code[i][c] ? high : code[i][c];
            }
            int turned = c ? diagonal >> (c - 1) & 1 : 0;
            end[turned][c] = low / 31;
            end[!turned][c] = high / 31;
        }
        double sum = 0;
        for (int i = 0; i < TEXELS; i++) {
            double nearest = HUGE_VAL;
            for (int k = 0; k < 16; k++) {
                double error2 = 0;
                int w = ki_bc6h_weight(k, 1);
                for (int c = 0; c < 3; c++) {
                    int a = ki_bc6h_unquantize(end[0][c], 10),
                        b = ki_bc6h_unquantize(end[1][c], 10);
                    double off = ((((64 - w) * a + w * b + 32) >> 6) * 31 >> 6) - code[i][c];
                    error2 += weight[i][c] * off * off;
                }
                nearest = fmin(nearest, error2);
            }
            sum += nearest;
        }
        least = fmin(least, sum);
    }
    return least;
}

// Noise of every range and around every colour: better than the plain encoder but for a few in a
// thousand, and never much worse.
static void random_blocks_beat_a_plain_encoder(void **state)
{
    (void)state;
    uint64_t seed = 99;
    int worse = 0;
    double ours = 0, plain = 0;
    enum { BLOCKS = 20000 };
    for (int n = 0; n < BLOCKS; n++) {
        int code[TEXELS][3], back[TEXELS][3], range = 1 << (n % 15);
        for (int c = 0; c < 3; c++) {
            int base = (int)(random_bits(&seed) % (unsigned)(CODES - range + 1));
            for (int i = 0; i < TEXELS; i++)
                code[i][c] = base + (int)(random_bits(&seed) % (unsigned)range);
        }
        there_and_back(code, back);
        double weight[TEXELS][3];
        int largest = largest_of(code);
        weigh(code, weight);
        raise_darks(code, largest);
        raise_darks(back, largest);
        double a = squared(code, back, weight), b = plain_error(code, weight);
        ours += sqrt(a);
        plain += sqrt(b);
        worse += a > b;
        CHECK_BELOW(a, 1.2 * b + 48);
    }
    CHECK_BELOW(worse, BLOCKS * 0.01);
    CHECK_BELOW(ours, 0.75 * plain);
}

// Two colours, whatever the partition: what two subsets are for. The lattice of ends 15.5 codes
// apart where the colours are near, and 62 where the mode must be absolute.
static void two_colours_are_two_lines(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int n = 0; n < 32 * 200; n++) {
        int code[TEXELS][3], back[TEXELS][3], color[2][2][3], far = n % 3;
        for (int c = 0; c < 3; c++) {
            color[0][0][c] = 8000 + (int)(random_bits(&seed) % 8000);
            color[0][1][c] = color[0][0][c] + (int)(random_bits(&seed) % 200);
            int away = far == 0 ? 180 : far == 1 ? 1600 : 12000;
            color[1][0][c] = color[0][0][c] + (int)(random_bits(&seed) % (unsigned)away);
            color[1][1][c] = color[1][0][c] + (int)(random_bits(&seed) % 200);
        }
        for (int i = 0; i < TEXELS; i++) {
            int subset = ki_bc6h_partitions[n % 32] >> i & 1, along = (int)(random_bits(&seed) % 8);
            for (int c = 0; c < 3; c++)
                code[i][c] =
                    color[subset][0][c] + along * (color[subset][1][c] - color[subset][0][c]) / 7;
        }
        there_and_back(code, back);
        double weight[TEXELS][3], all = 0;
        weigh(code, weight);
        for (int i = 0; i < 3 * TEXELS; i++)
            all += weight[i / 3][i % 3];
        CHECK_BELOW(sqrt(squared(code, back, weight) / all), far == 0 ? 25 : far == 1 ? 50 : 160);
    }
}

// ---------------------------------------------------------------------------------- whole pictures

// The levels of a sky with its sun: root of the mean squared difference in codes, of which 10 are
// nearly a per cent.
static void a_sky_errs_little(void **state)
{
    (void)state;
    kiln_context *context = make_context(0);
    kiln_sky_def sky = {.size = 256, .elevation = 20};
    kiln_prefilter_def def = {.size = 64, .level_count = 4};
    kiln_map panorama, cube;
    CHECK_OK(kiln_sky(context, &sky, &panorama, &error));
    CHECK_OK(kiln_prefilter(context, &panorama, &def, &cube, &error));
    static const double bounds[4] = {6.5, 14, 21, 38};
    for (int k = 0; k < 4; k++) {
        int n = 64 >> k;
        size_t texels = kiln_map_texels(&cube, k), face = ki_blocks_size(n, n);
        uint8_t *bytes = malloc(6 * face);
        float *back = malloc(3 * texels * sizeof *back);
        assert_true(ki_bc6h_encode(context, cube.level[k], n, n, 6, bytes));
        for (size_t f = 0; f < 6; f++)
            ki_bc6h_decode(bytes + f * face, n, n, back + f * texels / 2);
        double sum = 0;
        for (size_t i = 0; i < 3 * texels; i++) {
            double off = ki_half_from_float(back[i]) - ki_half_from_float(cube.level[k][i]);
            sum += off * off;
        }
        double rms = sqrt(sum / (double)(3 * texels));
        CHECK_BELOW(rms, bounds[k]);
        free(bytes);
        free(back);
    }
    kiln_map_free(&panorama);
    kiln_map_free(&cube);
    kiln_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_bit_comes_back),
        cmocka_unit_test(bits_are_where_the_tables_have_them),
        cmocka_unit_test(constant_blocks_are_exact),
        cmocka_unit_test(gradients_err_by_half_a_step),
        cmocka_unit_test(random_blocks_beat_a_plain_encoder),
        cmocka_unit_test(two_colours_are_two_lines),
        cmocka_unit_test(a_sky_errs_little),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

// The modes, partitions, weights and ranges of numbers of UASTC HDR 4x4, and the rounding of
// endpoint values. In: a value of 8 bits and the number of a range. Out: the nearest number that
// the range has, as ASTC stores the number and as the value that the number stands for.
#include "codec/uastc.h"

#include "codec/bc6h.h"

// From "UASTC HDR 4x4 Texture Specification", the table of block modes.
const ki_uastc_mode ki_uastc_modes[KI_UASTC_MODES] = {
    {11, 1, 1, 20}, {11, 1, 2, 20}, {11, 1, 3, 20}, {11, 1, 4, 20}, {11, 1, 5, 20}, {11, 1, 6, 20},
    {11, 1, 7, 20}, {11, 1, 8, 19}, {7, 1, 1, 20},  {7, 1, 2, 20},  {7, 1, 3, 20},  {7, 1, 4, 20},
    {7, 1, 5, 20},  {7, 1, 6, 20},  {7, 1, 7, 20},  {7, 1, 8, 20},  {7, 2, 1, 20},  {7, 2, 2, 20},
    {7, 2, 3, 19},  {7, 2, 4, 17},  {7, 2, 5, 15},  {11, 2, 1, 14}, {11, 2, 2, 12},
};

// From the same specification, the table of partitions that ASTC and BC6H have in common.
const ki_uastc_partition ki_uastc_partitions[KI_UASTC_PARTITIONS] = {
    {28, 0, false},   {20, 1, false},  {16, 2, true},   {29, 3, false},   {91, 4, true},
    {9, 5, false},    {107, 6, true},  {72, 7, true},   {149, 8, false},  {204, 9, true},
    {50, 10, false},  {114, 11, true}, {496, 12, true}, {17, 13, true},   {78, 14, false},
    {39, 15, true},   {252, 17, true}, {828, 18, true}, {43, 19, false},  {156, 20, false},
    {116, 21, false}, {210, 22, true}, {476, 23, true}, {273, 24, false}, {684, 25, true},
    {359, 26, false}, {246, 29, true},
};

const uint8_t ki_uastc_levels[9] = {2, 3, 4, 5, 6, 8, 10, 12, 16};
const uint8_t ki_uastc_weights[9][16] = {
    {0, 64},
    {0, 32, 64},
    {0, 21, 43, 64},
    {0, 16, 32, 48, 64},
    {0, 12, 25, 39, 52, 64},
    {0, 9, 18, 27, 37, 46, 55, 64},
    {0, 7, 14, 21, 28, 36, 43, 50, 57, 64},
    {0, 5, 11, 17, 23, 28, 36, 41, 47, 53, 59, 64},
    {0, 4, 8, 12, 17, 21, 25, 29, 35, 39, 43, 47, 52, 56, 60, 64},
};

unsigned ki_uastc_mask(int partition)
{
    const ki_uastc_partition *p = &ki_uastc_partitions[partition];
    return ki_bc6h_partitions[p->bc6h] ^ (p->inverted ? 0xffffU : 0);
}

// From the table "ASTC range parameters" of the Khronos Data Format Specification: 2, 3, 4, 5, 6,
// 8, 10, ... 256 numbers.
const ki_uastc_range ki_uastc_ranges[21] = {{1, 1}, {3, 0}, {1, 2}, {5, 0}, {3, 1}, {1, 3}, {5, 1},
                                            {3, 2}, {1, 4}, {5, 2}, {3, 3}, {1, 5}, {5, 3}, {3, 4},
                                            {1, 6}, {5, 4}, {3, 5}, {1, 7}, {5, 5}, {3, 6}, {1, 8}};

// ---------------------------------------------------------------------------------------- numbers

// By "ASTC colour unquantization": bits
// are repeated; in ranges with digits a mirrored sequence rises with the digit and the bits.
int ki_uastc_value(unsigned stored, ki_uastc_range r)
{
    if (r.base == 1)
        return (int)(r.bits == 8   ? stored
                     : r.bits == 7 ? stored << 1 | stored >> 6
                                   : stored << 2 | stored >> 4);
    unsigned digit = stored >> r.bits, lowest = stored & 1;
    unsigned x = (stored & ((1U << r.bits) - 1)) >> 1, scale, upper;
    switch (r.base * 8 + r.bits) {
    case 5 * 8 + 3: // the bits c b of x as c b 0 0 0 0 c b c
        scale = 26;
        upper = x << 7 | x << 1 | x >> 1;
        break;
    case 5 * 8 + 4: // d c b 0 0 0 0 d c
        scale = 13;
        upper = x << 6 | x >> 1;
        break;
    default: // 3 x 64 numbers: f e d c b 0 0 0 f
        scale = 5;
        upper = x << 4 | x >> 4;
        break;
    }
    unsigned t = (digit * scale + upper) ^ (lowest ? 0x1ff : 0);
    return (int)((lowest ? 0x80 : 0) | t >> 2);
}

// Keeps a stored number and its distance from `value` if `have`, which the number stands for, is
// nearer to `value` than *best and equal to it from bit `above` on.
static void closer(int value, int above, int have, unsigned stored, int *best, unsigned *found)
{
    int off = have > value ? have - value : value - have;
    if (off < *best && have >> above == value >> above) {
        *best = off;
        *found = stored;
    }
}

// Returns the stored number whose value is nearest to `value` and equal to it in the upper `kept`
// bits.
unsigned ki_uastc_nearest(int value, int number, int kept)
{
    ki_uastc_range r = ki_uastc_ranges[number];
    int best = 256, above = 8 - kept;
    unsigned found = 0;
    if (r.base == 1) {
        int at = value >> (8 - r.bits);
        for (int i = ki_max(at - 1, 0); i <= ki_min(at + 1, (1 << r.bits) - 1); i++)
            closer(value, above, ki_uastc_value((unsigned)i, r), (unsigned)i, &best, &found);
        return found;
    }
    unsigned lowest = (unsigned)value >> 7;
    int mirrored = lowest ? 255 - value : value, shift = ki_max(8 - r.bits, 0);
    for (int x = (mirrored >> shift) - 1; x <= (mirrored >> shift) + 1; x++)
        for (unsigned digit = 0; digit < r.base && x >= 0 && x < 128 >> shift; digit++) {
            unsigned stored = digit << r.bits | (unsigned)x << 1 | lowest;
            closer(value, above, ki_uastc_value(stored, r), stored, &best, &found);
        }
    return found;
}

int ki_uastc_quantize(int value, int number, int kept)
{
    return number == 20
               ? value
               : ki_uastc_value(ki_uastc_nearest(value, number, kept), ki_uastc_ranges[number]);
}

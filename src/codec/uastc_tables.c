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

// The value nearest to each number of 8 bits, for the ranges of the modes that the encoder tries:
// what ki_uastc_nearest finds if no bits are kept. That search would take a third of the encoder's
// time.
enum { FAST = 3 };
static const uint8_t fast_ranges[FAST] = {12, 15, 19};
static const uint8_t fast_values[FAST][256] = {
    {0,   0,   0,   0,   6,   6,   6,   6,   6,   6,   13,  13,  13,  13,  13,  13,  13,  19,  19,
     19,  19,  19,  19,  26,  26,  26,  26,  26,  26,  26,  32,  32,  32,  32,  32,  32,  39,  39,
     39,  39,  39,  39,  39,  45,  45,  45,  45,  45,  45,  52,  52,  52,  52,  52,  52,  52,  58,
     58,  58,  58,  58,  58,  65,  65,  65,  65,  65,  65,  65,  71,  71,  71,  71,  71,  71,  78,
     78,  78,  78,  78,  78,  78,  84,  84,  84,  84,  84,  84,  91,  91,  91,  91,  91,  91,  91,
     97,  97,  97,  97,  97,  97,  104, 104, 104, 104, 104, 104, 104, 110, 110, 110, 110, 110, 110,
     117, 117, 117, 117, 117, 117, 117, 123, 123, 123, 123, 123, 123, 123, 132, 132, 132, 132, 132,
     132, 132, 138, 138, 138, 138, 138, 138, 138, 145, 145, 145, 145, 145, 145, 151, 151, 151, 151,
     151, 151, 151, 158, 158, 158, 158, 158, 158, 164, 164, 164, 164, 164, 164, 164, 171, 171, 171,
     171, 171, 171, 177, 177, 177, 177, 177, 177, 177, 184, 184, 184, 184, 184, 184, 190, 190, 190,
     190, 190, 190, 190, 197, 197, 197, 197, 197, 197, 203, 203, 203, 203, 203, 203, 203, 210, 210,
     210, 210, 210, 210, 216, 216, 216, 216, 216, 216, 216, 223, 223, 223, 223, 223, 223, 229, 229,
     229, 229, 229, 229, 229, 236, 236, 236, 236, 236, 236, 242, 242, 242, 242, 242, 242, 242, 249,
     249, 249, 249, 249, 249, 255, 255, 255, 255},
    {0,   0,   3,   3,   3,   6,   6,   6,   9,   9,   9,   9,   13,  13,  13,  16,  16,  16,  19,
     19,  19,  22,  22,  22,  25,  25,  25,  25,  29,  29,  29,  32,  32,  32,  35,  35,  35,  38,
     38,  38,  38,  42,  42,  42,  45,  45,  45,  48,  48,  48,  51,  51,  51,  54,  54,  54,  54,
     58,  58,  58,  61,  61,  61,  64,  64,  64,  67,  67,  67,  67,  71,  71,  71,  74,  74,  74,
     77,  77,  77,  80,  80,  80,  83,  83,  83,  83,  87,  87,  87,  90,  90,  90,  93,  93,  93,
     96,  96,  96,  96,  100, 100, 100, 103, 103, 103, 106, 106, 106, 109, 109, 109, 112, 112, 112,
     112, 116, 116, 116, 119, 119, 119, 122, 122, 122, 125, 125, 125, 125, 130, 130, 130, 130, 133,
     133, 133, 136, 136, 136, 139, 139, 139, 143, 143, 143, 143, 146, 146, 146, 149, 149, 149, 152,
     152, 152, 155, 155, 155, 159, 159, 159, 159, 162, 162, 162, 165, 165, 165, 168, 168, 168, 172,
     172, 172, 172, 175, 175, 175, 178, 178, 178, 181, 181, 181, 184, 184, 184, 188, 188, 188, 188,
     191, 191, 191, 194, 194, 194, 197, 197, 197, 201, 201, 201, 201, 204, 204, 204, 207, 207, 207,
     210, 210, 210, 213, 213, 213, 217, 217, 217, 217, 220, 220, 220, 223, 223, 223, 226, 226, 226,
     230, 230, 230, 230, 233, 233, 233, 236, 236, 236, 239, 239, 239, 242, 242, 242, 246, 246, 246,
     246, 249, 249, 249, 252, 252, 252, 255, 255},
    {0,   1,   2,   2,   4,   5,   6,   6,   8,   9,   10,  10,  12,  13,  14,  14,  16,  17,  18,
     18,  20,  21,  22,  22,  24,  25,  26,  26,  28,  29,  30,  30,  32,  33,  34,  34,  36,  37,
     38,  38,  40,  41,  42,  42,  44,  45,  46,  46,  48,  49,  50,  50,  52,  53,  54,  54,  56,
     57,  58,  58,  60,  61,  62,  62,  64,  65,  66,  66,  68,  69,  70,  70,  72,  73,  74,  74,
     76,  77,  78,  78,  80,  81,  82,  82,  84,  85,  86,  86,  88,  89,  90,  90,  92,  93,  94,
     94,  96,  97,  98,  98,  100, 101, 102, 102, 104, 105, 106, 106, 108, 109, 110, 110, 112, 113,
     114, 114, 116, 117, 118, 118, 120, 121, 122, 122, 124, 125, 126, 126, 129, 129, 130, 131, 133,
     133, 134, 135, 137, 137, 138, 139, 141, 141, 142, 143, 145, 145, 146, 147, 149, 149, 150, 151,
     153, 153, 154, 155, 157, 157, 158, 159, 161, 161, 162, 163, 165, 165, 166, 167, 169, 169, 170,
     171, 173, 173, 174, 175, 177, 177, 178, 179, 181, 181, 182, 183, 185, 185, 186, 187, 189, 189,
     190, 191, 193, 193, 194, 195, 197, 197, 198, 199, 201, 201, 202, 203, 205, 205, 206, 207, 209,
     209, 210, 211, 213, 213, 214, 215, 217, 217, 218, 219, 221, 221, 222, 223, 225, 225, 226, 227,
     229, 229, 230, 231, 233, 233, 234, 235, 237, 237, 238, 239, 241, 241, 242, 243, 245, 245, 246,
     247, 249, 249, 250, 251, 253, 253, 254, 255}};

int ki_uastc_quantize(int value, int number, int kept)
{
    if (number == 20)
        return value;
    // The nearest of all values is also the nearest of those that are equal in the upper bits, if
    // the nearest value is one of these.
    for (int i = 0; i < FAST; i++)
        if (fast_ranges[i] == number && !((fast_values[i][value] ^ value) >> (8 - kept)))
            return fast_values[i][value];
    return ki_uastc_value(ki_uastc_nearest(value, number, kept), ki_uastc_ranges[number]);
}

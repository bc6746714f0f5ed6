// The modes and partitions of BC6H, and the reading and writing of a block's bits. In and out: a
// ki_bc6h_block and its 16 bytes. Each mode's runs of bits are text that a small parser reads.
#include "codec/bc6h.h"

// From the Khronos Data Format Specification 1.4, "Endpoint and partition parameters for BPTC block
// modes" and "Block descriptions for BC6H block modes". A run of endpoint bits is written as its
// channel (r, g or b), the number of the endpoint, the lowest bit and the number of bits.
const ki_bc6h_mode ki_bc6h_modes[KI_BC6H_MODES] = {
    {0,
     2,
     10,
     {5, 5, 5},
     true,
     "G241 B241 B341 R00a G00a B00a R105 G341 G204 G105 B301 G304 B105 "
     "B311 B204 R205 B321 R305 B331"},
    {1,
     2,
     7,
     {6, 6, 6},
     true,
     "G251 G342 R007 B302 B241 G007 B251 B321 G241 B007 B331 B351 B341 "
     "R106 G204 G106 G304 B106 B204 R206 R306"},
    {2,
     2,
     11,
     {5, 4, 4},
     true,
     "R00a G00a B00a R105 R0a1 G204 G104 G0a1 B301 G304 B104 B0a1 B311 "
     "B204 R205 B321 R305 B331"},
    {6,
     2,
     11,
     {4, 5, 4},
     true,
     "R00a G00a B00a R104 R0a1 G341 G204 G105 G0a1 G304 B104 B0a1 B311 "
     "B204 R204 B301 B321 R304 G241 B331"},
    {10,
     2,
     11,
     {4, 4, 5},
     true,
     "R00a G00a B00a R104 R0a1 B241 G204 G104 G0a1 B301 G304 B105 B0a1 "
     "B204 R204 B312 R304 B341 B331"},
    {14,
     2,
     9,
     {5, 5, 5},
     true,
     "R009 B241 G009 G241 B009 B341 R105 G341 G204 G105 B301 G304 B105 "
     "B311 B204 R205 B321 R305 B331"},
    {18,
     2,
     8,
     {6, 5, 5},
     true,
     "R008 G341 B241 G008 B321 G241 B008 B332 R106 G204 G105 B301 G304 "
     "B105 B311 B204 R206 R306"},
    {22,
     2,
     8,
     {5, 6, 5},
     true,
     "R008 B301 B241 G008 G251 G241 B008 G351 B341 R105 G341 G204 G106 "
     "G304 B105 B311 B204 R205 B321 R305 B331"},
    {26,
     2,
     8,
     {5, 5, 6},
     true,
     "R008 B311 B241 G008 B251 G241 B008 B351 B341 R105 G341 G204 G105 "
     "B301 G304 B106 B204 R205 B321 R305 B331"},
    {30,
     2,
     6,
     {6, 6, 6},
     false,
     "R006 G341 B302 B241 G006 G251 B251 B321 G241 B006 G351 B331 B351 "
     "B341 R106 G204 G106 G304 B106 B204 R206 R306"},
    {3, 1, 10, {10, 10, 10}, false, "R00a G00a B00a R10a G10a B10a"},
    {7, 1, 11, {9, 9, 9}, true, "R00a G00a B00a R109 R0a1 G109 G0a1 B109 B0a1"},
    {11, 1, 12, {8, 8, 8}, true, "R00a G00a B00a R108 R0b1 R0a1 G108 G0b1 G0a1 B108 B0b1 B0a1"},
    {15,
     1,
     16,
     {4, 4, 4},
     true,
     "R00a G00a B00a R104 R0f1 R0e1 R0d1 R0c1 R0b1 R0a1 G104 G0f1 G0e1 "
     "G0d1 G0c1 G0b1 G0a1 B104 B0f1 B0e1 B0d1 B0c1 B0b1 B0a1"},
};

// The subset of each texel, and the anchor texels of subset 1. From the same specification,
// "Partition table for 2-subset BPTC" (first half) and "BPTC anchor index values for the second
// subset of two-subset partitioning".
const uint16_t ki_bc6h_partitions[KI_BC6H_PARTITIONS] = {
    0xcccc, 0x8888, 0xeeee, 0xecc8, 0xc880, 0xfeec, 0xfec8, 0xec80, 0xc800, 0xffec, 0xfe80,
    0xe800, 0xffe8, 0xff00, 0xfff0, 0xf000, 0xf710, 0x008e, 0x7100, 0x08ce, 0x008c, 0x7310,
    0x3100, 0x8cce, 0x088c, 0x3110, 0x6666, 0x366c, 0x17e8, 0x0ff0, 0x718e, 0x399c};
const uint8_t ki_bc6h_anchors[KI_BC6H_PARTITIONS] = {15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15,
                                                     15, 15, 15, 15, 15, 15, 2,  8,  2,  2,  8,
                                                     8,  15, 2,  8,  2,  2,  8,  8,  2,  2};

// ------------------------------------------------------------------------------------------- bits

typedef struct run {
    int channel, end, first, count;
} run;

static int hexadecimal(char digit)
{
    return digit <= '9' ? digit - '0' : digit - 'a' + 10;
}

// Parses the next run of endpoint bits from a mode's text at *at. Returns false after the last run.
static bool next_run(const char **at, run *r)
{
    const char *t = *at;
    if (!*t)
        return false;
    r->channel = t[0] == 'R' ? 0 : t[0] == 'G' ? 1 : 2;
    r->end = t[1] - '0';
    r->first = hexadecimal(t[2]);
    r->count = hexadecimal(t[3]);
    *at = t + 4 + (t[4] == ' ');
    return true;
}

static int number_bits(int number)
{
    return number < 2 ? 2 : 5;
}

// Returns the number of bits that store the index of a texel: one bit fewer for the anchor texel of
// each subset.
static int index_bits(const ki_bc6h_mode *mode, int partition, int texel)
{
    bool anchor = texel == 0 || (mode->subsets == 2 && texel == ki_bc6h_anchors[partition]);
    return (mode->subsets == 2 ? 3 : 4) - anchor;
}

void ki_bc6h_pack(const ki_bc6h_block *block, uint8_t bytes[KI_BLOCK_BYTES])
{
    const ki_bc6h_mode *mode = &ki_bc6h_modes[block->mode];
    ki_bits b = {0};
    ki_bits_put(&b, mode->number, number_bits(mode->number));
    run r;
    for (const char *at = mode->runs; next_run(&at, &r);) {
        int value = block->endpoint[r.end / 2][r.end % 2][r.channel];
        if (r.end && mode->relative)
            value -= block->endpoint[0][0][r.channel];
        ki_bits_put(&b, (uint64_t)(int64_t)value >> r.first, r.count);
    }
    if (mode->subsets == 2)
        ki_bits_put(&b, (uint64_t)block->partition, 5);
    for (int i = 0; i < 16; i++)
        ki_bits_put(&b, (uint64_t)block->index[i], index_bits(mode, block->partition, i));
    for (int i = 0; i < KI_BLOCK_BYTES; i++)
        bytes[i] = (uint8_t)(b.half[i / 8] >> (8 * (i % 8)));
}

static int find_mode(ki_bits *b)
{
    int number = (int)ki_bits_get(b, 2);
    number = number < 2 ? number : number | (int)ki_bits_get(b, 3) << 2;
    for (int m = 0; m < KI_BC6H_MODES; m++)
        if (ki_bc6h_modes[m].number == number)
            return m;
    return -1;
}

bool ki_bc6h_unpack(const uint8_t bytes[KI_BLOCK_BYTES], ki_bc6h_block *block)
{
    ki_bits b = {0};
    for (int i = 0; i < KI_BLOCK_BYTES; i++)
        b.half[i / 8] |= (uint64_t)bytes[i] << (8 * (i % 8));
    *block = (ki_bc6h_block){.mode = find_mode(&b)};
    if (block->mode < 0)
        return false;
    const ki_bc6h_mode *mode = &ki_bc6h_modes[block->mode];
    run r;
    for (const char *at = mode->runs; next_run(&at, &r);)
        block->endpoint[r.end / 2][r.end % 2][r.channel] |= (int)ki_bits_get(&b, r.count)
                                                            << r.first;
    for (int end = 1; end < 2 * mode->subsets && mode->relative; end++)
        for (int c = 0; c < 3; c++) {
            int sign = 1 << (mode->delta_bits[c] - 1);
            int *value = &block->endpoint[end / 2][end % 2][c], delta = (*value ^ sign) - sign;
            *value = (block->endpoint[0][0][c] + delta) & ((1 << mode->bits) - 1);
        }
    if (mode->subsets == 2)
        block->partition = (int)ki_bits_get(&b, 5);
    for (int i = 0; i < 16; i++)
        block->index[i] = (int)ki_bits_get(&b, index_bits(mode, block->partition, i));
    return true;
}

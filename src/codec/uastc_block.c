// Reading and writing of the bits of UASTC HDR 4x4 blocks. In and
// out: a ki_uastc_block and its 16 bytes. ASTC stores numbers of ranges such as 192 = 3 x 64 as
// bits and as digits to the base 3 or 5 ("trits" and "quints"), of which five or three share 8 or 7
// bits. Endpoint values are written from the block's start, weights from the block's end, bit by
// bit backwards.
#include "codec/uastc.h"

#include <string.h>

// For the ranges whose stored numbers are not in the order of the weights: the stored number of
// each weight in rising order.
static const uint8_t stored_weights[9][16] = {
    [4] = {0, 2, 4, 5, 3, 1},
    [6] = {0, 2, 4, 6, 8, 9, 7, 5, 3, 1},
    [7] = {0, 4, 8, 2, 6, 10, 11, 7, 3, 9, 5, 1},
};

// ----------------------------------------------------------------------------------------- digits

static uint64_t reverse(uint64_t v)
{
    uint64_t r = 0;
    for (int i = 0; i < 64; i++)
        r |= (v >> i & 1) << (63 - i);
    return r;
}

// Joins five digits of 0 to 2 to 8 bits: the inverse of the rule in "ASTC trits and quints".
static unsigned join_trits(const unsigned t[5])
{
    unsigned c = t[2] == 2 && t[1] == 2 ? 12 | t[0]
                 : t[2] == 2            ? t[1] << 4 | t[0] << 2 | 3
                                        : t[2] << 4 | t[1] << 2 | t[0];
    if (t[3] == 2 && t[4] == 2)
        return (c >> 2) << 5 | 7 << 2 | (c & 3);
    return t[4] == 2 ? t[3] << 7 | 3 << 5 | c : t[4] << 7 | t[3] << 5 | c;
}

static void split_trits(unsigned v, unsigned t[5])
{
    unsigned c = v & 31;
    if ((v >> 2 & 7) == 7) {
        c = (v >> 5) << 2 | (v & 3);
        t[3] = t[4] = 2;
    } else {
        bool two = (v >> 5 & 3) == 3;
        t[4] = two ? 2 : v >> 7;
        t[3] = two ? v >> 7 : v >> 5 & 3;
    }
    unsigned low = c & 3, middle = c >> 2 & 3;
    if (low == 3) {
        t[2] = 2;
        t[1] = c >> 4;
        t[0] = middle & (2 | (~middle >> 1 & 1));
    } else {
        t[2] = middle == 3 ? 2 : c >> 4;
        t[1] = middle == 3 ? 2 : middle;
        t[0] = middle == 3 ? low : low & (2 | (~low >> 1 & 1));
    }
}

// Joins three digits of 0 to 4 to 7 bits.
static unsigned join_quints(const unsigned q[3])
{
    if (q[0] == 4 && q[1] == 4)
        return q[2] == 4 ? 7 : q[2] << 3 | 6;
    unsigned c = q[1] == 4 ? q[0] << 3 | 5 : q[1] << 3 | q[0];
    return q[2] == 4 ? (~c >> 1 & 3) << 5 | (c & 24) | 6 | (c & 1) : q[2] << 5 | c;
}

static void split_quints(unsigned v, unsigned q[3])
{
    bool full = (v >> 1 & 3) == 3;
    if (full && v >> 5 == 0) {
        q[0] = q[1] = 4;
        q[2] = v & 1 ? 4 : v >> 3 & 3;
        return;
    }
    unsigned c = full ? (v & 24) | (~v >> 5 & 3) << 1 | (v & 1) : v & 31;
    q[2] = full ? 4 : v >> 5;
    bool four = (c & 7) == 5;
    q[1] = four ? 4 : c >> 3;
    q[0] = four ? c >> 3 : c & 7;
}

// Number of bits of the joined digits that follow each number of a group.
static const uint8_t trit_bits[5] = {2, 2, 1, 2, 1}, quint_bits[3] = {3, 2, 2};

// Writes `count` numbers of a range. The digits of a last group with fewer numbers are filled up by
// zeros, and bits that follow missing numbers are left out.
static void put_numbers(ki_bits *b, const uint8_t *number, int count, ki_uastc_range r)
{
    int group = r.base == 3 ? 5 : r.base == 5 ? 3 : 1;
    for (int first = 0; first < count; first += group) {
        unsigned digit[5] = {0};
        int n = ki_min(group, count - first);
        for (int i = 0; i < n; i++)
            digit[i] = (unsigned)number[first + i] >> r.bits;
        unsigned joined = r.base == 3 ? join_trits(digit) : r.base == 5 ? join_quints(digit) : 0;
        for (int i = 0; i < n; i++) {
            int more = r.base == 3 ? trit_bits[i] : r.base == 5 ? quint_bits[i] : 0;
            ki_bits_put(b, number[first + i], r.bits);
            ki_bits_put(b, joined, more);
            joined >>= more;
        }
    }
}

static void get_numbers(ki_bits *b, uint8_t *number, int count, ki_uastc_range r)
{
    int group = r.base == 3 ? 5 : r.base == 5 ? 3 : 1;
    for (int first = 0; first < count; first += group) {
        unsigned low[5], digit[5] = {0}, joined = 0;
        int n = ki_min(group, count - first), have = 0;
        for (int i = 0; i < n; i++) {
            int more = r.base == 3 ? trit_bits[i] : r.base == 5 ? quint_bits[i] : 0;
            low[i] = ki_bits_get(b, r.bits);
            joined |= ki_bits_get(b, more) << have;
            have += more;
        }
        if (r.base == 3)
            split_trits(joined, digit);
        if (r.base == 5)
            split_quints(joined, digit);
        for (int i = 0; i < n; i++)
            number[first + i] = (uint8_t)(digit[i] << r.bits | low[i]);
    }
}

// ---------------------------------------------------------------------------------------- weights

static unsigned stored_weight(int index, int number)
{
    return ki_uastc_ranges[number].base == 1 || !ki_uastc_ranges[number].bits
               ? (unsigned)index
               : stored_weights[number][index];
}

static int index_of_weight(unsigned stored, int number)
{
    int index = 0;
    while (stored_weight(index, number) != stored)
        index++;
    return index;
}

// ----------------------------------------------------------------------------------------- blocks

// Positions and widths in bits. HEAD: number of the grid of weights. ONE, TWO: first bit of the
// endpoint values in blocks of one and of two subsets.
enum { HEAD = 11, ONE = 17, TWO = 29 };
// Lowest 12 bits of a solid block in half floats. All ones after it: the colour holds for no more
// than the block.
#define SOLID_HEAD 0xffcU
#define SOLID_EXTENT UINT64_C(0xfffffffffffff)

static uint64_t read_half(const uint8_t *bytes)
{
    uint64_t v = 0;
    for (int i = 0; i < 8; i++)
        v |= (uint64_t)bytes[i] << (8 * i);
    return v;
}

static void write_half(uint64_t v, uint8_t *bytes)
{
    for (int i = 0; i < 8; i++)
        bytes[i] = (uint8_t)(v >> (8 * i));
}

static int values_of_end(const ki_uastc_mode *mode)
{
    return mode->ends == 11 ? 6 : 4;
}

// The first 11 bits of a block with 4 x 4 weights of a range, by "ASTC block mode layout".
static unsigned grid_of(int weights)
{
    unsigned r = 2 + (unsigned)weights % 6, high = (unsigned)weights / 6;
    return (r >> 1 & 1) | (r >> 2) << 1 | (r & 1) << 4 | 2 << 5 | high << 9;
}

void ki_uastc_pack(const ki_uastc_block *block, uint8_t bytes[KI_BLOCK_BYTES])
{
    if (block->mode == KI_UASTC_SOLID) {
        write_half(SOLID_HEAD | SOLID_EXTENT << 12, bytes);
        write_half((uint64_t)block->solid[0] | (uint64_t)block->solid[1] << 16 |
                       (uint64_t)block->solid[2] << 32 | UINT64_C(0x3c00) << 48,
                   bytes + 8);
        return;
    }
    const ki_uastc_mode *mode = &ki_uastc_modes[block->mode];
    ki_bits b = {0}, backwards = {0};
    ki_bits_put(&b, grid_of(mode->weights), HEAD);
    ki_bits_put(&b, mode->subsets - 1U, 2);
    if (mode->subsets == 2) {
        ki_bits_put(&b, ki_uastc_partitions[block->partition].number, 10);
        ki_bits_put(&b, 0, 2); // both subsets have the same endpoint mode
    }
    ki_bits_put(&b, mode->ends, 4);
    uint8_t stored[16];
    int count = values_of_end(mode), all = count * mode->subsets;
    for (int s = 0; s < mode->subsets; s++)
        for (int i = 0; i < count; i++)
            stored[s * count + i] = (uint8_t)ki_uastc_nearest(block->value[s][i], mode->values, 0);
    put_numbers(&b, stored, all, ki_uastc_ranges[mode->values]);
    for (int i = 0; i < 16; i++)
        stored[i] = (uint8_t)stored_weight(block->index[i], mode->weights);
    put_numbers(&backwards, stored, 16, ki_uastc_ranges[mode->weights]);
    write_half(b.half[0] | reverse(backwards.half[1]), bytes);
    write_half(b.half[1] | reverse(backwards.half[0]), bytes + 8);
}

static bool unpack_solid(const ki_bits *b, ki_uastc_block *block)
{
    block->mode = KI_UASTC_SOLID;
    bool finite = b->half[0] == (SOLID_HEAD | SOLID_EXTENT << 12);
    for (int c = 0; c < 3; c++) {
        block->solid[c] = (uint16_t)(b->half[1] >> (16 * c));
        finite = finite && block->solid[c] < 0x7c00;
    }
    return finite;
}

// Returns the index of a mode, or -1 if there is none.
static int find_mode(unsigned grid, int subsets, unsigned ends)
{
    for (int m = 0; m < KI_UASTC_MODES; m++) {
        const ki_uastc_mode *mode = &ki_uastc_modes[m];
        if (mode->subsets == subsets && mode->ends == ends && grid_of(mode->weights) == grid)
            return m;
    }
    return -1;
}

static int find_partition(unsigned number)
{
    for (int p = 0; p < KI_UASTC_PARTITIONS; p++)
        if (ki_uastc_partitions[p].number == number)
            return p;
    return -1;
}

static bool finite_ends(const ki_uastc_block *block)
{
    const ki_uastc_mode *mode = &ki_uastc_modes[block->mode];
    for (int s = 0; s < mode->subsets; s++) {
        int end[2][3];
        ki_uastc_read_ends(block->value[s], mode->ends, end);
        for (int c = 0; c < 6; c++)
            if (end[c / 3][c % 3] > KI_UASTC_LAST_END)
                return false;
    }
    return true;
}

bool ki_uastc_unpack(const uint8_t bytes[KI_BLOCK_BYTES], ki_uastc_block *block)
{
    ki_bits b = {{read_half(bytes), read_half(bytes + 8)}, 0}, backwards = {{0}, 0};
    backwards.half[0] = reverse(b.half[1]);
    backwards.half[1] = reverse(b.half[0]);
    *block = (ki_uastc_block){0};
    if ((b.half[0] & 0x1ff) == (SOLID_HEAD & 0x1ff))
        return unpack_solid(&b, block);
    unsigned grid = ki_bits_get(&b, HEAD);
    int subsets = (int)ki_bits_get(&b, 2) + 1;
    if (subsets == 2) {
        block->partition = find_partition(ki_bits_get(&b, 10));
        if (block->partition < 0 || ki_bits_get(&b, 2) != 0)
            return false;
    }
    block->mode = find_mode(grid, subsets, ki_bits_get(&b, 4));
    if (block->mode < 0)
        return false;
    const ki_uastc_mode *mode = &ki_uastc_modes[block->mode];
    uint8_t stored[16] = {0};
    int count = values_of_end(mode), all = count * mode->subsets;
    get_numbers(&b, stored, all, ki_uastc_ranges[mode->values]);
    for (int s = 0; s < mode->subsets; s++)
        for (int i = 0; i < count; i++)
            block->value[s][i] =
                (uint8_t)ki_uastc_value(stored[s * count + i], ki_uastc_ranges[mode->values]);
    get_numbers(&backwards, stored, 16, ki_uastc_ranges[mode->weights]);
    for (int i = 0; i < 16; i++)
        block->index[i] = (uint8_t)index_of_weight(stored[i], mode->weights);
    return finite_ends(block);
}

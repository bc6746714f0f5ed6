// The Huffman codes of PIZ and DWA. In: packed bytes. Out: symbols of 16 bits. The codes are
// canonical, with up to 58 bits, for 65536 symbols and one more that stands for a run. In canonical
// order longer codes come first: if codes are padded with zeros to 64 bits, all codes of a shorter
// length are above those of a longer one.
#include "base/bytes.h"
#include "codec/exr.h"

#include <string.h>

enum {
    SYMBOLS = 65537,
    // Longest code in bits that is read. The format allows 58 bits, but no chunk has enough symbols
    // to need more than 56.
    LONGEST = 56,
    SHORT_ZEROS = 59, // stored code lengths 59 to 62 mean that 2 to 5 symbols do not occur
    // the stored code length 63, with 8 more bits, means that 6 to 261 symbols do not occur
    LONG_ZEROS = 63,
    TABLE_BITS = 13,
    PART = 1 << 20, // symbols, or bytes of them, between two calls of ki_exr_go_on
};

typedef struct decoder {
    uint8_t length[SYMBOLS];
    // all symbols that occur, sorted by the length of their codes, the longest first, then by
    // number
    uint32_t symbol[SYMBOLS];
    // Table indexed by the next TABLE_BITS bits of the input. The entry is symbol << 6 | length of
    // the code with which these bits begin, or 0 where the code is longer than TABLE_BITS.
    uint32_t table[1 << TABLE_BITS];
    uint64_t first[LONGEST + 1]; // lowest code of each length in bits
    uint32_t count[LONGEST + 1], start[LONGEST + 1];
} decoder;

// The input as bits, the most significant bit of each byte first. After the end of the input zeros
// are read; `spent` counts all bits that were used.
typedef struct bits {
    const uint8_t *at, *end;
    uint64_t held; // bits that were read but not used, from the highest bit on
    int held_count;
    uint64_t spent;
} bits;

// Reads bytes of the input until at least 57 bits wait in `held`.
static inline void fill(bits *b)
{
    if (b->held_count > 56)
        return;
    if (b->end - b->at >= 8) {
        uint64_t next;
        memcpy(&next, b->at, sizeof next);
        b->held |= __builtin_bswap64(next) >> b->held_count;
        int bytes = (64 - b->held_count) / 8;
        b->at += bytes;
        b->held_count += 8 * bytes;
        return;
    }
    while (b->held_count <= 56) {
        uint64_t byte = b->at < b->end ? *b->at : 0;
        b->at += b->at < b->end;
        b->held |= byte << (56 - b->held_count);
        b->held_count += 8;
    }
}

static inline void drop(bits *b, int count)
{
    b->held <<= count;
    b->held_count -= count;
    b->spent += (uint64_t)count;
}

static inline uint32_t take(bits *b, int count)
{
    fill(b);
    uint32_t value = (uint32_t)(b->held >> (64 - count));
    drop(b, count);
    return value;
}

// Reads the lengths of the codes of the symbols low .. high.
static bool read_lengths(bits *b, uint32_t low, uint32_t high, decoder *d)
{
    memset(d->length, 0, sizeof d->length);
    for (uint32_t s = low; s <= high; s++) {
        uint32_t value = take(b, 6);
        if (value > LONGEST && value < SHORT_ZEROS)
            return false;
        if (value < SHORT_ZEROS) {
            d->length[s] = (uint8_t)value;
            continue;
        }
        uint32_t zeros = value == LONG_ZEROS ? take(b, 8) + 6 : value - SHORT_ZEROS + 2;
        if (zeros > high + 1 - s)
            return false;
        s += zeros - 1;
    }
    return true;
}

// From the codes' lengths, computes the lowest code of each length, sorts the symbols and fills the
// table of codes of at most TABLE_BITS bits.
static bool build(decoder *d, uint32_t low, uint32_t high)
{
    memset(d->count, 0, sizeof d->count);
    for (uint32_t s = low; s <= high; s++)
        d->count[d->length[s]]++;
    uint64_t code = 0;
    uint32_t start = 0;
    for (int l = LONGEST; l > 0; l--) {
        uint64_t next = (code + d->count[l]) >> 1;
        d->first[l] = code;
        d->start[l] = start;
        start += d->count[l];
        if (d->first[l] + d->count[l] > (uint64_t)1 << l)
            return false;
        code = next;
    }
    uint32_t used[LONGEST + 1] = {0};
    memset(d->table, 0, sizeof d->table);
    for (uint32_t s = low; s <= high; s++) {
        int l = d->length[s];
        if (!l)
            continue;
        uint32_t index = used[l]++;
        d->symbol[d->start[l] + index] = s;
        if (l > TABLE_BITS)
            continue;
        uint64_t from = (d->first[l] + index) << (TABLE_BITS - l);
        for (uint64_t i = 0; i < (uint64_t)1 << (TABLE_BITS - l); i++)
            d->table[from + i] = s << 6 | (uint32_t)l;
    }
    return true;
}

static inline bool next_symbol(const decoder *d, bits *b, uint32_t *symbol)
{
    fill(b);
    uint32_t entry = d->table[b->held >> (64 - TABLE_BITS)];
    if (entry) {
        *symbol = entry >> 6;
        drop(b, (int)(entry & 63));
        return true;
    }
    for (int l = TABLE_BITS + 1; l <= LONGEST; l++) {
        uint64_t index = (b->held >> (64 - l)) - d->first[l];
        if (index < d->count[l]) {
            *symbol = d->symbol[d->start[l] + index];
            drop(b, l);
            return true;
        }
    }
    return false;
}

// Decodes symbols until *done, the number of those decoded, reaches `end`, or until PART bytes of
// the input were read: it may hold any number of runs of length 0. Fails where a run is too long
// for `count` symbols.
static bool decode_part(const decoder *d, bits *b, uint64_t bit_count, uint32_t run_symbol,
                        size_t end, uint16_t *symbols, size_t count, size_t *done)
{
    size_t out = *done;
    for (uint64_t most = b->spent + 8 * (uint64_t)PART; out < end && b->spent < most;) {
        uint32_t symbol;
        if (!next_symbol(d, b, &symbol) || b->spent > bit_count)
            return false;
        if (symbol != run_symbol) {
            symbols[out++] = (uint16_t)symbol;
            continue;
        }
        uint32_t run = take(b, 8);
        if (out == 0 || run > count - out || b->spent > bit_count)
            return false;
        uint16_t last = symbols[out - 1];
        for (uint32_t i = 0; i < run; i++)
            symbols[out++] = last;
    }
    *done = out;
    return true;
}

static bool decode(ki_exr_workspace *work, decoder *d, const uint8_t *packed, size_t packed_size,
                   uint16_t *symbols, size_t count)
{
    ki_reader r = ki_reader_make(packed, packed_size);
    uint32_t low = ki_read_u32(&r), high = ki_read_u32(&r);
    ki_read_u32(&r); // skips the number of bytes of the code lengths
    uint64_t bit_count = ki_read_u32(&r);
    ki_read_u32(&r);
    if (r.failed || low >= SYMBOLS || high >= SYMBOLS || low > high)
        return false;

    bits b = {.at = r.at, .end = r.end};
    if (!read_lengths(&b, low, high, d) || !build(d, low, high))
        return false;
    size_t table_size = (size_t)((b.spent + 7) / 8);
    if (table_size > ki_reader_left(&r) || (bit_count + 7) / 8 > ki_reader_left(&r) - table_size)
        return false;

    const uint8_t *data = r.at + table_size;
    b = (bits){.at = data, .end = data + (bit_count + 7) / 8};
    for (size_t at = 0, from = 0; at < count; from = at) {
        uint64_t spent = b.spent;
        size_t end = count - at < PART ? count : at + PART;
        if (!decode_part(d, &b, bit_count, high, end, symbols, count, &at) ||
            !ki_exr_go_on(work, (at - from) * sizeof *symbols + (size_t)(b.spent - spent) / 8))
            return false;
    }
    return true;
}

kiln_result ki_exr_unpack_huffman(ki_exr_workspace *work, const uint8_t *packed, size_t packed_size,
                                  uint16_t *symbols, size_t count)
{
    decoder *d = ki_alloc_raw(work->context, 1, sizeof *d);
    if (!d)
        return KILN_ERROR_MEMORY;
    bool good = decode(work, d, packed, packed_size, symbols, count);
    ki_free(d);
    return good ? KILN_OK : KILN_ERROR_FORMAT;
}

// Compression to zlib data (RFC 1950, RFC 1951), for EXR and PNG files. In: plain bytes, whole or
// in parts. Out: zlib data that are the same for the same input in every build and on every
// machine, which a library that may or may not be present could not guarantee.
//
// Matches are found by chains of positions with the same hash of four bytes, the most recent
// position first. A match is dropped if the next position has a match that saves more ("lazy
// matching"), and a short match if its literals, by how often they occur, take fewer bits, as is
// common in filtered rows and halfs. Literals and matches are kept as items until the statistics
// change or the store is full. The block is then written in the shortest of deflate's three forms.
// All arithmetic is in integers.
#include "codec/deflate.h"
#include "codec/huffman.h"

#include <string.h>

enum {
    WINDOW = 1 << 15, // greatest distance back to the bytes that a match copies
    MIN_MATCH = 3,
    MAX_MATCH = 258,
    NEAR = 1 << 12, // greatest distance at which a match of only three bytes is used
    // number of earlier positions that the search for a match tries; half as many if a match is
    // known
    CHAIN = 24,
    NICE = 128, // length from which on a match is used without a search at the next position
    HASH_BITS = 15,
    NEAR_BITS = 12,
    ITEMS = 1 << 15, // greatest number of items in a block; an item is a literal byte or a match
    // number of items after which statistics are compared, to decide whether a new block begins
    LOOK = 512,
    LITERALS = 286,
    DISTANCES = 30,
    LENGTH_CODES = 19,
    END_OF_BLOCK = 256,
    // number of classes of items that the statistics count: eight of literals by their three
    // highest bits, short matches, and long matches
    CLASSES = 10,
    // estimated bits of a match without the bits of its distance, whose logarithm is added
    MATCH_BITS = 10,
    // a match of fewer bytes is used only if the bytes would cost more bits as literals
    SHORT_MATCH = 16,
};

struct ki_deflater {
    // Input: positions count from the first byte before the input that a match may refer to.
    const uint8_t *bytes;
    int32_t end, inserted; // all positions below `inserted` are in the hash chains
    int hash_bits;
    int32_t first[1 << HASH_BITS], threes[1 << NEAR_BITS], next[WINDOW];
    // Items of the current block. An item is a literal byte, or a match as length << 16 | distance.
    uint32_t items[ITEMS];
    // number of items of the block, and number of its items that `before` counts by class
    int count, looked;
    int32_t start, at; // position of the block's first byte, and the position after its last item
    uint32_t before[CLASSES], recent[CLASSES];
    uint8_t literal_cost[256]; // estimated bits of each byte as a literal, in eighths of a bit
    // Output, in which `held` bits of `bits` wait for a whole byte.
    uint8_t *out, *out_end;
    uint64_t bits;
    int held;
    bool full;
    uint32_t sum;
    uint32_t literal_counts[LITERALS], distance_counts[DISTANCES];
    ki_huffman_code literals, distances, lengths;
    uint8_t length_code[MAX_MATCH + 1];
};

// ------------------------------------------------------------------------------------------ output

static const uint16_t length_from[29] = {3,  4,  5,  6,   7,   8,   9,   10,  11, 13,
                                         15, 17, 19, 23,  27,  31,  35,  43,  51, 59,
                                         67, 83, 99, 115, 131, 163, 195, 227, 258};

// Returns the number of extra bits after a length symbol. `symbol` counts from deflate's 257.
static int length_extra(int symbol)
{
    return symbol < 8 || symbol == 28 ? 0 : symbol / 4 - 1;
}

static int log2_of(uint32_t x)
{
    return 31 - __builtin_clz(x);
}

// Returns the logarithm to base 2 in eighths, rounded down. The fraction is linear: the three bits
// after the highest bit.
static uint32_t log2_eighths(uint32_t x)
{
    int log = log2_of(x);
    uint32_t fraction = log < 3 ? x << (3 - log) : x >> (log - 3);
    return 8 * (uint32_t)log + (fraction & 7);
}

static int distance_symbol(uint32_t distance)
{
    if (distance < 3)
        return (int)distance - 1;
    int log = log2_of(distance - 1);
    return 2 * log + (int)((distance - 1) >> (log - 1) & 1);
}

static int distance_extra(int symbol)
{
    return symbol < 4 ? 0 : symbol / 2 - 1;
}

// Writes the whole bytes that wait in d->bits. The caller has checked the room in the output.
static void flush(ki_deflater *d)
{
    if (d->out_end - d->out >= 8) {
        memcpy(d->out, &d->bits, sizeof d->bits);
        d->out += d->held >> 3;
        d->bits >>= d->held & ~7;
        d->held &= 7;
        return;
    }
    for (; d->held >= 8; d->held -= 8, d->bits >>= 8)
        *d->out++ = (uint8_t)d->bits;
}

// Appends at most 16 bits to those that wait for output. At most 48 bits may be appended without a
// call of flush().
static void put(ki_deflater *d, uint32_t value, int count)
{
    d->bits |= (uint64_t)value << d->held;
    d->held += count;
}

static void put_flush(ki_deflater *d, uint32_t value, int count)
{
    put(d, value, count);
    flush(d);
}

// Returns whether `bits` more bits, rounded up to bytes, fit in the output; sets `full` if not.
static bool fits(ki_deflater *d, uint64_t bits)
{
    d->full = d->full || ((uint64_t)d->held + bits + 7) / 8 > (uint64_t)(d->out_end - d->out);
    return !d->full;
}

// ------------------------------------------------------------------------------------------ blocks

static void make_fixed_codes(ki_deflater *d)
{
    int with[16] = {[7] = 24, [8] = 152, [9] = 112}, with_distances[16] = {[5] = 32};
    for (int i = 0; i < LITERALS + 2; i++)
        d->literals.length[i] = i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8;
    memset(d->distances.length, 5, DISTANCES);
    ki_huffman_assign(&d->literals, LITERALS + 2, with, 9);
    ki_huffman_assign(&d->distances, DISTANCES, with_distances, 5);
}

// The code lengths of the literal code and of the distance code, as a block's header stores them:
// compressed by a third code. Bits 0 to 4 of an item are a symbol of the third code, the bits from
// 8 on the symbol's extra bits.
typedef struct header {
    uint16_t items[LITERALS + DISTANCES];
    int count, literals, distances, lengths;
    uint64_t bits;
} header;

static const uint8_t length_order[LENGTH_CODES] = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                   11, 4,  12, 3, 13, 2, 14, 1, 15};

static int item_extra(int symbol)
{
    return symbol == 16 ? 2 : symbol == 17 ? 3 : symbol == 18 ? 7 : 0;
}

static void add_item(header *h, int symbol, int follows)
{
    h->items[h->count++] = (uint16_t)(follows << 8 | symbol);
}

// Adds a run of equal code lengths to a block's header. Symbol 16 repeats the previous length 3 to
// 6 times, symbols 17 and 18 stand for 3 to 10 and 11 to 138 zeros.
static void add_run(header *h, int length, int run)
{
    if (length) {
        add_item(h, length, 0);
        for (run--; run >= 3; run -= ki_min(run, 6))
            add_item(h, 16, ki_min(run, 6) - 3);
    } else {
        for (; run >= 11; run -= ki_min(run, 138))
            add_item(h, 18, ki_min(run, 138) - 11);
        if (run >= 3) {
            add_item(h, 17, run - 3);
            run = 0;
        }
    }
    for (; run > 0; run--)
        add_item(h, length, 0);
}

static void make_header(ki_deflater *d, header *h)
{
    uint8_t all[LITERALS + DISTANCES];
    uint32_t counts[LENGTH_CODES] = {0};
    h->count = 0;
    h->literals = LITERALS;
    h->distances = DISTANCES;
    while (!d->literals.length[h->literals - 1])
        h->literals--; // h->literals stays at least 257: symbol 256, end of block, always occurs
    while (h->distances > 1 && !d->distances.length[h->distances - 1])
        h->distances--;
    memcpy(all, d->literals.length, (size_t)h->literals);
    memcpy(all + h->literals, d->distances.length, (size_t)h->distances);
    int total = h->literals + h->distances;
    for (int i = 0, run; i < total; i += run) {
        for (run = 1; i + run < total && all[i + run] == all[i];)
            run++;
        add_run(h, all[i], run);
    }
    for (int i = 0; i < h->count; i++)
        counts[h->items[i] & 31]++;
    ki_huffman_make(&d->lengths, counts, LENGTH_CODES, 7);
    h->lengths = LENGTH_CODES;
    // h->lengths stays at least 5: the end-of-block symbol has a length from 1 to 15, and these
    // come after the first four numbers of length_order.
    while (!d->lengths.length[length_order[h->lengths - 1]])
        h->lengths--;
    h->bits = 14 + 3 * (uint64_t)h->lengths;
    for (int i = 0; i < LENGTH_CODES; i++)
        h->bits += counts[i] * (uint64_t)(d->lengths.length[i] + item_extra(i));
}

static void put_header(ki_deflater *d, const header *h)
{
    put(d, (uint32_t)h->literals - 257, 5);
    put(d, (uint32_t)h->distances - 1, 5);
    put_flush(d, (uint32_t)h->lengths - 4, 4);
    for (int i = 0; i < h->lengths; i++)
        put_flush(d, d->lengths.length[length_order[i]], 3);
    for (int i = 0; i < h->count; i++) {
        int symbol = h->items[i] & 31;
        put(d, d->lengths.bits[symbol], d->lengths.length[symbol]);
        put_flush(d, (uint32_t)h->items[i] >> 8, item_extra(symbol));
    }
}

static void count_items(ki_deflater *d, int count)
{
    memset(d->literal_counts, 0, sizeof d->literal_counts);
    memset(d->distance_counts, 0, sizeof d->distance_counts);
    for (int i = 0; i < count; i++) {
        uint32_t item = d->items[i];
        if (item < 256) {
            d->literal_counts[item]++;
        } else {
            d->literal_counts[257 + d->length_code[item >> 16]]++;
            d->distance_counts[distance_symbol(item & 0xffff)]++;
        }
    }
    d->literal_counts[END_OF_BLOCK] = 1;
}

// Returns the number of bits of a block's items (literals and matches), including the end of the
// block, by the current codes.
static uint64_t item_bits(const ki_deflater *d)
{
    uint64_t bits = 0;
    for (int i = 0; i < LITERALS; i++)
        bits += d->literal_counts[i] *
                (uint64_t)(d->literals.length[i] + (i > END_OF_BLOCK ? length_extra(i - 257) : 0));
    for (int i = 0; i < DISTANCES; i++)
        bits += d->distance_counts[i] * (uint64_t)(d->distances.length[i] + distance_extra(i));
    return bits;
}

static void put_items(ki_deflater *d, int count)
{
    for (int i = 0; i < count; i++) {
        uint32_t item = d->items[i];
        if (d->held > 15)
            flush(d);
        if (item < 256) {
            put(d, d->literals.bits[item], d->literals.length[item]);
            continue;
        }
        uint32_t length = item >> 16, distance = item & 0xffff;
        int range = d->length_code[length], symbol = distance_symbol(distance);
        uint32_t from = symbol < 4 ? (uint32_t)symbol + 1
                                   : ((2U + (uint32_t)symbol % 2) << distance_extra(symbol)) + 1;
        put(d, d->literals.bits[257 + range], d->literals.length[257 + range]);
        put(d, length - length_from[range], length_extra(range));
        put(d, d->distances.bits[symbol], d->distances.length[symbol]);
        put(d, distance - from, distance_extra(symbol));
    }
    flush(d);
    put_flush(d, d->literals.bits[END_OF_BLOCK], d->literals.length[END_OF_BLOCK]);
}

static uint64_t stored_bits(size_t size)
{
    size_t pieces = size ? (size + 65534) / 65535 : 1;
    // An uncompressed block is cut into pieces of at most 65535 bytes. Each piece takes 3 bits of
    // header, up to 7 bits of padding, and 32 bits for its length.
    return 8 * (uint64_t)size + 42 * (uint64_t)pieces;
}

static void put_stored(ki_deflater *d, const uint8_t *bytes, size_t size, bool last)
{
    do {
        size_t count = size < 65535 ? size : 65535;
        size -= count;
        put_flush(d, last && !size, 3);
        put_flush(d, 0, -d->held & 7);
        put_flush(d, (uint32_t)count, 16);
        put_flush(d, (uint32_t)~count & 0xffff, 16);
        // put_flush() has written all bits that waited, since the padding above ends at a byte
        memcpy(d->out, bytes, count);
        d->out += count;
        bytes += count;
    } while (size);
}

// Writes the first `count` items as a block in the shortest of deflate's three forms: with codes of
// its own, with the fixed codes, or uncompressed. The items stand for the bytes from d->start to
// `end`. Nothing is written if the block does not fit in the output.
static void put_block(ki_deflater *d, int count, int32_t end, bool last)
{
    size_t size = (size_t)(end - d->start);
    header h;
    count_items(d, count);
    make_fixed_codes(d);
    uint64_t fixed = item_bits(d), stored = stored_bits(size);
    ki_huffman_make(&d->literals, d->literal_counts, LITERALS, 15);
    ki_huffman_make(&d->distances, d->distance_counts, DISTANCES, 15);
    make_header(d, &h);
    uint64_t own = h.bits + item_bits(d), least = own < fixed ? own : fixed;
    if (!fits(d, stored < least + 3 ? stored : least + 3))
        return;
    if (stored < least + 3) {
        put_stored(d, d->bytes + d->start, size, last);
        return;
    }
    put_flush(d, (uint32_t)last | (own < fixed ? 2U : 1U) << 1, 3);
    if (own < fixed)
        put_header(d, &h);
    else
        make_fixed_codes(d);
    put_items(d, count);
}

// Writes the first `count` items as a block. The other items are kept as the beginning of the next
// block.
static void write_block(ki_deflater *d, int count, int32_t end, bool last)
{
    if (!d->full)
        put_block(d, count, end, last);
    d->count -= count;
    memmove(d->items, d->items + count, (size_t)d->count * sizeof *d->items);
    d->start = end;
    d->looked = 0;
    memset(d->before, 0, sizeof d->before);
}

// --------------------------------------------------------------------------------------- splitting

// Returns whether the latest items differ in kind from the earlier items of the block. Both are
// counted by class (`recent` and `before`), and the two distributions differ in kind if the sum of
// the differences of their shares exceeds a third.
static bool is_new_kind(const ki_deflater *d)
{
    uint64_t old = (uint64_t)d->looked, new = (uint64_t)(d->count - d->looked), difference = 0;
    for (int i = 0; i < CLASSES; i++) {
        uint64_t a = d->before[i] * new, b = d->recent[i] * old;
        difference += a > b ? a - b : b - a;
    }
    return 3 * difference > old * new;
}

// Called after every LOOK items. If the latest items are of a new kind, ends the block before them,
// at the position `before_recent`.
static void compare_statistics(ki_deflater *d, int32_t before_recent)
{
    if (d->looked >= 4 * LOOK && is_new_kind(d))
        write_block(d, d->looked, before_recent, false);
    for (int i = 0; i < CLASSES; i++)
        d->before[i] += d->recent[i];
    memset(d->recent, 0, sizeof d->recent);
    d->looked = d->count;
}

// ----------------------------------------------------------------------------------------- matches

static uint32_t load32(const uint8_t *bytes)
{
    uint32_t value;
    memcpy(&value, bytes, sizeof value);
    return value;
}

static uint32_t hash4(const ki_deflater *d, uint32_t value)
{
    return value * 0x9e3779b1U >> (32 - d->hash_bits);
}

static uint32_t hash3(uint32_t value)
{
    return (value << 8) * 0x9e3779b1U >> (32 - NEAR_BITS);
}

// Inserts the positions below `until` into the hash chains. The last three positions of the input
// have no four bytes to hash.
static inline void insert(ki_deflater *d, int32_t until)
{
    until = until < d->end - 3 ? until : d->end - 3;
    for (; d->inserted < until; d->inserted++) {
        uint32_t value = load32(d->bytes + d->inserted), h = hash4(d, value);
        d->next[d->inserted & (WINDOW - 1)] = d->first[h];
        d->first[h] = d->inserted;
        d->threes[hash3(value)] = d->inserted;
    }
}

static int32_t common_bytes(const uint8_t *a, const uint8_t *b, int32_t length, int32_t most)
{
    while (length + 8 <= most) {
        uint64_t x, y;
        memcpy(&x, a + length, 8);
        memcpy(&y, b + length, 8);
        if (x != y)
            return length + (__builtin_ctzll(x ^ y) >> 3);
        length += 8;
    }
    while (length < most && a[length] == b[length])
        length++;
    return length;
}

typedef struct match {
    int32_t length, distance;
} match;

// Finds the longest match at a position, if it is longer than `best` bytes, by trying at most
// `tries` earlier positions. Otherwise returns the length `best` and distance 0.
static inline match find(ki_deflater *d, int32_t position, int32_t best, int tries)
{
    match found = {best, 0};
    const uint8_t *here = d->bytes + position;
    int32_t most = ki_min(MAX_MATCH, d->end - position), oldest = position - WINDOW;
    insert(d, position);
    if (most < 4 || best >= most)
        return found;
    uint32_t value = load32(here);
    int32_t candidate = d->threes[hash3(value)];
    if (best < MIN_MATCH && candidate > position - NEAR && candidate >= 0 &&
        !((load32(d->bytes + candidate) ^ value) << 8))
        found = (match){MIN_MATCH, position - candidate};
    candidate = d->first[hash4(d, value)];
    for (; candidate > oldest && candidate >= 0 && tries > 0; tries--) {
        const uint8_t *there = d->bytes + candidate;
        if (load32(there) == value && (found.length < 4 || load32(there + found.length - 3) ==
                                                               load32(here + found.length - 3))) {
            int32_t length = common_bytes(here, there, 4, most);
            if (length > found.length) {
                found = (match){length, position - candidate};
                if (length >= NICE || length == most)
                    break;
            }
        }
        candidate = d->next[candidate & (WINDOW - 1)];
    }
    return found;
}

static void add(ki_deflater *d, uint32_t item, int32_t length)
{
    if (d->count == ITEMS)
        write_block(d, ITEMS, d->at, false);
    d->items[d->count++] = item;
    d->at += length;
    d->recent[item < 256 ? item >> 5 : length < 9 ? 8 : 9]++;
}

// Estimates the bits of each byte as a literal: the negative logarithm to base 2 of its share of
// the input, at most 15 bits.
static void estimate_literals(ki_deflater *d)
{
    uint32_t counts[256] = {0}, most = 8 * 15;
    for (int32_t i = d->at; i < d->end; i++)
        counts[d->bytes[i]]++;
    uint32_t all = log2_eighths((uint32_t)(d->end - d->at));
    for (int i = 0; i < 256; i++) {
        uint32_t cost = counts[i] ? all - log2_eighths(counts[i]) : most;
        d->literal_cost[i] = (uint8_t)(cost < most ? cost : most);
    }
}

// Returns whether a match takes fewer bits than its bytes would take as literals.
static bool pays(const ki_deflater *d, match m)
{
    if (!m.distance || m.length >= SHORT_MATCH)
        return m.distance > 0;
    int literals = 0, cost = 8 * (MATCH_BITS + log2_of((uint32_t)m.distance));
    for (int32_t i = 0; i < m.length; i++)
        literals += d->literal_cost[d->bytes[d->at + i]];
    return cost < literals;
}

// Finds the items (literals and matches) that represent the bytes from `at` to the end.
static void compress(ki_deflater *d)
{
    int32_t look_at = d->at;
    if (d->at < d->end)
        estimate_literals(d);
    while (d->at < d->end && !d->full) {
        match m = find(d, d->at, MIN_MATCH - 1, CHAIN);
        bool taken = pays(d, m);
        while (taken && m.length < NICE) {
            match later = find(d, d->at + 1, m.length - 1, CHAIN / 2);
            // one byte more in the length is worth as much as four bits less in the distance
            int gain = 4 * (later.length - m.length);
            if (!later.distance ||
                gain + log2_of((uint32_t)m.distance) - log2_of((uint32_t)later.distance) <= 2)
                break;
            add(d, d->bytes[d->at], 1);
            m = later;
        }
        if (taken)
            add(d, (uint32_t)m.length << 16 | (uint32_t)m.distance, m.length);
        else
            add(d, d->bytes[d->at], 1);
        if (d->count - d->looked >= LOOK) {
            compare_statistics(d, look_at);
            look_at = d->at;
        }
    }
}

// --------------------------------------------------------------------------------------------- all

ki_deflater *ki_deflater_create(kiln_context *context)
{
    ki_deflater *d = ki_alloc(context, 1, sizeof *d);
    for (int range = 0; d && range < 29; range++)
        for (int length = length_from[range]; length <= MAX_MATCH; length++)
            d->length_code[length] = (uint8_t)range;
    return d;
}

void ki_deflater_free(ki_deflater *d)
{
    ki_free(d);
}

size_t ki_deflate_bound(size_t size)
{
    // No block is longer than its bytes stored uncompressed. Each block but the last has at least 4
    // * LOOK items, and each item stands for at least one byte.
    size_t blocks = size / ((size_t)4 * LOOK) + 1;
    return (size_t)(stored_bits(size) / 8) + 6 * blocks + 16;
}

size_t ki_deflate_part(ki_deflater *d, const uint8_t *plain, size_t history, size_t size, int place,
                       uint8_t *packed, size_t room)
{
    history = history < WINDOW ? history : WINDOW;
    d->bytes = plain - history;
    d->end = (int32_t)(history + size);
    d->inserted = 0;
    d->start = d->at = (int32_t)history;
    d->count = d->looked = 0;
    memset(d->before, 0, sizeof d->before);
    memset(d->recent, 0, sizeof d->recent);
    // a short input gets a small hash table, because the table must be cleared for each input
    d->hash_bits = 10;
    while (d->hash_bits < HASH_BITS && d->end >> d->hash_bits)
        d->hash_bits++;
    memset(d->first, 0xff, sizeof *d->first << d->hash_bits);
    memset(d->threes, 0xff, sizeof d->threes);
    d->out = packed;
    d->out_end = packed + room;
    d->full = room < 2;
    if (place & KI_DEFLATE_FIRST && !d->full) {
        // zlib's header, which states deflate, a window of 32768 bytes and default compression
        d->bits = 0x9c78;
        d->held = 16;
        d->sum = 1;
        flush(d);
    }
    d->sum = ki_adler32(d->sum, plain, size);
    compress(d);
    bool last = place & KI_DEFLATE_LAST;
    if (!d->full && (d->count || last))
        write_block(d, d->count, d->end, last);
    if (last && fits(d, 32)) {
        put_flush(d, 0, -d->held & 7);
        for (int i = 24; i >= 0; i -= 8)
            put_flush(d, d->sum >> i & 255, 8);
    }
    return d->full ? 0 : (size_t)(d->out - packed);
}

size_t ki_deflate(ki_deflater *d, const uint8_t *plain, size_t size, uint8_t *packed, size_t room)
{
    return ki_deflate_part(d, plain, 0, size, KI_DEFLATE_FIRST | KI_DEFLATE_LAST, packed, room);
}

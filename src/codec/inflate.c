// Decompression of zlib's format (RFC 1950, RFC 1951), for EXR, PNG and KTX2 files. In: zlib data
// that are not trusted. Out: exactly as many bytes as the caller asks for. The code here lets kiln be
// built with nothing but a C compiler. If kiln is built with libdeflate (KILN_DEFLATE), that
// library decompresses whole buffers, which is faster and gives the same bytes. It cannot be
// stopped, so that long data are left to the code here.
//
// Method: the next bits of the input are the index of a table, whose entry gives the symbol. Codes
// longer than that index continue in a second table. While input and output have room to spare,
// eight bytes are read and copied at a time. The last bytes are handled singly.
#include "codec/deflate.h"
#include "codec/huffman.h"

#include <string.h>

enum {
    LONGEST = 15,
    LITERALS = 288,
    DISTANCES = 32,
    LENGTH_CODES = 19,
    LITERAL_BITS = 11, // number of bits that index the first table of the literal code
    DISTANCE_BITS = 8,
    LENGTH_BITS = 7,
    // A second table of 2^k entries serves at least k + 1 codes, and k is at most 4 for literals
    // and 7 for distances. This bounds the number of entries in all second tables of a code.
    LITERAL_ROOM = (1 << LITERAL_BITS) + LITERALS * 16 / 5,
    DISTANCE_ROOM = (1 << DISTANCE_BITS) + DISTANCES * 128 / 8,
};

// An entry of a table that decodes symbols. Bits 0 to 3 are the length of the symbol's code (in a
// second table: of the part of the code that the first table's index lacks), bits 4 to 7 the number
// of extra bits, bits 8 to 10 the kind, and the bits from 16 on the symbol's value.
enum { KIND_BAD, KIND_LITERAL, KIND_RANGE, KIND_END, KIND_TABLE };
#define ENTRY(kind, value, extra)                                                                  \
    ((uint32_t)(value) << 16 | (uint32_t)(kind) << 8 | (uint32_t)(extra) << 4)

static inline uint32_t kind_of(uint32_t entry)
{
    return entry >> 8 & 7;
}

// The input as a sequence of bits. The bits in `bits` are already read from the input; the next of
// them is the lowest.
typedef struct stream {
    const uint8_t *in, *in_end;
    uint64_t bits;
    // Number of bits in `bits`, and how many of these are zeros added after the end of the input.
    int held, missing;
} stream;

typedef struct state {
    stream s;
    uint8_t *out, *begin, *end;
    bool full;             // set when the output has no room for the next symbol's bytes
    const ki_asker *asker; // who is asked whether to go on; NULL: nobody
    uint8_t *pause;        // place in the output where the next question is due, or its end
    bool stopped;          // set when the answer was to stop
    bool fixed;            // the tables are those of the fixed codes
    uint32_t literals[LITERAL_ROOM], distances[DISTANCE_ROOM];
} state;

// -------------------------------------------------------------------------------------------- bits

// Reads bytes of the input until at least 57 bits wait in `bits`.
static inline void fill(stream *s)
{
    while (s->held <= 56) {
        s->missing += s->in == s->in_end ? 8 : 0;
        s->bits |= (uint64_t)(s->in < s->in_end ? *s->in++ : 0) << s->held;
        s->held += 8;
    }
}

// Reads bytes of the input until at least 56 bits wait in `bits`; at least eight bytes of input
// must be left. The bits above those that `held` counts are already the input's next bits.
static inline void fill_fast(stream *s)
{
    uint64_t next;
    memcpy(&next, s->in, sizeof next);
    s->bits |= next << s->held;
    s->in += (63 - s->held) >> 3;
    s->held |= 56;
}

// Returns whether more bits were used than the input holds.
static inline bool overdrawn(const stream *s)
{
    return s->missing > s->held;
}

static inline uint32_t drop(stream *s, uint32_t count)
{
    uint32_t value = (uint32_t)(s->bits & (((uint64_t)1 << count) - 1));
    s->bits >>= count;
    s->held -= (int)count;
    return value;
}

// Returns the next `count` bits of the input, at most 32, and consumes them.
static inline uint32_t take(stream *s, uint32_t count)
{
    fill(s);
    return drop(s, count);
}

// ------------------------------------------------------------------------------------------- codes

// A function that makes the table entry of a symbol, with 0 as the length of its code.
typedef uint32_t meaning(int symbol);

static uint32_t plain_meaning(int symbol)
{
    return ENTRY(KIND_LITERAL, symbol, 0);
}

static uint32_t literal_meaning(int symbol)
{
    static const uint16_t from[29] = {3,  4,  5,  6,   7,   8,   9,   10,  11, 13,
                                      15, 17, 19, 23,  27,  31,  35,  43,  51, 59,
                                      67, 83, 99, 115, 131, 163, 195, 227, 258};
    if (symbol < 256)
        return ENTRY(KIND_LITERAL, symbol, 0);
    if (symbol == 256)
        return ENTRY(KIND_END, 0, 0);
    if (symbol > 285)
        return ENTRY(KIND_BAD, 0, 0);
    int code = symbol - 257;
    return ENTRY(KIND_RANGE, from[code], code < 8 || code == 28 ? 0 : code / 4 - 1);
}

static uint32_t distance_meaning(int symbol)
{
    if (symbol > 29)
        return ENTRY(KIND_BAD, 0, 0);
    int extra = symbol < 4 ? 0 : symbol / 2 - 1;
    int from = symbol < 4 ? symbol + 1 : ((2 + symbol % 2) << extra) + 1;
    return ENTRY(KIND_RANGE, from, extra);
}

// A table of a Huffman code that is being built. `with` holds the number of codes of each length,
// `sorted` the symbols by the length of their codes and then by number.
typedef struct table {
    uint32_t *entries;
    size_t room, size;
    int bits; // number of bits that index the first table
    uint16_t with[LONGEST + 1], sorted[LITERALS];
} table;

// Sorts the symbols by the length of their codes. Returns false if the lengths belong to no code,
// or leave bit sequences without a symbol in a code of more than one symbol.
static bool sort(table *t, const uint8_t *lengths, int count)
{
    uint16_t place[LONGEST + 2] = {0};
    for (int i = 0; i < count; i++)
        t->with[lengths[i]]++;
    int used = count - t->with[0], free_codes = 1;
    for (int length = 1; length <= LONGEST; length++) {
        free_codes = 2 * free_codes - t->with[length];
        if (free_codes < 0)
            return false;
        place[length + 1] = (uint16_t)(place[length] + t->with[length]);
    }
    if (free_codes > 0 && used > 1)
        return false;
    for (int i = 0; i < count; i++)
        if (lengths[i])
            t->sorted[place[lengths[i]]++] = (uint16_t)i;
    return true;
}

// Adds a second table for the codes that begin with the bits `prefix`; the k-th code of `length`
// bits is the first of these codes. The table is as large as the longest of these codes needs.
// Returns the number of bits that index the table, or 0 if there is no room for it.
static int add_second(table *t, uint32_t prefix, int length, int k)
{
    int bits = length - t->bits, left = (1 << bits) - (t->with[length] - k);
    while (left > 0 && t->bits + bits < LONGEST) {
        bits++;
        left = 2 * left - t->with[t->bits + bits];
    }
    if (t->room - t->size < (size_t)1 << bits)
        return 0;
    t->entries[prefix] = ENTRY(KIND_TABLE, t->size, bits) | (uint32_t)t->bits;
    memset(t->entries + t->size, 0, sizeof *t->entries << bits);
    t->size += (size_t)1 << bits;
    return bits;
}

// Builds the table of a Huffman code of `count` symbols from the lengths of their codes, which are
// 0 for symbols that do not occur. Returns false if no code has these lengths.
static bool build(uint32_t *entries, size_t room, int bits, const uint8_t *lengths, int count,
                  meaning *mean)
{
    table t = {.entries = entries, .room = room, .size = (size_t)1 << bits, .bits = bits};
    if (!sort(&t, lengths, count))
        return false;
    memset(entries, 0, sizeof *entries << bits);
    uint32_t next = 0, mask = (1U << bits) - 1, prefix = UINT32_MAX;
    int second_bits = 0;
    const uint16_t *symbol = t.sorted;
    for (int length = 1; length <= LONGEST; length++, next <<= 1)
        for (int k = 0; k < t.with[length]; k++, next++) {
            uint32_t code = ki_reverse_bits(next, length), entry = mean(*symbol++);
            if (length <= bits) {
                for (uint32_t i = code; i <= mask; i += 1U << length)
                    entries[i] = entry | (uint32_t)length;
                continue;
            }
            if ((code & mask) != prefix) {
                prefix = code & mask;
                second_bits = add_second(&t, prefix, length, k);
                if (!second_bits)
                    return false;
            }
            uint32_t *second = entries + t.size - ((size_t)1 << second_bits);
            for (uint32_t i = code >> bits; i < 1U << second_bits; i += 1U << (length - bits))
                second[i] = entry | (uint32_t)(length - bits);
        }
    return true;
}

// Returns the table entry of the next symbol in the input and consumes the symbol's code. At least
// 15 bits must be held.
static inline uint32_t next_entry(stream *s, const uint32_t *entries, int bits)
{
    uint32_t entry = entries[s->bits & ((1U << bits) - 1)];
    drop(s, entry & 15);
    if (kind_of(entry) == KIND_TABLE) {
        entry = entries[(entry >> 16) + (s->bits & ((1U << (entry >> 4 & 15)) - 1))];
        drop(s, entry & 15);
    }
    return entry;
}

// Returns the value of a table entry plus the number in the extra bits that follow in the input.
static inline size_t value_of(stream *s, uint32_t entry)
{
    return (entry >> 16) + drop(s, entry >> 4 & 15);
}

// --------------------------------------------------------------------------------------- questions

enum { PART = 1 << 24 }; // bytes of output between two questions whether to go on

static void find_pause(state *st)
{
    bool last = !st->asker || st->end - st->out <= PART;
    st->pause = last ? st->end : st->out + PART;
}

// Asks whether to go on.
static bool go_on(state *st)
{
    find_pause(st);
    st->stopped = st->asker && !ki_may_go_on(st->asker);
    return !st->stopped;
}

// ------------------------------------------------------------------------------------------ blocks

static bool stored(state *st)
{
    stream *s = &st->s;
    drop(s, (uint32_t)s->held & 7); // skips to the next byte boundary of the input
    size_t count = take(s, 16), inverse = take(s, 16), left = (size_t)(st->end - st->out);
    if (count != (~inverse & 0xffff))
        return false;
    bool full = left < count;
    if (full)
        count = left;
    for (; count && s->held; count--)
        *st->out++ = (uint8_t)drop(s, 8);
    if (overdrawn(s) || (size_t)(s->in_end - s->in) < count)
        return false;
    // set only here, where the input is known to be long enough and the held bytes are written
    st->full = full;
    if (count) {
        memcpy(st->out, s->in, count);
        s->bits = 0;
    }
    s->in += count;
    st->out += count;
    return !st->full;
}

// While this many bytes of input and output remain, checks are left out: eight bytes are read at a
// time, and two literals and a match of 258 bytes are written, with up to seven bytes after the
// match.
enum { SPARE_IN = 16, SPARE_OUT = 258 + 2 + 7 };

// Copies a match, and may write up to seven bytes after it.
static inline void copy_match(uint8_t *out, size_t distance, size_t length)
{
    const uint8_t *from = out - distance;
    if (distance >= 8) {
        for (size_t i = 0; i < length; i += 8)
            memcpy(out + i, from + i, 8);
    } else if (distance == 1) {
        memset(out, *from, length);
    } else {
        for (size_t i = 0; i < length; i++)
            out[i] = from[i];
    }
}

typedef enum step { GO_ON, BLOCK_ENDS, DAMAGED } step;

static step fast_symbols(state *st)
{
    stream s = st->s;
    uint8_t *out = st->out;
    step result = GO_ON;
    while (s.in_end - s.in >= SPARE_IN && st->pause - out >= SPARE_OUT) {
        fill_fast(&s);
        uint32_t entry = next_entry(&s, st->literals, LITERAL_BITS);
        if (kind_of(entry) == KIND_LITERAL) {
            *out++ = (uint8_t)(entry >> 16);
            entry = next_entry(&s, st->literals, LITERAL_BITS);
            if (kind_of(entry) == KIND_LITERAL) {
                *out++ = (uint8_t)(entry >> 16);
                continue;
            }
            fill_fast(&s);
        }
        if (kind_of(entry) != KIND_RANGE) {
            result = kind_of(entry) == KIND_END ? BLOCK_ENDS : DAMAGED;
            break;
        }
        size_t length = value_of(&s, entry);
        entry = next_entry(&s, st->distances, DISTANCE_BITS);
        size_t distance = value_of(&s, entry);
        if (kind_of(entry) != KIND_RANGE || distance > (size_t)(out - st->begin)) {
            result = DAMAGED;
            break;
        }
        copy_match(out, distance, length);
        out += length;
    }
    st->s = s;
    st->out = out;
    return result;
}

// Decodes one symbol, and for a match also its distance, near the end of the input or the output.
static step careful_symbol(state *st)
{
    stream *s = &st->s;
    size_t left = (size_t)(st->end - st->out);
    fill(s);
    uint32_t entry = next_entry(s, st->literals, LITERAL_BITS);
    if (overdrawn(s) || kind_of(entry) == KIND_BAD)
        return DAMAGED;
    if (kind_of(entry) == KIND_END)
        return BLOCK_ENDS;
    if (kind_of(entry) == KIND_LITERAL) {
        st->full = !left;
        if (left)
            *st->out++ = (uint8_t)(entry >> 16);
        return left ? GO_ON : DAMAGED;
    }
    size_t length = value_of(s, entry);
    entry = next_entry(s, st->distances, DISTANCE_BITS);
    size_t distance = value_of(s, entry);
    if (overdrawn(s) || kind_of(entry) != KIND_RANGE || distance > (size_t)(st->out - st->begin))
        return DAMAGED;
    st->full = length > left;
    for (size_t n = st->full ? left : length; n; n--, st->out++)
        *st->out = *(st->out - distance);
    return st->full ? DAMAGED : GO_ON;
}

static bool compressed(state *st)
{
    step result = fast_symbols(st);
    while (result == GO_ON) {
        if (st->pause < st->end && st->pause - st->out < SPARE_OUT && !go_on(st))
            return false;
        result = careful_symbol(st);
        // Symbols are read without checks whenever input and output have enough room.
        if (result == GO_ON && st->pause - st->out >= SPARE_OUT &&
            st->s.in_end - st->s.in >= SPARE_IN)
            result = fast_symbols(st);
    }
    return result == BLOCK_ENDS;
}

static bool build_both(state *st, const uint8_t *lengths, int literals, int distances)
{
    return build(st->literals, LITERAL_ROOM, LITERAL_BITS, lengths, literals, literal_meaning) &&
           build(st->distances, DISTANCE_ROOM, DISTANCE_BITS, lengths + literals, distances,
                 distance_meaning);
}

static bool fixed_codes(state *st)
{
    uint8_t lengths[LITERALS + DISTANCES];
    if (st->fixed)
        return true;
    st->fixed = true;
    for (int i = 0; i < LITERALS; i++)
        lengths[i] = i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8;
    memset(lengths + LITERALS, 5, DISTANCES);
    return build_both(st, lengths, LITERALS, DISTANCES);
}

// Reads the code lengths of a block's symbols. They are coded as lengths and as runs of the
// previous length or of 0.
static bool read_lengths(state *st, uint8_t *lengths, int total)
{
    stream *s = &st->s;
    for (int i = 0; i < total;) {
        fill(s);
        uint32_t entry = next_entry(s, st->distances, LENGTH_BITS), symbol = entry >> 16;
        if (kind_of(entry) != KIND_LITERAL || overdrawn(s))
            return false;
        if (symbol < 16) {
            lengths[i++] = (uint8_t)symbol;
            continue;
        }
        if (symbol == 16 && i == 0)
            return false;
        uint8_t repeated = symbol == 16 ? lengths[i - 1] : 0;
        int times = symbol == 16   ? 3 + (int)take(s, 2)
                    : symbol == 17 ? 3 + (int)take(s, 3)
                                   : 11 + (int)take(s, 7);
        if (times > total - i)
            return false;
        memset(lengths + i, repeated, (size_t)times);
        i += times;
    }
    return true;
}

static bool own_codes(state *st)
{
    static const uint8_t order[LENGTH_CODES] = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                11, 4,  12, 3, 13, 2, 14, 1, 15};
    stream *s = &st->s;
    int literals = (int)take(s, 5) + 257, distances = (int)take(s, 5) + 1;
    int count = (int)take(s, 4) + 4;
    uint8_t lengths[LITERALS + DISTANCES] = {0};
    st->fixed = false;
    if (literals > 286 || distances > 30)
        return false;
    for (int i = 0; i < count; i++)
        lengths[order[i]] = (uint8_t)take(s, 3);
    if (!build(st->distances, DISTANCE_ROOM, LENGTH_BITS, lengths, LENGTH_CODES, plain_meaning))
        return false;
    memset(lengths, 0, sizeof lengths);
    return read_lengths(st, lengths, literals + distances) && lengths[256] &&
           build_both(st, lengths, literals, distances);
}

// --------------------------------------------------------------------------------------------- all

// Decompresses all blocks. Returns false if the data are damaged, are cut off, or exceed the
// output.
static bool unpack(state *st)
{
    // number of blocks after which the caller is asked whether to go on, since blocks may be empty
    enum { BLOCKS = 4096 };
    bool last = false, good = true;
    for (unsigned i = 1; good && !last; i++) {
        if (i % BLOCKS == 0 && !go_on(st))
            return false;
        last = take(&st->s, 1);
        uint32_t kind = take(&st->s, 2);
        good = kind == 0   ? stored(st)
               : kind == 1 ? fixed_codes(st) && compressed(st)
               : kind == 2 ? own_codes(st) && compressed(st)
                           : false;
    }
    return good;
}

// Prepares decompression. Returns false unless the data begin with zlib's header of two bytes.
// `asker` is NULL if nobody is to be asked whether to go on.
static bool begin(state *st, const ki_asker *asker, const uint8_t *packed, size_t packed_size,
                  uint8_t *plain, size_t size)
{
    st->asker = asker;
    st->full = st->stopped = st->fixed = false;
    if (packed_size < 6 || (packed[0] & 15) != 8 || packed[1] & 0x20 ||
        !ki_checksum_agrees((uint32_t)(packed[0] << 8 | packed[1]) % 31, 0))
        return false;
    st->s = (stream){.in = packed + 2, .in_end = packed + packed_size};
    st->out = st->begin = plain;
    st->end = plain + size;
    find_pause(st);
    return true;
}

// Computes the checksum of the output. Returns false if the caller asks to stop.
static bool add_up(state *st, uint32_t *sum)
{
    size_t size = (size_t)(st->end - st->begin), part = PART;
    *sum = 1;
    for (size_t at = 0; at < size; at += part) {
        if (at && st->asker && !go_on(st))
            return false;
        part = size - at < PART ? size - at : PART;
        *sum = ki_adler32(*sum, st->begin + at, part);
    }
    return true;
}

// Returns whether the blocks, all of which are unpacked, fill the output and have its checksum.
static bool is_whole(state *st)
{
    uint32_t stated = 0, sum;
    if (st->out != st->end || !add_up(st, &sum))
        return false;
    drop(&st->s, (uint32_t)st->s.held & 7);
    for (int i = 0; i < 4; i++)
        stated = stated << 8 | take(&st->s, 8);
    return !overdrawn(&st->s) && ki_checksum_agrees(sum, stated);
}

bool ki_inflate_own(const uint8_t *packed, size_t packed_size, uint8_t *plain, size_t size)
{
    state st;
    return begin(&st, NULL, packed, packed_size, plain, size) && unpack(&st) && is_whole(&st);
}

bool ki_inflate_beginning(const uint8_t *packed, size_t packed_size, uint8_t *plain, size_t size)
{
    state st;
    return begin(&st, NULL, packed, packed_size, plain, size) && !unpack(&st) && st.full;
}

kiln_result ki_inflate_long(const ki_asker *asker, const uint8_t *packed, size_t packed_size,
                            uint8_t *plain, size_t size, bool may_hold_more)
{
    // PLAIN bytes take about a tenth of a second. PACKED bytes may be blocks without content, whose
    // tables take half a second.
    enum { PLAIN = 1 << 26, PACKED = 1 << 21 };
    state st;
    if (packed_size <= PACKED && size <= PLAIN)
        return ki_inflate(packed, packed_size, plain, size) ||
                       (may_hold_more && ki_inflate_beginning(packed, packed_size, plain, size))
                   ? KILN_OK
                   : KILN_ERROR_FORMAT;
    bool good = begin(&st, asker, packed, packed_size, plain, size) && unpack(&st) && is_whole(&st);
    return st.stopped                           ? KILN_ERROR_CANCELLED
           : good || (may_hold_more && st.full) ? KILN_OK
                                                : KILN_ERROR_FORMAT;
}

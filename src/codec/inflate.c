// zlib's format (RFC 1950, RFC 1951) into a buffer of known size, where libdeflate is left out.
#include "codec/deflate.h"

#include <string.h>

enum { LONGEST = 15, LITERALS = 288, DISTANCES = 30, LENGTHS = 19, FAST = 9 };

typedef struct code {
    uint16_t count[LONGEST + 1]; // codes of each length
    uint16_t symbol[LITERALS];   // in the order of their codes
    uint16_t fast[1 << FAST];    // symbol << 4 | length by the next bits, 0 for longer codes
} code;

typedef struct state {
    const uint8_t *in, *in_end;
    uint8_t *out, *begin, *end;
    uint64_t bits;
    int held, missing; // bits held; zeros held that the input does not have
    code literals, distances;
} state;

static inline void fill(state *s)
{
    while (s->held <= 56) {
        s->missing += s->in == s->in_end ? 8 : 0;
        s->bits |= (uint64_t)(s->in < s->in_end ? *s->in++ : 0) << s->held;
        s->held += 8;
    }
}

// More was used than the input holds.
static inline bool overdrawn(const state *s)
{
    return s->missing > s->held;
}

// Up to 32 bits, the first the lowest.
static inline uint32_t take(state *s, int count)
{
    fill(s);
    uint32_t value = (uint32_t)(s->bits & (((uint64_t)1 << count) - 1));
    s->bits >>= count;
    s->held -= count;
    return value;
}

// Codes by their lengths, 0 for symbols that do not occur. False where there are more codes than
// bits allow, or fewer, but for a single one.
static bool build(code *c, const uint8_t *lengths, int symbol_count)
{
    memset(c, 0, sizeof *c);
    for (int i = 0; i < symbol_count; i++)
        c->count[lengths[i]]++;
    int used = symbol_count - c->count[0];
    c->count[0] = 0;
    uint16_t place[LONGEST + 2] = {0};
    int free_codes = 1;
    for (int length = 1; length <= LONGEST; length++) {
        free_codes = 2 * free_codes - c->count[length];
        if (free_codes < 0)
            return false;
        place[length + 1] = (uint16_t)(place[length] + c->count[length]);
    }
    if (free_codes > 0 && used > 1)
        return false;
    for (int i = 0; i < symbol_count; i++)
        if (lengths[i])
            c->symbol[place[lengths[i]]++] = (uint16_t)i;
    uint32_t next = 0;
    int at = 0;
    for (int length = 1; length <= FAST; length++, next <<= 1)
        for (int k = 0; k < c->count[length]; k++, next++, at++) {
            uint32_t turned = 0; // codes come highest bit first
            for (int b = 0; b < length; b++)
                turned |= (next >> b & 1) << (length - 1 - b);
            for (uint32_t i = turned; i < 1U << FAST; i += 1U << length)
                c->fast[i] = (uint16_t)(c->symbol[at] << 4 | length);
        }
    return true;
}

// The next symbol, or -1.
static inline int decode(state *s, const code *c)
{
    fill(s);
    uint16_t found = c->fast[s->bits & ((1 << FAST) - 1)];
    if (found) {
        s->bits >>= found & 15;
        s->held -= found & 15;
        return found >> 4;
    }
    int value = 0, first = 0, index = 0;
    for (int length = 1; length <= LONGEST; length++) {
        value |= (int)(s->bits >> (length - 1) & 1);
        int count = c->count[length];
        if (value - first < count) {
            s->bits >>= length;
            s->held -= length;
            return c->symbol[index + value - first];
        }
        index += count;
        first = (first + count) << 1;
        value <<= 1;
    }
    return -1;
}

static bool stored(state *s)
{
    take(s, s->held & 7); // to the next byte
    uint32_t count = take(s, 16), inverse = take(s, 16);
    if (count != (~inverse & 0xffff) || (size_t)(s->end - s->out) < count)
        return false;
    for (; count && !overdrawn(s); count--)
        *s->out++ = (uint8_t)take(s, 8);
    return !overdrawn(s);
}

static bool compressed(state *s)
{
    static const uint16_t length_from[29] = {3,  4,  5,  6,   7,   8,   9,   10,  11, 13,
                                             15, 17, 19, 23,  27,  31,  35,  43,  51, 59,
                                             67, 83, 99, 115, 131, 163, 195, 227, 258};
    static const uint8_t length_bits[29] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                            2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};
    static const uint16_t distance_from[DISTANCES] = {
        1,   2,   3,   4,   5,   7,    9,    13,   17,   25,   33,   49,   65,    97,    129,
        193, 257, 385, 513, 769, 1025, 1537, 2049, 3073, 4097, 6145, 8193, 12289, 16385, 24577};
    for (;;) {
        int symbol = decode(s, &s->literals);
        if (symbol < 0 || overdrawn(s))
            return false;
        if (symbol < 256) {
            if (s->out == s->end)
                return false;
            *s->out++ = (uint8_t)symbol;
            continue;
        }
        if (symbol == 256)
            return true;
        if (symbol > 285)
            return false;
        size_t length = length_from[symbol - 257] + take(s, length_bits[symbol - 257]);
        int far = decode(s, &s->distances);
        if (far < 0 || far >= DISTANCES)
            return false;
        size_t distance = distance_from[far] + take(s, far < 4 ? 0 : far / 2 - 1);
        if (distance > (size_t)(s->out - s->begin) || length > (size_t)(s->end - s->out))
            return false;
        for (const uint8_t *from = s->out - distance; length; length--)
            *s->out++ = *from++;
    }
}

static bool fixed_codes(state *s)
{
    uint8_t lengths[LITERALS];
    for (int i = 0; i < LITERALS; i++)
        lengths[i] = i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8;
    bool good = build(&s->literals, lengths, LITERALS);
    memset(lengths, 5, 32);
    return build(&s->distances, lengths, 32) && good;
}

static bool own_codes(state *s)
{
    static const uint8_t order[LENGTHS] = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                           11, 4,  12, 3, 13, 2, 14, 1, 15};
    int literals = (int)take(s, 5) + 257, distances = (int)take(s, 5) + 1;
    int count = (int)take(s, 4) + 4, total = literals + distances;
    uint8_t lengths[LITERALS + 32] = {0};
    if (literals > 286 || distances > DISTANCES)
        return false;
    for (int i = 0; i < count; i++)
        lengths[order[i]] = (uint8_t)take(s, 3);
    if (!build(&s->distances, lengths, LENGTHS))
        return false;
    memset(lengths, 0, sizeof lengths);
    for (int i = 0; i < total;) {
        int symbol = decode(s, &s->distances);
        if (symbol < 0 || overdrawn(s))
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
    return lengths[256] && build(&s->literals, lengths, literals) &&
           build(&s->distances, lengths + literals, distances);
}

static uint32_t adler(const uint8_t *bytes, size_t size)
{
    uint32_t a = 1, b = 0;
    while (size) {
        size_t count = size < 5552 ? size : 5552; // sums that do not overflow
        for (size_t i = 0; i < count; i++) {
            a += bytes[i];
            b += a;
        }
        a %= 65521;
        b %= 65521;
        bytes += count;
        size -= count;
    }
    return b << 16 | a;
}

bool ki_inflate(const uint8_t *packed, size_t packed_size, uint8_t *raw, size_t size)
{
    if (packed_size < 6 || (packed[0] & 15) != 8 || (packed[0] << 8 | packed[1]) % 31 ||
        packed[1] & 0x20)
        return false;
    state s = {.in = packed + 2,
               .in_end = packed + packed_size,
               .out = raw,
               .begin = raw,
               .end = raw + size};
    bool last = false, good = true;
    while (good && !last) {
        last = take(&s, 1);
        uint32_t kind = take(&s, 2);
        good = kind == 0   ? stored(&s)
               : kind == 1 ? fixed_codes(&s) && compressed(&s)
               : kind == 2 ? own_codes(&s) && compressed(&s)
                           : false;
    }
    take(&s, s.held & 7);
    uint32_t sum = 0;
    for (int i = 0; i < 4; i++)
        sum = sum << 8 | take(&s, 8);
    return good && s.out == s.end && !overdrawn(&s) && sum == adler(raw, size);
}

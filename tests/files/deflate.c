// zlib data: what zlib packs comes back, what kiln packs is read by zlib, and what is damaged does
// not pass for whole.
#include "codec/deflate.h"

#include <zlib.h>

#include "kit/context.h"

enum { MOST = 70000, KINDS = 6 };

// Noise, steps, few symbols, text with far matches, zeros, and two kinds one after the other.
static void fill(uint8_t *plain, size_t size, int kind)
{
    uint64_t seed = 1;
    for (size_t i = 0; i < size; i++) {
        uint32_t n = (uint32_t)random_bits(&seed);
        uint8_t few = n & 1U << 27 ? (uint8_t)(n >> 28) : 0;
        uint8_t far = i % 33000 < 100 ? (uint8_t)(i % 33000) : (uint8_t)(n >> 24 & 7);
        plain[i] = kind == 0      ? (uint8_t)(n >> 24)
                   : kind == 1    ? (uint8_t)(i / 300)
                   : kind == 2    ? few
                   : kind == 3    ? far
                   : kind == 4    ? 0
                   : i < size / 2 ? few
                                  : (uint8_t)(128 + (n >> 30));
    }
}

static void inflates_what_zlib_deflates(void **state)
{
    (void)state;
    static uint8_t plain[MOST], packed[2 * MOST], back[MOST];
    static const size_t sizes[] = {0, 1, 2, 100, 5000, MOST};
    for (int level = 0; level <= 9; level++)
        for (int kind = 0; kind < KINDS; kind++)
            for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
                size_t size = sizes[k];
                fill(plain, size, kind);
                uLongf length = sizeof packed;
                assert_int_equal(compress2(packed, &length, plain, size, level), Z_OK);
                memset(back, 77, sizeof back);
                assert_true(ki_inflate_own(packed, length, back, size));
                assert_memory_equal(back, plain, size);
                memset(back, 77, sizeof back);
                assert_true(ki_inflate(packed, length, back, size));
                assert_memory_equal(back, plain, size);
                assert_false(size && ki_inflate_own(packed, length, back, size - 1));
                assert_false(size < MOST && ki_inflate_own(packed, length, back, size + 1));
                assert_false(ki_inflate_own(packed, length - 1, back, size));
                for (size_t i = 0; i < length; i += 1 + length / 50) {
                    packed[i] ^= 0x55;
                    assert_false(ki_inflate_own(packed, length, back, size) &&
                                 memcmp(back, plain, size) != 0);
                    packed[i] ^= 0x55;
                }
            }
}

// Data that goes on behind what is wanted, as some writers of PNG leave it.
static void a_beginning_is_inflated(void **state)
{
    (void)state;
    static uint8_t plain[MOST], packed[2 * MOST], back[MOST];
    for (int kind = 0; kind < KINDS; kind++)
        for (int level = 0; level <= 9; level += 3) {
            fill(plain, MOST, kind);
            uLongf length = sizeof packed;
            assert_int_equal(compress2(packed, &length, plain, MOST, level), Z_OK);
            for (size_t size = 1; size < MOST; size = 3 * size + 1) {
                memset(back, 77, sizeof back);
                assert_true(ki_inflate_beginning(packed, length, back, size));
                assert_memory_equal(back, plain, size);
                assert_int_equal(back[size], 77); // nothing is written behind
            }
            assert_false(ki_inflate_beginning(packed, length, back, MOST));
            assert_false(ki_inflate_beginning(packed, length / 2, back, MOST));
        }
}

// A stored block that states more bytes than the output holds, but is cut off before the output is
// filled: the bytes that are missing must not be taken for decompressed ones.
static void a_stored_block_without_its_bytes_is_no_beginning(void **state)
{
    (void)state;
    enum { HELD = 40, SIZE = 1000 };
    uint8_t packed[7 + SIZE] = {0x78, 0x01, 0, 0xff, 0xff, 0, 0}, back[SIZE];
    for (size_t held = 0; held < SIZE; held += HELD)
        assert_false(ki_inflate_beginning(packed, 7 + held, back, SIZE));
    memset(back, 77, sizeof back);
    assert_true(ki_inflate_beginning(packed, 7 + SIZE, back, SIZE));
    for (int i = 0; i < SIZE; i++)
        assert_int_equal(back[i], 0);
}

// Blocks of fixed codes and blocks with codes of their own, in turn.
static void kinds_of_blocks_may_alternate(void **state)
{
    (void)state;
    enum { PARTS = 8, SIZE = MOST / PARTS * PARTS };
    static uint8_t plain[MOST], packed[2 * MOST], back[MOST];
    z_stream z = {.next_in = plain, .next_out = packed, .avail_out = sizeof packed};
    fill(plain, MOST, 2);
    assert_int_equal(deflateInit(&z, 6), Z_OK);
    for (int i = 0; i < PARTS; i++) {
        assert_int_equal(deflateParams(&z, 6, i / 2 % 2 ? Z_DEFAULT_STRATEGY : Z_FIXED), Z_OK);
        z.avail_in = MOST / PARTS;
        int wanted = i == PARTS - 1 ? Z_STREAM_END : Z_OK;
        assert_int_equal(deflate(&z, wanted == Z_OK ? Z_FULL_FLUSH : Z_FINISH), wanted);
    }
    assert_true(ki_inflate_own(packed, z.total_out, back, SIZE));
    assert_memory_equal(back, plain, SIZE);
    deflateEnd(&z);
}

// More than 2^26 bytes, which are inflated by kiln's own code, with questions whether to go on.
static void long_data_are_inflated(void **state)
{
    (void)state;
    enum { SIZE = (1 << 26) + 12345, ROOM = 1 << 20 };
    uint8_t *plain = malloc(SIZE), *back = malloc(SIZE), *packed = malloc(ROOM);
    uLongf length = ROOM;
    ki_asker asker = ki_asker_make(context);
    assert_true(plain && back && packed);
    for (size_t i = 0; i < SIZE; i++)
        plain[i] = (uint8_t)(i >> 13);
    assert_int_equal(compress2(packed, &length, plain, SIZE, 1), Z_OK);
    assert_int_equal(ki_inflate_long(&asker, packed, length, back, SIZE, false), KILN_OK);
    assert_memory_equal(back, plain, SIZE);
    assert_int_equal(ki_inflate_long(&asker, packed, length, back, SIZE - 1, false),
                     KILN_ERROR_FORMAT);
    assert_int_equal(ki_inflate_long(&asker, packed, length, back, SIZE - 1, true), KILN_OK);
    packed[length - 1] ^= 1; // a byte of the checksum
    assert_int_equal(ki_inflate_long(&asker, packed, length, back, SIZE, true), KILN_ERROR_FORMAT);
    free(plain);
    free(back);
    free(packed);
}

static void check_packed(const uint8_t *packed, size_t length, const uint8_t *plain, size_t size)
{
    static uint8_t back[MOST + 1];
    uLongf got = size + 1;
    assert_int_equal(uncompress(back, &got, packed, length), Z_OK);
    assert_int_equal(got, size);
    assert_memory_equal(back, plain, size);
    assert_true(ki_inflate_own(packed, length, back, size));
    assert_true(ki_inflate(packed, length, back, size));
    assert_memory_equal(back, plain, size);
}

// zlib reads what is packed, which is about as short as zlib's own data, and fits exactly or not at
// all.
static void zlib_inflates_what_is_deflated(void **state)
{
    (void)state;
    static uint8_t plain[MOST], packed[2 * MOST], by_zlib[2 * MOST];
    static const size_t sizes[] = {0, 1, 2, 3, 4, 5, 100, 259, 5000, 40000, MOST};
    ki_deflater *deflater = ki_deflater_create(context);
    assert_non_null(deflater);
    for (int kind = 0; kind < KINDS; kind++)
        for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
            size_t size = sizes[k];
            fill(plain, size, kind);
            size_t length = ki_deflate(deflater, plain, size, packed, sizeof packed);
            assert_true(length > 0 && length <= ki_deflate_bound(size));
            check_packed(packed, length, plain, size);
            uLongf other = sizeof by_zlib;
            assert_int_equal(compress2(by_zlib, &other, plain, size, 6), Z_OK);
            if ((double)length > 1.02 * (double)other + 8)
                fail_msg("kind %d, %zu bytes: %zu, by zlib %zu", kind, size, length, (size_t)other);
            packed[length] = 77;
            assert_int_equal(ki_deflate(deflater, plain, size, packed, length), length);
            assert_int_equal(packed[length], 77);
            check_packed(packed, length, plain, size);
            for (size_t room = 0; room < length; room += 1 + length / 20)
                assert_int_equal(ki_deflate(deflater, plain, size, packed, room), 0);
            assert_int_equal(ki_deflate(deflater, plain, size, packed, length - 1), 0);
        }
    ki_deflater_free(deflater);
}

// Parts of any size, with the bytes before them or without, are one stream.
static void parts_are_one_stream(void **state)
{
    (void)state;
    static uint8_t plain[MOST], packed[3 * MOST];
    static const size_t parts[] = {1, 7, 300, 4000, 33000, 50000};
    ki_deflater *deflater = ki_deflater_create(context);
    assert_non_null(deflater);
    for (int kind = 0; kind < KINDS; kind++)
        for (size_t k = 0; k < sizeof parts / sizeof *parts; k++)
            for (int known = 0; known < 2; known++) {
                size_t size = parts[k] < 100 ? 300 : MOST, length = 0;
                fill(plain, size, kind);
                for (size_t at = 0; at < size; at += parts[k]) {
                    size_t count = size - at < parts[k] ? size - at : parts[k];
                    int place =
                        (at ? 0 : KI_DEFLATE_FIRST) | (at + count == size ? KI_DEFLATE_LAST : 0);
                    length += ki_deflate_part(deflater, plain + at, known ? at : 0, count, place,
                                              packed + length, ki_deflate_bound(count));
                }
                check_packed(packed, length, plain, size);
            }
    ki_deflater_free(deflater);
}

// Noise whose highest bit is more often set in every other stretch. Each stretch becomes a block of
// its own, and no block becomes shorter than its stored form.
static void fill_stretches(uint8_t *plain, size_t size, size_t stretch)
{
    uint64_t seed = 1;
    for (size_t i = 0; i < size; i++) {
        uint64_t random = random_bits(&seed);
        uint8_t byte = (uint8_t)(random >> 44), high = (uint8_t)(i / stretch % 2 * 128);
        bool skewed = (random >> 28 & 255) < 80;
        plain[i] = skewed ? (uint8_t)((byte & 127) | high) : byte;
    }
}

// The room of the bound is enough for data that cannot be compressed, whatever its number of
// blocks.
static void the_bound_is_enough_for_many_blocks(void **state)
{
    (void)state;
    enum { PART = 1 << 18 };
    static uint8_t plain[PART], packed[2 * PART], back[PART];
    ki_deflater *deflater = ki_deflater_create(context);
    assert_non_null(deflater);
    for (size_t stretch = 1024; stretch <= 8192; stretch += 1024) {
        fill_stretches(plain, PART, stretch);
        size_t needed = ki_deflate(deflater, plain, PART, packed, sizeof packed);
        if (stretch == 2048)
            assert_true(needed > PART + 600); // more than a hundred stored blocks
        assert_int_equal(ki_deflate(deflater, plain, PART, packed, ki_deflate_bound(PART)), needed);
        assert_true(ki_inflate_own(packed, needed, back, PART));
        assert_memory_equal(back, plain, PART);
    }
    ki_deflater_free(deflater);
}

static void sums_are_those_of_zlib(void **state)
{
    (void)state;
    static uint8_t bytes[MOST];
    static ki_crc32_table table;
    ki_crc32_fill(&table);
    fill(bytes, MOST, 0);
    memset(bytes + 20000, 255, 20000);
    for (size_t size = 0; size < MOST; size = size * 2 + 1)
        for (size_t from = 0; from < 9; from++) {
            assert_int_equal(ki_adler32(1, bytes + from, size),
                             adler32(1, bytes + from, (uInt)size));
            assert_int_equal(ki_crc32(&table, 0, bytes + from, size),
                             crc32(0, bytes + from, (uInt)size));
            uint32_t begun = ki_crc32(&table, 0, bytes, from);
            assert_int_equal(ki_crc32(&table, begun, bytes + from, size),
                             crc32(0, bytes, (uInt)(from + size)));
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(inflates_what_zlib_deflates),
        cmocka_unit_test(a_beginning_is_inflated),
        cmocka_unit_test(kinds_of_blocks_may_alternate),
        cmocka_unit_test(long_data_are_inflated),
        cmocka_unit_test(zlib_inflates_what_is_deflated),
        cmocka_unit_test(parts_are_one_stream),
        cmocka_unit_test(a_stored_block_without_its_bytes_is_no_beginning),
        cmocka_unit_test(the_bound_is_enough_for_many_blocks),
        cmocka_unit_test(sums_are_those_of_zlib),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}

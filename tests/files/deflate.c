// zlib data: what libdeflate packs comes back, and what is damaged does not pass for whole.
#include "codec/deflate.h"
#include "check.h"

#include <libdeflate.h>

static void inflates_what_was_deflated(void **state)
{
    (void)state;
    enum { MOST = 70000 };
    static uint8_t plain[MOST], packed[2 * MOST], back[MOST];
    static const size_t sizes[] = {0, 1, 2, 100, 5000, MOST};
    for (int level = 0; level <= 12; level++)
        for (int kind = 0; kind < 3; kind++)
            for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
                size_t size = sizes[k];
                for (size_t i = 0; i < size; i++) {
                    uint32_t n = (uint32_t)i * 2654435761U;
                    plain[i] = (uint8_t)(kind == 0   ? n >> 24
                                         : kind == 1 ? i / 300
                                                     : (n & 1U << 27 ? n >> 28 : 0));
                }
                struct libdeflate_compressor *c = libdeflate_alloc_compressor(level);
                size_t length = libdeflate_zlib_compress(c, plain, size, packed, sizeof packed);
                libdeflate_free_compressor(c);
                assert_true(length > 0);
                memset(back, 77, sizeof back);
                assert_true(ki_inflate(packed, length, back, size));
                assert_memory_equal(back, plain, size);
                assert_false(size && ki_inflate(packed, length, back, size - 1));
                assert_false(size < MOST && ki_inflate(packed, length, back, size + 1));
                assert_false(ki_inflate(packed, length - 1, back, size));
                for (size_t i = 0; i < length; i += 1 + length / 50) {
                    packed[i] ^= 0x55;
                    assert_false(ki_inflate(packed, length, back, size) &&
                                 memcmp(back, plain, size) != 0);
                    packed[i] ^= 0x55;
                }
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(inflates_what_was_deflated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

// The checksum of files, XXH64, against published values and against itself in pieces.
#include "../../cli/hash.h"

#include "kit/kit.h"

#include <errno.h>

static void published_values(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        uint64_t hash;
    } known[] = {
        {"", 0xef46db3751d8e999},
        {"a", 0xd24ec4f1a98c6e5b},
        {"abc", 0x44bc2cf5ad770999},
        {"Nobody inspects the spammish repetition", 0xfbcea83c8a378bf1},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        assert_true(hash_bytes(known[i].text, strlen(known[i].text)) == known[i].hash);
}

// Files are read in pieces of 64 kB, and hashed in pieces of 32 bytes.
static void a_file_has_the_checksum_of_its_bytes(void **state)
{
    (void)state;
    static const size_t sizes[] = {0, 1, 31, 32, 33, 65535, 65536, 65537, 200000};
    static unsigned char bytes[200000];
    char path[512];
    uint64_t hash, before = 0;
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = (unsigned char)(i * i >> 7 ^ i);
    folder_make();
    snprintf(path, sizeof path, "%s/file", folder_path());
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        write_file(path, bytes, sizes[i]);
        assert_true(hash_file(path, &hash));
        assert_true(hash == hash_bytes(bytes, sizes[i]));
        assert_true(hash != before);
        before = hash;
    }
    snprintf(path, sizeof path, "%s/none", folder_path());
    assert_false(hash_file(path, &hash));
    assert_int_equal(errno, ENOENT);
    folder_remove();
}

static void every_bit_counts(void **state)
{
    (void)state;
    unsigned char bytes[80] = {0};
    uint64_t zero = hash_bytes(bytes, sizeof bytes);
    for (size_t i = 0; i < 8 * sizeof bytes; i++) {
        bytes[i / 8] ^= (unsigned char)(1 << i % 8);
        assert_true(hash_bytes(bytes, sizeof bytes) != zero);
        bytes[i / 8] ^= (unsigned char)(1 << i % 8);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(published_values),
        cmocka_unit_test(a_file_has_the_checksum_of_its_bytes),
        cmocka_unit_test(every_bit_counts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

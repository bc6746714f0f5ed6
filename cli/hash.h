// A checksum that tells whether files are equal: XXH64 with the seed 0.
#ifndef KILN_CLI_HASH_H
#define KILN_CLI_HASH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Returns the checksum of `size` bytes. Unequal bytes have equal checksums by chance with a
/// probability of 2^-64; checksums do not protect against bytes that are chosen to be mistaken.
uint64_t hash_bytes(const void *bytes, size_t size);
/// Sets *hash to the checksum of the content of a file, which equals hash_bytes of the content.
/// Returns false and sets errno if the file cannot be read.
bool hash_file(const char *path, uint64_t *hash);

#endif

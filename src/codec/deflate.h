// zlib's format (RFC 1950, RFC 1951), which EXR and PNG files hold, and the sums that stand in them.
#ifndef KI_DEFLATE_H
#define KI_DEFLATE_H

#include "base/base.h"

/// Unpacks zlib data into exactly `size` bytes; false where it is damaged or unpacks to another size.
bool ki_inflate(const uint8_t *packed, size_t packed_size, uint8_t *plain, size_t size);
/// The same by kiln's own code, whether or not the build has libdeflate.
bool ki_inflate_own(const uint8_t *packed, size_t packed_size, uint8_t *plain, size_t size);
/// Unpacks the first `size` bytes of data that has more; false where it has not. The sum behind the
/// data is not checked.
bool ki_inflate_beginning(const uint8_t *packed, size_t packed_size, uint8_t *plain, size_t size);

/// Packs bytes as zlib data, always the same ones for the same input. One object serves any number of
/// inputs, one after the other; NULL where memory is short.
typedef struct ki_deflater ki_deflater;
ki_deflater *ki_deflater_create(kiln_context *context);
void ki_deflater_free(ki_deflater *deflater);
/// Returns the number of bytes written to `packed`, or 0 where they are more than `room`.
size_t ki_deflate(ki_deflater *deflater, const uint8_t *plain, size_t size, uint8_t *packed,
                  size_t room);

/// One input in parts. The `history` bytes (32768 at most are looked at) before `plain` are those of
/// the parts before. The bytes of all parts, one after the other, are the zlib data. `room` must be
/// ki_deflate_bound(size) at least.
typedef enum ki_deflate_place {
    KI_DEFLATE_FIRST = 1,
    KI_DEFLATE_LAST = 2,
} ki_deflate_place;
size_t ki_deflate_part(ki_deflater *deflater, const uint8_t *plain, size_t history, size_t size,
                       int place, uint8_t *packed, size_t room);
size_t ki_deflate_bound(size_t size);

/// zlib's sum; 1 to begin with.
uint32_t ki_adler32(uint32_t sum, const uint8_t *bytes, size_t size);
/// PNG's sum; 0 to begin with. `table` is filled by ki_crc32_fill.
typedef struct ki_crc32_table {
    uint32_t sums[8][256];
} ki_crc32_table;
void ki_crc32_fill(ki_crc32_table *table);
uint32_t ki_crc32(const ki_crc32_table *table, uint32_t sum, const uint8_t *bytes, size_t size);

#endif

// zlib's format (RFC 1950, RFC 1951), as EXR and PNG files use it, and the checksums in these
// files.
#ifndef KI_DEFLATE_H
#define KI_DEFLATE_H

#include "base/base.h"

/// Decompresses zlib data into exactly `size` bytes. Returns false if the data are damaged or
/// decompress to another number of bytes.
bool ki_inflate(const uint8_t *packed, size_t packed_size, uint8_t *plain, size_t size);
/// Decompresses as ki_inflate does, but always by kiln's own code, even in a build with libdeflate.
bool ki_inflate_own(const uint8_t *packed, size_t packed_size, uint8_t *plain, size_t size);
/// Decompresses only the first `size` bytes. Returns false if the data hold fewer bytes. The
/// checksum after the data is not checked.
bool ki_inflate_beginning(const uint8_t *packed, size_t packed_size, uint8_t *plain, size_t size);
/// Decompresses as ki_inflate does, but asks from time to time whether to go on. `may_hold_more`
/// allows data that hold more bytes, of which the first are decompressed as ki_inflate_beginning
/// does. Returns KILN_OK, KILN_ERROR_FORMAT or KILN_ERROR_CANCELLED and writes no error message.
kiln_result ki_inflate_long(const ki_asker *asker, const uint8_t *packed, size_t packed_size,
                            uint8_t *plain, size_t size, bool may_hold_more);

/// Compresses bytes to zlib data, always to the same bytes for the same input. One object can
/// compress any number of inputs, one after the other. Creation returns NULL if memory runs out.
typedef struct ki_deflater ki_deflater;
ki_deflater *ki_deflater_create(kiln_context *context);
void ki_deflater_free(ki_deflater *deflater);
/// Compresses one input as a whole. Returns the number of bytes written to `packed`, or 0 if more
/// than `room` are needed.
size_t ki_deflate(ki_deflater *deflater, const uint8_t *plain, size_t size, uint8_t *packed,
                  size_t room);

/// Which part of the data ki_deflate_part compresses, for an input that is compressed in parts. The
/// outputs of all parts, joined, are the zlib data. The `history` bytes before `plain` (of which at
/// most 32768 are used) are the end of the parts before. `room` must be at least
/// ki_deflate_bound(size).
typedef enum ki_deflate_place {
    KI_DEFLATE_FIRST = 1,
    KI_DEFLATE_LAST = 2,
} ki_deflate_place;
size_t ki_deflate_part(ki_deflater *deflater, const uint8_t *plain, size_t history, size_t size,
                       int place, uint8_t *packed, size_t room);
size_t ki_deflate_bound(size_t size);

/// Adds bytes to zlib's checksum, Adler-32, and returns the new checksum. The checksum of no bytes
/// is 1.
uint32_t ki_adler32(uint32_t sum, const uint8_t *bytes, size_t size);
/// Adds bytes to PNG's checksum, CRC-32, whose value for no bytes is 0. ki_crc32_fill fills the
/// table.
typedef struct ki_crc32_table {
    uint32_t sums[8][256];
} ki_crc32_table;
void ki_crc32_fill(ki_crc32_table *table);
uint32_t ki_crc32(const ki_crc32_table *table, uint32_t sum, const uint8_t *bytes, size_t size);
/// Computes the CRC-32 of the bytes from 0 on, and asks whether to go on after each 2^24 bytes. If
/// the caller of the library wants to stop, returns the checksum of fewer bytes.
uint32_t ki_crc32_long(const ki_asker *asker, const ki_crc32_table *table, const uint8_t *bytes,
                       size_t size);
/// Returns whether a checksum that was computed from a file's bytes is the one that the file
/// states. Fuzz targets replace this function, since random changes of a file never give right
/// checksums.
bool ki_checksum_agrees(uint32_t computed, uint32_t stored);

#endif

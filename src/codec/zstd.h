// Compression by the zstd library, or functions that fail in a build without the library.
#ifndef KI_ZSTD_H
#define KI_ZSTD_H

#include "base/base.h"

/// Returns KILN_OK, or fails with the error message that this build of kiln has no zstd.
kiln_result ki_zstd_known(const char *name, kiln_error *error);

/// Returns the number of bytes that ki_zstd_pack may write for `size` bytes.
size_t ki_zstd_bound(size_t size);
/// Packs bytes into one zstd frame that states its uncompressed size, with compression level 1 to
/// 22. Returns KILN_OK, KILN_ERROR_MEMORY or KILN_ERROR_CANCELLED and writes no error message.
kiln_result ki_zstd_pack(kiln_context *context, const uint8_t *plain, size_t size, int level,
                         uint8_t *room, size_t bound, size_t *packed_size);

/// Sets *size to the uncompressed size that a zstd frame states. Returns false if the frame states
/// no size or is not a zstd frame.
bool ki_zstd_stated_size(const uint8_t *packed, size_t packed_size, uint64_t *size);
/// Unpacks zstd frames to exactly `size` bytes. Asks whether to go on after each 2^22 bytes, packed
/// and plain, if the library is of version 1.4.6 or later. Returns KILN_OK, KILN_ERROR_FORMAT, with
/// a text in *fault that says what is wrong, KILN_ERROR_MEMORY or KILN_ERROR_CANCELLED. Writes no
/// error message.
kiln_result ki_zstd_unpack(kiln_context *context, const uint8_t *packed, size_t packed_size,
                           uint8_t *plain, size_t size, const char **fault);

#endif

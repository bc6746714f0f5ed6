// zstd, by its library or not at all.
#ifndef KI_ZSTD_H
#define KI_ZSTD_H

#include "base/base.h"

/// KILN_OK, or the sentence that this build leaves zstd out.
kiln_result ki_zstd_known(const char *name, kiln_error *error);

/// Bytes to hold ready for packing `size`.
size_t ki_zstd_bound(size_t size);
/// One frame that states its size, `level` 1 to 22. KILN_OK, KILN_ERROR_MEMORY or
/// KILN_ERROR_CANCELLED, no sentence.
kiln_result ki_zstd_pack(kiln_context *context, const uint8_t *plain, size_t size, int level,
                         uint8_t *room, size_t bound, size_t *packed_size);

/// What a frame says that it holds; false where it says nothing or is none.
bool ki_zstd_stated_size(const uint8_t *packed, size_t packed_size, uint64_t *size);
/// Unpacks exactly `size` bytes; NULL, or what is wrong.
const char *ki_zstd_unpack(const uint8_t *packed, size_t packed_size, uint8_t *plain, size_t size);

#endif

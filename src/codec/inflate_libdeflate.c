// Decompression of zlib data by libdeflate, which is faster than kiln's own code and gives the same
// bytes.
#include "codec/deflate.h"

#include <libdeflate.h>

bool ki_inflate(const uint8_t *packed, size_t packed_size, uint8_t *plain, size_t size)
{
    struct libdeflate_decompressor *d = libdeflate_alloc_decompressor();
    if (!d)
        return false;
    enum libdeflate_result result =
        libdeflate_zlib_decompress(d, packed, packed_size, plain, size, NULL);
    libdeflate_free_decompressor(d);
    return result == LIBDEFLATE_SUCCESS;
}

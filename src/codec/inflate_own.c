// Decompression by kiln's own code, for builds without libdeflate.
#include "codec/deflate.h"

bool ki_inflate(const uint8_t *packed, size_t packed_size, uint8_t *plain, size_t size)
{
    return ki_inflate_own(packed, packed_size, plain, size);
}

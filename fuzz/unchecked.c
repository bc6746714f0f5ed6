// Replacements that the linker takes instead of the library's own functions, so that checksums do
// not keep random changes out: a change of a file behind a checksum would otherwise always be
// refused at the checksum. The library itself has no such switch.
#include "codec/deflate.h"

// The checksum of all ones stays wrong, so that what follows a wrong checksum is reached too.
bool ki_checksum_agrees(uint32_t computed, uint32_t stored)
{
    (void)computed;
    return stored != 0xffffffff;
}

// libdeflate would compare checksums.
bool ki_inflate(const uint8_t *packed, size_t packed_size, uint8_t *plain, size_t size)
{
    return ki_inflate_own(packed, packed_size, plain, size);
}

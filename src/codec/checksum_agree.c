// The comparison of checksums, alone in this file so that fuzz/unchecked.c can replace it.
#include "codec/deflate.h"

bool ki_checksum_agrees(uint32_t computed, uint32_t stored)
{
    return computed == stored;
}

// What the methods that decompress EXR chunks share: questions whether to go on, and inflating.
#include "codec/deflate.h"
#include "codec/exr.h"

bool ki_exr_go_on(ki_exr_workspace *work, size_t bytes)
{
    enum { PART = 1 << 22 };
    work->worked += bytes;
    if (work->worked < PART)
        return true;
    work->worked = 0;
    return ki_may_go_on(&work->asker);
}

bool ki_exr_inflate(ki_exr_workspace *work, const uint8_t *packed, size_t packed_size,
                    uint8_t *plain, size_t size)
{
    return ki_inflate_long(&work->asker, packed, packed_size, plain, size, false) == KILN_OK;
}

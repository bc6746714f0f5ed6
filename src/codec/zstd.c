#include "codec/zstd.h"

#include <zstd.h>

enum { STEP = 1 << 17 };

kiln_result ki_zstd_known(const char *name, kiln_error *error)
{
    (void)name;
    (void)error;
    return KILN_OK;
}

// Returns the number of bytes that compressed data may need: the zstd library's own bound and one
// byte more.
size_t ki_zstd_bound(size_t size)
{
    return ZSTD_compressBound(size) + 1;
}

kiln_result ki_zstd_pack(kiln_context *context, const uint8_t *plain, size_t size, int level,
                         uint8_t *room, size_t bound, size_t *packed_size)
{
    ZSTD_CCtx *zstd = ZSTD_createCCtx();
    ZSTD_inBuffer in = {plain, 0, 0};
    ZSTD_outBuffer out = {room, bound, 0};
    size_t left = 1;
    kiln_result result = KILN_ERROR_MEMORY;
    *packed_size = 0;
    if (!zstd || ZSTD_isError(ZSTD_CCtx_setParameter(zstd, ZSTD_c_compressionLevel, level)) ||
        ZSTD_isError(ZSTD_CCtx_setPledgedSrcSize(zstd, size)))
        goto done;
    while (left > 0) {
        if (in.pos == in.size)
            in.size += size - in.size < STEP ? size - in.size : STEP;
        bool last = in.size == size;
        left = ZSTD_compressStream2(zstd, &out, &in, last ? ZSTD_e_end : ZSTD_e_continue);
        if (ZSTD_isError(left) || out.pos == out.size)
            goto done;
        left = last ? left : 1;
        if (!ki_go_on(context)) {
            result = KILN_ERROR_CANCELLED;
            goto done;
        }
    }
    *packed_size = out.pos;
    result = KILN_OK;
done:
    ZSTD_freeCCtx(zstd);
    return result;
}

bool ki_zstd_stated_size(const uint8_t *packed, size_t packed_size, uint64_t *size)
{
    *size = ZSTD_getFrameContentSize(packed, packed_size);
    return *size != ZSTD_CONTENTSIZE_UNKNOWN && *size != ZSTD_CONTENTSIZE_ERROR;
}

const char *ki_zstd_unpack(const uint8_t *packed, size_t packed_size, uint8_t *plain, size_t size)
{
    size_t got = ZSTD_decompress(plain, size, packed, packed_size);
    return got == size ? NULL : ZSTD_isError(got) ? ZSTD_getErrorName(got) : "too short";
}

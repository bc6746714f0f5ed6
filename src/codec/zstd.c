// Compression and decompression by the zstd library. Its header declares the parameter
// ZSTD_d_stableOutBuffer, which is used here, only with ZSTD_STATIC_LINKING_ONLY. Versions before
// 1.4.6 have no such parameter; levels are then decompressed by one call that cannot be stopped.
#include "codec/zstd.h"

#define ZSTD_STATIC_LINKING_ONLY
#include <zstd.h>
#include <zstd_errors.h>

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

#ifdef ZSTD_d_stableOutBuffer
// Makes a decoder that writes straight to the output, which saves memory as large as the output.
// Returns NULL if the library has no such decoder, or memory runs out.
static ZSTD_DCtx *make_decoder(void)
{
    ZSTD_DCtx *zstd = ZSTD_createDCtx();
    int longest = ZSTD_dParam_getBounds(ZSTD_d_windowLogMax).upperBound;
    if (zstd && (ZSTD_isError(ZSTD_DCtx_setParameter(zstd, ZSTD_d_stableOutBuffer, 1)) ||
                 ZSTD_isError(ZSTD_DCtx_setParameter(zstd, ZSTD_d_windowLogMax, longest)))) {
        ZSTD_freeDCtx(zstd);
        return NULL;
    }
    return zstd;
}

// Unpacks block by block: the decoder says how many packed bytes it wants up to the end of the next
// block, which unpacks to at most 128 KiB.
static size_t unpack_blocks(kiln_context *context, ZSTD_DCtx *zstd, ZSTD_inBuffer in,
                            ZSTD_outBuffer *out, bool *stopped)
{
    enum { PART = 1 << 22, FIRST = 5 }; // FIRST: bytes that every frame begins with
    size_t all = in.size, wanted = 0, asked = 0;
    do {
        size_t left = all - in.pos, next = wanted ? wanted : FIRST;
        in.size = in.pos + (next < left ? next : left);
        wanted = ZSTD_decompressStream(zstd, out, &in);
        if (in.pos + out->pos - asked >= PART) {
            asked = in.pos + out->pos;
            *stopped = !ki_go_on(context);
        }
    } while (!*stopped && !ZSTD_isError(wanted) && in.pos < all);
    return wanted;
}
#endif

kiln_result ki_zstd_unpack(kiln_context *context, const uint8_t *packed, size_t packed_size,
                           uint8_t *plain, size_t size, const char **fault)
{
    bool stopped = false;
    size_t got;
#ifdef ZSTD_d_stableOutBuffer
    ZSTD_DCtx *zstd = make_decoder();
    if (zstd) {
        ZSTD_outBuffer out = {plain, size, 0};
        got = unpack_blocks(context, zstd, (ZSTD_inBuffer){packed, packed_size, 0}, &out, &stopped);
        got = ZSTD_isError(got) ? got : got ? 0 : out.pos;
        ZSTD_freeDCtx(zstd);
    } else
#endif
        got = ZSTD_decompress(plain, size, packed, packed_size);
    if (stopped)
        return KILN_ERROR_CANCELLED;
    if (ZSTD_getErrorCode(got) == ZSTD_error_memory_allocation)
        return KILN_ERROR_MEMORY;
    *fault = ZSTD_isError(got) ? ZSTD_getErrorName(got) : "too short";
    return got == size ? KILN_OK : KILN_ERROR_FORMAT;
}

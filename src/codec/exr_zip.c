// EXR's byte-wise compressions: ZIP, ZIPS and RLE.
#include "base/vector.h"
#include "codec/deflate.h"
#include "codec/exr.h"

#include <string.h>

#define SHIFTED(v, n)                                                                              \
    KI_SHUFFLE16((ki_bytes16){0}, v, 16 - (n), 17 - (n), 18 - (n), 19 - (n), 20 - (n), 21 - (n),   \
                 22 - (n), 23 - (n), 24 - (n), 25 - (n), 26 - (n), 27 - (n), 28 - (n), 29 - (n),   \
                 30 - (n), 31 - (n))

// Undoes the differences of EXR's method ZIP: each byte was stored as its difference from the byte
// before, plus 128. Sixteen running sums are computed at a time, in four steps that add to each
// byte the sum 1, 2, 4 and 8 places to its left.
static void undo_differences(uint8_t *bytes, size_t size)
{
    size_t i = 0;
    // the byte before the first, chosen so that the first byte stays as it is stored
    uint8_t last = 128;
    for (; i + 16 <= size; i += 16) {
        ki_bytes16 v;
        memcpy(&v, bytes + i, sizeof v);
        v -= 128;
        v += SHIFTED(v, 1);
        v += SHIFTED(v, 2);
        v += SHIFTED(v, 4);
        v += SHIFTED(v, 8);
        v += last;
        last = v[15];
        memcpy(bytes + i, &v, sizeof v);
    }
    for (; i < size; i++)
        bytes[i] = last = (uint8_t)(last + bytes[i] - 128);
}

// Merges the even bytes of a chunk, which are stored first, with the odd bytes, which are stored
// after them.
static void interleave(const uint8_t *halves, uint8_t *restrict raw, size_t size)
{
    const uint8_t *odd = halves + (size + 1) / 2;
    for (size_t i = 0; i < size / 2; i++) {
        raw[2 * i] = halves[i];
        raw[2 * i + 1] = odd[i];
    }
    if (size % 2)
        raw[size - 1] = halves[size / 2];
}

bool ki_exr_unzip(const uint8_t *packed, size_t packed_size, uint8_t *raw, size_t size,
                  uint8_t *scratch)
{
    if (!ki_inflate(packed, packed_size, scratch, size))
        return false;
    undo_differences(scratch, size);
    interleave(scratch, raw, size);
    return true;
}

kiln_result ki_exr_decompress_zip(const ki_exr_workspace *work, const ki_exr_box *box,
                                  const uint8_t *packed, size_t packed_size, uint8_t *raw,
                                  size_t size)
{
    (void)box;
    return ki_exr_unzip(packed, packed_size, raw, size, work->scratch) ? KILN_OK
                                                                       : KILN_ERROR_FORMAT;
}

size_t ki_exr_unpack_runs(const uint8_t *packed, size_t packed_size, uint8_t *raw, size_t size)
{
    size_t in = 0, out = 0;
    while (in < packed_size) {
        size_t code = packed[in++];
        // a code above 127 means that the next 256 - code bytes stand for themselves
        if (code > 127) {
            size_t count = 256 - code;
            if (packed_size - in < count || size - out < count)
                return SIZE_MAX;
            memcpy(raw + out, packed + in, count);
            in += count;
            out += count;
        } else {
            size_t count = code + 1;
            if (in == packed_size || size - out < count)
                return SIZE_MAX;
            memset(raw + out, packed[in++], count);
            out += count;
        }
    }
    return out;
}

kiln_result ki_exr_decompress_rle(const ki_exr_workspace *work, const ki_exr_box *box,
                                  const uint8_t *packed, size_t packed_size, uint8_t *raw,
                                  size_t size)
{
    (void)box;
    if (ki_exr_unpack_runs(packed, packed_size, work->scratch, size) != size)
        return KILN_ERROR_FORMAT;
    undo_differences(work->scratch, size);
    interleave(work->scratch, raw, size);
    return KILN_OK;
}

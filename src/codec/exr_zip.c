// EXR's byte-wise compressions: ZIP, ZIPS and RLE.
#include "base/vector.h"
#include "codec/exr.h"

#include <string.h>

#define SHIFTED(v, n)                                                                              \
    KI_SHUFFLE16((ki_bytes16){0}, v, 16 - (n), 17 - (n), 18 - (n), 19 - (n), 20 - (n), 21 - (n),   \
                 22 - (n), 23 - (n), 24 - (n), 25 - (n), 26 - (n), 27 - (n), 28 - (n), 29 - (n),   \
                 30 - (n), 31 - (n))

enum { PART = 1 << 20 }; // bytes between two calls of ki_exr_go_on

// Undoes the differences of EXR's method ZIP: each byte was stored as its difference from the byte
// before, plus 128. Sixteen running sums are computed at a time, in four steps that add to each
// byte the sum 1, 2, 4 and 8 places to its left. Only the addition to `before`, the sum of all
// bytes before the sixteen, has to wait for the sixteen before.
// Returns the last sum. `last` is the sum before the first byte.
static uint8_t undo_differences(uint8_t *bytes, size_t size, uint8_t last)
{
    size_t i = 0;
    ki_bytes16 before = (ki_bytes16){0} + last;
    for (; i + 16 <= size; i += 16) {
        ki_bytes16 v, sum;
        memcpy(&v, bytes + i, sizeof v);
        v -= 128;
        v += SHIFTED(v, 1);
        v += SHIFTED(v, 2);
        v += SHIFTED(v, 4);
        v += SHIFTED(v, 8);
        sum = v + before;
        before +=
            KI_SHUFFLE16(v, v, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15);
        memcpy(bytes + i, &sum, sizeof sum);
    }
    last = before[0];
    for (; i < size; i++)
        bytes[i] = last = (uint8_t)(last + bytes[i] - 128);
    return last;
}

// Writes `count` even bytes of a chunk and as many odd ones to `raw` in turn.
static void interleave(const uint8_t *even, const uint8_t *odd, size_t count, uint8_t *restrict raw)
{
    for (size_t i = 0; i < count; i++) {
        raw[2 * i] = even[i];
        raw[2 * i + 1] = odd[i];
    }
}

// Undoes the differences in `bytes`, which hold all even bytes of a chunk and then all odd ones,
// and writes the bytes of the chunk to `raw`.
static bool undo_all(ki_exr_workspace *work, uint8_t *bytes, uint8_t *raw, size_t size)
{
    const uint8_t *odd = bytes + (size + 1) / 2;
    // Differences are stored plus 128, except that of the first byte, which is stored as it is: a
    // byte of 128 before it makes it a difference like the others.
    uint8_t last = 128;
    for (size_t at = 0, count = PART; at < size; at += count) {
        count = size - at < PART ? size - at : PART;
        last = undo_differences(bytes + at, count, last);
        if (!ki_exr_go_on(work, count))
            return false;
    }
    for (size_t at = 0, count = PART; at < size / 2; at += count) {
        count = size / 2 - at < PART ? size / 2 - at : PART;
        interleave(bytes + at, odd + at, count, raw + 2 * at);
        if (!ki_exr_go_on(work, 2 * count))
            return false;
    }
    if (size % 2)
        raw[size - 1] = bytes[size / 2];
    return true;
}

bool ki_exr_unzip(ki_exr_workspace *work, const uint8_t *packed, size_t packed_size, uint8_t *raw,
                  size_t size, uint8_t *scratch)
{
    return ki_exr_inflate(work, packed, packed_size, scratch, size) &&
           undo_all(work, scratch, raw, size);
}

kiln_result ki_exr_decompress_zip(ki_exr_workspace *work, const ki_exr_box *box,
                                  const uint8_t *packed, size_t packed_size, uint8_t *raw,
                                  size_t size)
{
    (void)box;
    bool good = ki_exr_unzip(work, packed, packed_size, raw, size, work->scratch);
    return good ? KILN_OK : KILN_ERROR_FORMAT;
}

size_t ki_exr_unpack_runs(ki_exr_workspace *work, const uint8_t *packed, size_t packed_size,
                          uint8_t *raw, size_t size)
{
    size_t in = 0, out = 0, told = 0;
    while (in < packed_size) {
        size_t code = packed[in++], count;
        // a code above 127 means that the next 256 - code bytes stand for themselves
        if (code > 127) {
            count = 256 - code;
            if (packed_size - in < count || size - out < count)
                return SIZE_MAX;
            memcpy(raw + out, packed + in, count);
            in += count;
        } else {
            count = code + 1;
            if (in == packed_size || size - out < count)
                return SIZE_MAX;
            memset(raw + out, packed[in++], count);
        }
        out += count;
        if (out - told >= PART) {
            if (!ki_exr_go_on(work, out - told))
                return SIZE_MAX;
            told = out;
        }
    }
    return out;
}

kiln_result ki_exr_decompress_rle(ki_exr_workspace *work, const ki_exr_box *box,
                                  const uint8_t *packed, size_t packed_size, uint8_t *raw,
                                  size_t size)
{
    (void)box;
    bool good = ki_exr_unpack_runs(work, packed, packed_size, work->scratch, size) == size &&
                undo_all(work, work->scratch, raw, size);
    return good ? KILN_OK : KILN_ERROR_FORMAT;
}

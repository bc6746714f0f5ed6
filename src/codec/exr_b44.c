// EXR's B44 and B44A: halfs in blocks of 4 x 4, each a first value and 15 differences of 6 bits with
// a common shift, 14 bytes; B44A stores a block of one value in 3. Floats and integers are as they are.
#include "base/bytes.h"
#include "codec/exr.h"
#include "image/pack.h"
#include "math/math.h"

#include <string.h>

// A channel that is "perceptually linear" was stored as exp(x / 8): back to x.
static uint16_t logarithm(uint16_t half)
{
    if (half == 0)
        return 0xfc00;
    if (half >= 0x7c00) // negative, infinite, not a number
        return 0;
    return ki_half_from_float((float)(8 * ki_log((double)ki_float_from_half(half))));
}

// Sixteen halfs: the first, then 15 differences of 6 bits, down the first column and to the right
// from there; or three bytes where all are one.
static size_t undo_block(const uint8_t *bytes, size_t left, uint16_t s[16])
{
    static const uint8_t to[15] = {4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15};
    if (left < 3)
        return 0;
    int shift = bytes[2] >> 2;
    bool flat = shift >= 13;
    if (!flat && left < 14)
        return 0;
    s[0] = (uint16_t)(bytes[0] << 8 | bytes[1]);
    for (int i = 0, bit = 22; i < 15; i++, bit += 6) {
        uint16_t before = s[i < 3 ? to[i] - 4 : to[i] - 1];
        if (flat) {
            s[to[i]] = s[0];
            continue;
        }
        int two = bytes[bit / 8] << 8 | (bit / 8 < 13 ? bytes[bit / 8 + 1] : 0);
        int difference = (two >> (10 - bit % 8) & 63) - 32;
        s[to[i]] = (uint16_t)(before + difference * (1 << shift));
    }
    for (int i = 0; i < 16; i++)
        s[i] = s[i] & 0x8000 ? s[i] & 0x7fff : (uint16_t)~s[i];
    return flat ? 3 : 14;
}

// A plane of halfs, `width` x `height` of them.
static bool undo_plane(ki_reader *r, bool linear, int width, int height, uint8_t *plane)
{
    for (int y = 0; y < height; y += 4)
        for (int x = 0; x < width; x += 4) {
            uint16_t block[16] = {0};
            size_t used = undo_block(r->at, ki_reader_left(r), block);
            if (!used || !ki_read_bytes(r, used))
                return false;
            for (int i = 0; linear && i < 16; i++)
                block[i] = logarithm(block[i]);
            for (int j = 0; j < ki_min(4, height - y); j++)
                memcpy(plane + 2 * ((size_t)(y + j) * (size_t)width + (size_t)x),
                       block + (ptrdiff_t)4 * j, 2 * (size_t)ki_min(4, width - x));
        }
    return true;
}

kiln_result ki_exr_decompress_b44(const ki_exr_workspace *work, const ki_exr_box *box,
                                  const uint8_t *packed, size_t packed_size, uint8_t *raw,
                                  size_t size)
{
    (void)size;
    ki_reader r = ki_reader_make(packed, packed_size);
    uint8_t *plane = work->scratch;
    for (int c = 0; c < box->channel_count; c++) {
        const ki_exr_channel *channel = &box->channels[c];
        int width = ki_exr_columns(box, channel), height = ki_exr_rows(box, channel);
        size_t bytes = (size_t)width * (size_t)height * (size_t)channel->bytes;
        if (channel->type == KI_EXR_HALF) {
            if (!undo_plane(&r, channel->linear, width, height, plane))
                return KILN_ERROR_FORMAT;
        } else {
            const uint8_t *from = ki_read_bytes(&r, bytes);
            if (!from)
                return KILN_ERROR_FORMAT;
            memcpy(plane, from, bytes);
        }
        plane += bytes;
    }
    ki_exr_lines_from_planes(box, work->scratch, raw);
    return KILN_OK;
}

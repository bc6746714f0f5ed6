// EXR's B44 and B44A: half floats in blocks of 4 x 4. A block of 14 bytes holds a first value and
// 15 differences of 6 bits with a common shift. B44A stores a block of equal values in 3 bytes.
// Floats and integers are not compressed.
#include "base/bytes.h"
#include "codec/exr.h"
#include "image/pack.h"
#include "math/math.h"

#include <string.h>

// Returns x for a half that stores exp(x / 8). B44 stores channels in this form that the file marks
// as "perceptually linear".
static uint16_t logarithm(uint16_t half)
{
    if (half == 0)
        return 0xfc00;
    if (half >= 0x7c00) // negative, infinite or not-a-number
        return 0;
    return ki_half_from_float((float)(8 * ki_log((double)ki_float_from_half(half))));
}

static uint64_t load_high_first(const uint8_t *bytes)
{
    uint64_t value;
    memcpy(&value, bytes, sizeof value);
    return __builtin_bswap64(value);
}

// Undoes the coding by which stored numbers have the same order as the values of the halfs:
// negative halfs had all bits inverted, other halfs had the highest bit inverted.
static void halfs_from_ordered(const uint16_t ordered[16], uint16_t halfs[16])
{
    for (int i = 0; i < 16; i++)
        halfs[i] = (uint16_t)(ordered[i] ^ (ordered[i] >> 15 ? 0x8000 : 0xffff));
}

// Decodes a block of 4 x 4 halfs, row by row. A block is 16 bits of the first value, 6 bits of a
// shift, then 15 differences of 6 bits: each is the difference from the value above in the first
// column, from the value to the left in the other columns. A shift of 13 or more marks a block of
// three bytes whose sixteen values are equal. Returns the number of bytes that the block takes, or
// 0 if only fewer are left.
static size_t undo_block(const uint8_t *bytes, size_t left, uint16_t halfs[16])
{
    if (left < 3)
        return 0;
    uint16_t s[16];
    int shift = bytes[2] >> 2;
    bool flat = shift >= 13;
    s[0] = (uint16_t)(bytes[0] << 8 | bytes[1]);
    if (flat) {
        for (int i = 1; i < 16; i++)
            s[i] = s[0];
    } else {
        if (left < 14)
            return 0;
        uint64_t first = load_high_first(bytes + 2), last = load_high_first(bytes + 6);
        uint16_t difference[15];
        for (int i = 0; i < 15; i++) {
            int six = (int)((i < 9 ? first >> (52 - 6 * i) : last >> (84 - 6 * i)) & 63);
            difference[i] = (uint16_t)((six - 32) * (1 << shift));
        }
        for (size_t y = 1; y < 4; y++)
            s[4 * y] = (uint16_t)(s[4 * y - 4] + difference[y - 1]);
        for (int x = 1; x < 4; x++)
            for (int y = 0; y < 4; y++)
                s[4 * y + x] = (uint16_t)(s[4 * y + x - 1] + difference[4 * x + y - 1]);
    }
    halfs_from_ordered(s, halfs);
    return flat ? 3 : 14;
}

// Decodes one channel of a chunk, `width` x `height` halfs in blocks of 4 x 4.
static bool undo_plane(ki_exr_workspace *work, ki_reader *r, bool linear, int width, int height,
                       uint8_t *plane)
{
    for (int y = 0; y < height; y += 4) {
        if (!ki_exr_go_on(work, 8 * (size_t)width))
            return false;
        for (int x = 0; x < width; x += 4) {
            uint16_t block[16] = {0};
            size_t used = undo_block(r->at, ki_reader_left(r), block);
            if (!used || !ki_read_bytes(r, used))
                return false;
            for (int i = 0; linear && i < 16; i++)
                block[i] = logarithm(block[i]);
            uint8_t *to = plane + 2 * ((size_t)y * (size_t)width + (size_t)x);
            for (int j = 0; j < ki_min(4, height - y); j++, to += 2 * (size_t)width) {
                if (width - x >= 4) // a copy whose size the compiler knows is fast
                    memcpy(to, block + (ptrdiff_t)4 * j, 8);
                else
                    memcpy(to, block + (ptrdiff_t)4 * j, 2 * (size_t)(width - x));
            }
        }
    }
    return true;
}

// Copies a channel of `height` lines and `bytes` bytes in all, which is not of halfs.
static bool copy_plane(ki_exr_workspace *work, const uint8_t *from, int height, size_t bytes,
                       uint8_t *plane)
{
    size_t line = height ? bytes / (size_t)height : 0;
    for (size_t at = 0; at < bytes; at += line) {
        if (!ki_exr_go_on(work, line))
            return false;
        memcpy(plane + at, from + at, line);
    }
    return true;
}

kiln_result ki_exr_decompress_b44(ki_exr_workspace *work, const ki_exr_box *box,
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
            if (!undo_plane(work, &r, channel->linear, width, height, plane))
                return KILN_ERROR_FORMAT;
        } else {
            const uint8_t *from = ki_read_bytes(&r, bytes);
            if (!from || !copy_plane(work, from, height, bytes, plane))
                return KILN_ERROR_FORMAT;
        }
        plane += bytes;
    }
    bool good = ki_exr_lines_from_planes(work, box, work->scratch, raw);
    return good ? KILN_OK : KILN_ERROR_FORMAT;
}

// Pictures as blocks of 4 x 4 texels in 16 bytes, row by row of blocks: what BC6H and UASTC HDR
// have in common.
#ifndef KI_BLOCKS_H
#define KI_BLOCKS_H

#include "base/base.h"

enum { KI_BLOCK_BYTES = 16 };

/// Encodes one row of blocks of an RGB picture, from the texel rows 4 y to 4 y + 3.
typedef void ki_block_row(const float *rgb, int width, int height, int y, uint8_t *bytes);
/// Decodes a block to 16 texels of half floats.
typedef void ki_block_decoder(const uint8_t *bytes, uint16_t halfs[16][3]);

/// Returns the number of bytes of a picture of any size.
size_t ki_blocks_size(int width, int height);
/// Encodes `picture_count` RGB pictures, stored one after the other, on all threads. Returns false
/// if a progress report asks to stop.
bool ki_blocks_encode(kiln_context *context, ki_block_row *row, const float *rgb, int width,
                      int height, int picture_count, uint8_t *bytes);
void ki_blocks_decode(ki_block_decoder *decode, const uint8_t *bytes, int width, int height,
                      float *rgb);

/// The 128 bits of a block, of which the next one to be written or read is number `at`.
typedef struct ki_bits {
    uint64_t half[2];
    int at;
} ki_bits;

/// Writes the lowest `count` bits of `value`, the lowest one first. Bits are written once, to a
/// block of zeros; `count` is below 64.
static inline void ki_bits_put(ki_bits *b, uint64_t value, int count)
{
    value &= (UINT64_C(1) << count) - 1;
    int half = b->at / 64, from = b->at % 64;
    b->half[half] |= value << from;
    if (from + count > 64)
        b->half[half + 1] |= value >> (64 - from);
    b->at += count;
}

/// Reads `count` bits, at most 32.
static inline unsigned ki_bits_get(ki_bits *b, int count)
{
    int half = b->at / 64, from = b->at % 64;
    uint64_t value = b->half[half] >> from;
    if (from + count > 64)
        value |= b->half[half + 1] << (64 - from);
    b->at += count;
    return (unsigned)(value & ((UINT64_C(1) << count) - 1));
}

#endif

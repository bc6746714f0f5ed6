// BC6H, unsigned: 4 x 4 texels in 16 bytes, by the Khronos Data Format Specification 1.4, chapter
// "BPTC Compressed Texture Image Formats". Colours lie on one line or two in the space of half floats'
// bits, which is nearly that of logarithms.
#ifndef KI_BC6H_H
#define KI_BC6H_H

#include "base/base.h"

enum { KI_BC6H_MODES = 14, KI_BC6H_PARTITIONS = 32, KI_BC6H_BYTES = 16 };

/// Endpoints 1 to 3 are differences from endpoint 0 in `delta_bits` where the mode is `relative`.
typedef struct ki_bc6h_mode {
    uint8_t number, subsets, bits, delta_bits[3];
    bool relative;
    const char *runs; ///< of bits, behind the mode's number up to the partition's or the indices
} ki_bc6h_mode;

/// What a block says. Endpoints are whole, not differences: [subset][end][channel].
typedef struct ki_bc6h_block {
    int mode, partition; ///< which of ki_bc6h_modes, not its number
    int endpoint[2][2][3];
    int index[16];
} ki_bc6h_block;

extern const ki_bc6h_mode ki_bc6h_modes[KI_BC6H_MODES];
/// Bit 4 y + x: the subset of a texel, and the texel of subset 1 whose index lacks its highest bit.
extern const uint16_t ki_bc6h_partitions[KI_BC6H_PARTITIONS];
extern const uint8_t ki_bc6h_anchors[KI_BC6H_PARTITIONS];

/// An endpoint of `bits` bits as a number of 0 to 65535.
static inline int ki_bc6h_unquantize(int value, int bits)
{
    if (bits >= 15 || value == 0)
        return value;
    return value == (1 << bits) - 1 ? 0xffff : ((value << 15) + 0x4000) >> (bits - 1);
}

/// Of 64, by index of 3 bits (two subsets) or 4 (one).
static inline int ki_bc6h_weight(int index, int subsets)
{
    return subsets == 2 ? index * 9 + (index >> 2) : (index << 2) + (index >> 2) + (index >> 1 & 1);
}

/// Differences must fit, and the anchors' indices be below half.
void ki_bc6h_pack(const ki_bc6h_block *block, uint8_t bytes[KI_BC6H_BYTES]);
/// False for the four modes that are reserved.
bool ki_bc6h_unpack(const uint8_t bytes[KI_BC6H_BYTES], ki_bc6h_block *block);

/// Blocks of a picture of any size, row by row; texels outside repeat the edge's.
size_t ki_bc6h_size(int width, int height);
/// On all threads, `picture_count` pictures of RGB one after the other. False where a report of progress
/// asks to stop.
bool ki_bc6h_encode(kiln_context *context, const float *rgb, int width, int height,
                    int picture_count, uint8_t *bytes);
void ki_bc6h_decode(const uint8_t *bytes, int width, int height, float *rgb);

/// Encodes the blocks of rows 4 y to 4 y + 3. One a set of instructions, with the same bits.
typedef void ki_bc6h_row(const float *rgb, int width, int height, int y, uint8_t *bytes);
extern ki_bc6h_row ki_bc6h_row_scalar, ki_bc6h_row_simd128, ki_bc6h_row_avx2, ki_bc6h_row_avx512;

#endif

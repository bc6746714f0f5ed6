// Unsigned BC6H: 4 x 4 texels in 16 bytes, by the Khronos Data Format Specification 1.4, chapter
// "BPTC Compressed Texture Image Formats". The colours of a block lie on one or two lines between
// endpoints, in the space of the bits of half floats, which is nearly logarithmic.
#ifndef KI_BC6H_H
#define KI_BC6H_H

#include "codec/blocks.h"

enum { KI_BC6H_MODES = 14, KI_BC6H_PARTITIONS = 32 };

/// A mode of BC6H, that is, a layout of a block's bits. In a `relative` mode endpoints 1 to 3 are
/// stored as differences from endpoint 0, in `delta_bits` bits for each channel.
typedef struct ki_bc6h_mode {
    uint8_t number, subsets, bits, delta_bits[3];
    bool relative;
    /// Where the bits of the endpoints lie in the block: runs of bits as text, in the order of the
    /// block, after the bits of the mode's number. bc6h_block.c defines the text.
    const char *runs;
} ki_bc6h_mode;

/// The content of a block. endpoint[subset][end][channel] holds whole endpoints, not differences.
typedef struct ki_bc6h_block {
    /// mode: index in ki_bc6h_modes, not the number that a block stores. partition: index in
    /// ki_bc6h_partitions.
    int mode, partition;
    int endpoint[2][2][3];
    int index[16];
} ki_bc6h_block;

extern const ki_bc6h_mode ki_bc6h_modes[KI_BC6H_MODES];
/// ki_bc6h_partitions: bit 4 y + x of a partition is the subset, 0 or 1, of texel (x, y).
/// ki_bc6h_anchors: for each partition the anchor, the texel of subset 1 whose index is stored
/// without its highest bit.
extern const uint16_t ki_bc6h_partitions[KI_BC6H_PARTITIONS];
extern const uint8_t ki_bc6h_anchors[KI_BC6H_PARTITIONS];

/// Converts an endpoint of `bits` bits to a number of 0 to 65535.
static inline int ki_bc6h_unquantize(int value, int bits)
{
    if (bits >= 15 || value == 0)
        return value;
    return value == (1 << bits) - 1 ? 0xffff : ((value << 15) + 0x4000) >> (bits - 1);
}

/// Returns the weight, out of 64, with which a texel of this index mixes endpoint 1 into endpoint
/// 0. Indices have 3 bits with two subsets, 4 bits with one subset.
static inline int ki_bc6h_weight(int index, int subsets)
{
    return subsets == 2 ? index * 9 + (index >> 2) : (index << 2) + (index >> 2) + (index >> 1 & 1);
}

/// Writes a block's bits. Endpoints stored as differences must fit in the mode's bits, and the
/// index of each subset's anchor texel must be below half of the index range.
void ki_bc6h_pack(const ki_bc6h_block *block, uint8_t bytes[KI_BLOCK_BYTES]);
/// Reads a block's bits. Returns false for the four reserved numbers of modes.
bool ki_bc6h_unpack(const uint8_t bytes[KI_BLOCK_BYTES], ki_bc6h_block *block);

/// Encodes `picture_count` RGB pictures, stored one after the other, on all threads. Returns false
/// if a progress report asks to stop.
bool ki_bc6h_encode(kiln_context *context, const float *rgb, int width, int height,
                    int picture_count, uint8_t *bytes);
void ki_bc6h_decode(const uint8_t *bytes, int width, int height, float *rgb);

/// Each instruction set has a variant of the function, and all variants write the same bits.
extern ki_block_row ki_bc6h_row_scalar, ki_bc6h_row_simd128, ki_bc6h_row_avx2, ki_bc6h_row_avx512;

#endif

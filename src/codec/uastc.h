// UASTC HDR 4x4: 4 x 4 texels in 16 bytes. A block is a block of ASTC HDR (Khronos Data Format
// Specification 1.4, chapter "ASTC Compressed Texture Image Formats") in one of 24 modes, each of
// which can also be written as BC6H ("UASTC HDR 4x4 Texture Specification" of Basis Universal). The
// colours of a block lie on one or two lines between endpoints. A line is straight in ASTC's
// logarithmic numbers of 16 bits, 2048 for each factor of two in value.
#ifndef KI_UASTC_H
#define KI_UASTC_H

#include "codec/blocks.h"

enum {
    KI_UASTC_MODES = 23,      ///< number of modes with lines; the 24th mode is KI_UASTC_SOLID
    KI_UASTC_SOLID = 23,      ///< the mode of a block of one colour
    KI_UASTC_PARTITIONS = 27, ///< partitions of ASTC that BC6H has, too
    KI_UASTC_LAST_END = 3967  ///< largest endpoint whose colour is finite, in numbers of 12 bits
};

/// The content of a mode with lines.
typedef struct ki_uastc_mode {
    /// ends: number of ASTC's colour endpoint mode, 7 (a colour and a brightness) or 11 (two
    /// colours). subsets: number of lines, 1 or 2.
    uint8_t ends, subsets;
    /// Numbers of ASTC's ranges, which count from 0 (2 levels) to 20 (256 levels): range of the
    /// texels' weights, 1 to 8, and of the values that hold the endpoints.
    uint8_t weights, values;
} ki_uastc_mode;

/// The content of a block.
typedef struct ki_uastc_block {
    /// mode: index in ki_uastc_modes, or KI_UASTC_SOLID. partition: index in
    /// ki_uastc_partitions, for modes of two subsets.
    int mode, partition;
    /// Endpoints of each subset as the numbers of 8 bits in which ASTC stores them: 6 in modes
    /// with two colours, 4 in modes with a colour and a brightness.
    uint8_t value[2][6];
    /// index of each texel's weight among the mode's weights, in rising order
    uint8_t index[16];
    uint16_t solid[3]; ///< half floats of a solid block
} ki_uastc_block;

extern const ki_uastc_mode ki_uastc_modes[KI_UASTC_MODES];
/// A partition that ASTC and BC6H share: the number that ASTC stores, and the number in
/// ki_bc6h_partitions. In `inverted` partitions ASTC's subset 0 is subset 1 of BC6H.
typedef struct ki_uastc_partition {
    uint16_t number;
    uint8_t bc6h;
    bool inverted;
} ki_uastc_partition;
extern const ki_uastc_partition ki_uastc_partitions[KI_UASTC_PARTITIONS];
/// ki_uastc_levels[r]: number of weights of ASTC's range r. ki_uastc_weights[r]: these weights in
/// rising order, out of 64.
extern const uint8_t ki_uastc_levels[9], ki_uastc_weights[9][16];

/// A range of base x 2^bits numbers. A number is stored as its lower bits and, above them, one
/// digit to the base 3 or 5; base 1 has no digit.
typedef struct ki_uastc_range {
    uint8_t base, bits;
} ki_uastc_range;
extern const ki_uastc_range ki_uastc_ranges[21];

/// Returns the subset of each texel of a partition: bit 4 y + x is the subset of texel (x, y).
unsigned ki_uastc_mask(int partition);
/// Returns the value of 8 bits for which a stored number of a range of endpoint values stands.
int ki_uastc_value(unsigned stored, ki_uastc_range range);
/// Returns the stored number whose value is nearest to `value` (0 to 255) and equal to it in the
/// upper `kept` bits, 0 to 3. ki_uastc_quantize returns the value itself.
unsigned ki_uastc_nearest(int value, int range, int kept);
int ki_uastc_quantize(int value, int range, int kept);

/// Sets end[0] and end[1] to the endpoints, red, green and blue as numbers of 12 bits, that the
/// values of ASTC's colour endpoint mode `ends`, 7 or 11, stand for.
void ki_uastc_read_ends(const uint8_t value[6], int ends, int end[2][3]);
/// Finds the values of the mode with the index `mode` whose endpoints are near `wanted` (numbers of
/// 12 bits, between 0 and KI_UASTC_LAST_END), by the most precise layout that reaches. Sets `end`
/// to the endpoints that the values give. Changes `wanted`, and may swap the two endpoints. Modes
/// with a colour and a brightness store wanted[1] and the mean difference of the two endpoints.
void ki_uastc_write_ends(int mode, float wanted[2][3], uint8_t value[6], int end[2][3]);

/// Writes a block's bits. All values must be in the mode's range of endpoint values.
void ki_uastc_pack(const ki_uastc_block *block, uint8_t bytes[KI_BLOCK_BYTES]);
/// Reads a block's bits. Returns false for blocks that are not of the 24 modes, and for blocks with
/// infinite or negative colours.
bool ki_uastc_unpack(const uint8_t bytes[KI_BLOCK_BYTES], ki_uastc_block *block);

/// Returns the half float of a logarithmic number of 16 bits, rounded down.
static inline int ki_uastc_half(int number)
{
    int exponent = number >> 11, mantissa = number & 2047;
    int scaled = mantissa < 512    ? 3 * mantissa
                 : mantissa < 1536 ? 4 * mantissa - 512
                                   : 5 * mantissa - 2048;
    return (exponent << 10) + (scaled >> 3);
}

/// Encodes `picture_count` RGB pictures, stored one after the other, on all threads. Returns false
/// if a progress report asks to stop.
bool ki_uastc_encode(kiln_context *context, const float *rgb, int width, int height,
                     int picture_count, uint8_t *bytes);
/// Decodes a picture. Blocks that ki_uastc_unpack refuses are black.
void ki_uastc_decode(const uint8_t *bytes, int width, int height, float *rgb);
/// Returns the number of the first of `count` blocks that ki_uastc_unpack refuses, or `count`.
size_t ki_uastc_first_unknown(const uint8_t *bytes, size_t count);

/// Each instruction set has a variant of the function, and all variants write the same bits.
extern ki_block_row ki_uastc_row_scalar, ki_uastc_row_simd128, ki_uastc_row_avx2,
    ki_uastc_row_avx512;

#endif

// Blocks of JPEG coefficients whose inverse cosine transform leaves the range of a decoder's
// integers.
//
// A decoder computes that transform in integers, and libjpeg-turbo has two programs for it: its C
// code has 32 bits or more and takes the result modulo 1024, and its code for vector units has 16
// bits in places and saturates. Both give the same samples unless a number leaves these ranges. The
// coefficients of a picture leave them only if they were quantized very coarsely, or are damaged.
// Then the samples would depend on the processor.
#ifndef KI_JPEG_BLOCK_H
#define KI_JPEG_BLOCK_H

#include <stdbool.h>
#include <stdint.h>

/// Returns whether every way to compute the inverse transform of a block gives the same samples.
/// `coefficients` are the 64 quantized ones, row by row, and `steps` are their quantization steps.
bool ki_jpeg_block_fits(const int16_t *coefficients, const uint16_t *steps);
/// Replaces quantized coefficients by dequantized ones. A block that does not fit is replaced by
/// the transform of its samples after these were clamped to 0..255, rounded to whole coefficients.
void ki_jpeg_block_limit(int16_t *coefficients, const uint16_t *steps);

#endif

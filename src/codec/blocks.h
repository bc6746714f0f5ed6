// Pictures as blocks of 4 x 4 texels in 16 bytes, row by row of blocks: what BC6H and UASTC HDR have in common.
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

#endif

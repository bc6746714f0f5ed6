// Encodes and decodes pictures as blocks of BC6H.
#include "codec/bc6h.h"

#include "base/vector.h"

#include <string.h>

bool ki_bc6h_encode(kiln_context *context, const float *rgb, int width, int height,
                    int picture_count, uint8_t *bytes)
{
    return ki_blocks_encode(context, KI_FASTEST(context, ki_bc6h_row), rgb, width, height,
                            picture_count, bytes);
}

// Decodes a block to 16 texels. Blocks of a reserved mode are black.
static void decode_block(const uint8_t *bytes, uint16_t halfs[16][3])
{
    ki_bc6h_block b;
    if (!ki_bc6h_unpack(bytes, &b)) {
        memset(halfs[0], 0, sizeof(uint16_t[16][3]));
        return;
    }
    const ki_bc6h_mode *mode = &ki_bc6h_modes[b.mode];
    for (int i = 0; i < 16; i++) {
        int subset = mode->subsets == 2 ? ki_bc6h_partitions[b.partition] >> i & 1 : 0;
        int weight = ki_bc6h_weight(b.index[i], mode->subsets);
        for (int c = 0; c < 3; c++) {
            int from = ki_bc6h_unquantize(b.endpoint[subset][0][c], mode->bits);
            int to = ki_bc6h_unquantize(b.endpoint[subset][1][c], mode->bits);
            int mixed = ((64 - weight) * from + weight * to + 32) >> 6;
            halfs[i][c] = (uint16_t)(mixed * 31 >> 6);
        }
    }
}

void ki_bc6h_decode(const uint8_t *bytes, int width, int height, float *rgb)
{
    ki_blocks_decode(decode_block, bytes, width, height, rgb);
}

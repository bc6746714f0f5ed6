// Encodes and decodes pictures as blocks of UASTC HDR 4x4.
#include "codec/uastc.h"

#include "base/vector.h"

#include <string.h>

bool ki_uastc_encode(kiln_context *context, const float *rgb, int width, int height,
                     int picture_count, uint8_t *bytes)
{
    return ki_blocks_encode(context, KI_FASTEST(context, ki_uastc_row), rgb, width, height,
                            picture_count, bytes);
}

// Decodes a block to 16 texels of half floats.
static void decode_block(const uint8_t *bytes, uint16_t halfs[16][3])
{
    ki_uastc_block b;
    if (!ki_uastc_unpack(bytes, &b)) {
        memset(halfs[0], 0, sizeof(uint16_t[16][3]));
        return;
    }
    if (b.mode == KI_UASTC_SOLID) {
        for (int i = 0; i < 16; i++)
            memcpy(halfs[i], b.solid, sizeof b.solid);
        return;
    }
    const ki_uastc_mode *mode = &ki_uastc_modes[b.mode];
    unsigned mask = mode->subsets == 2 ? ki_uastc_mask(b.partition) : 0;
    int end[2][2][3] = {{{0}}};
    for (int s = 0; s < mode->subsets; s++)
        ki_uastc_read_ends(b.value[s], mode->ends, end[s]);
    for (int i = 0; i < 16; i++) {
        int weight = ki_uastc_weights[mode->weights][b.index[i]];
        for (int c = 0; c < 3; c++) {
            int from = end[mask >> i & 1][0][c], to = end[mask >> i & 1][1][c];
            // Endpoints of 12 bits are the upper bits of numbers of 16 bits.
            int mixed = ((64 - weight) * from * 16 + weight * to * 16 + 32) >> 6;
            halfs[i][c] = (uint16_t)ki_uastc_half(mixed);
        }
    }
}

void ki_uastc_decode(const uint8_t *bytes, int width, int height, float *rgb)
{
    ki_blocks_decode(decode_block, bytes, width, height, rgb);
}

size_t ki_uastc_first_unknown(const uint8_t *bytes, size_t count)
{
    ki_uastc_block b;
    size_t i = 0;
    while (i < count && ki_uastc_unpack(bytes + KI_BLOCK_BYTES * i, &b))
        i++;
    return i;
}

// Encodes and decodes pictures as blocks of UASTC HDR 4x4.
#include "codec/uastc.h"

#include "base/vector.h"
#include "image/pack.h"

#include <string.h>

size_t ki_uastc_size(int width, int height)
{
    size_t columns = ((size_t)width + 3) / 4, rows = ((size_t)height + 3) / 4;
    return columns * rows * KI_UASTC_BYTES;
}

typedef struct block_rows {
    ki_uastc_row *row;
    const float *rgb;
    int width, height, rows;
    uint8_t *bytes;
} block_rows;

static void encode_row(void *data, int index)
{
    const block_rows *r = data;
    size_t picture = (size_t)(index / r->rows), y = (size_t)(index % r->rows);
    size_t texels = (size_t)r->width * (size_t)r->height;
    size_t size = ki_uastc_size(r->width, r->height);
    r->row(r->rgb + 3 * texels * picture, r->width, r->height, (int)y,
           r->bytes + size * picture + size / (size_t)r->rows * y);
}

bool ki_uastc_encode(kiln_context *context, const float *rgb, int width, int height,
                     int picture_count, uint8_t *bytes)
{
    block_rows r = {KI_FASTEST(context, ki_uastc_row), rgb, width, height, (height + 3) / 4, bytes};
    return ki_parallel_steps(context, NULL, r.rows * picture_count, encode_row, &r);
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
    int end[2][2][3];
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
    for (int y = 0; y < height; y += 4)
        for (int x = 0; x < width; x += 4, bytes += KI_UASTC_BYTES) {
            uint16_t halfs[16][3];
            decode_block(bytes, halfs);
            for (int i = 0; i < 16; i++)
                if (x + i % 4 < width && y + i / 4 < height) {
                    size_t at = (size_t)(y + i / 4) * (size_t)width + (size_t)(x + i % 4);
                    ki_floats_from_halfs(halfs[i], 3, rgb + 3 * at);
                }
        }
}

size_t ki_uastc_first_unknown(const uint8_t *bytes, size_t count)
{
    ki_uastc_block b;
    size_t i = 0;
    while (i < count && ki_uastc_unpack(bytes + KI_UASTC_BYTES * i, &b))
        i++;
    return i;
}

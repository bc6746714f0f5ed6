// Encodes and decodes pictures as blocks of BC6H.
#include "codec/bc6h.h"

#include "base/vector.h"
#include "image/pack.h"

#include <string.h>

size_t ki_bc6h_size(int width, int height)
{
    size_t columns = ((size_t)width + 3) / 4, rows = ((size_t)height + 3) / 4;
    return columns * rows * KI_BC6H_BYTES;
}

typedef struct block_rows {
    ki_bc6h_row *row;
    const float *rgb;
    int width, height, rows;
    uint8_t *bytes;
} block_rows;

static void encode_row(void *data, int index)
{
    const block_rows *r = data;
    size_t picture = (size_t)(index / r->rows), y = (size_t)(index % r->rows);
    size_t texels = (size_t)r->width * (size_t)r->height;
    size_t size = ki_bc6h_size(r->width, r->height);
    r->row(r->rgb + 3 * texels * picture, r->width, r->height, (int)y,
           r->bytes + size * picture + size / (size_t)r->rows * y);
}

bool ki_bc6h_encode(kiln_context *context, const float *rgb, int width, int height,
                    int picture_count, uint8_t *bytes)
{
    block_rows r = {KI_FASTEST(context, ki_bc6h_row), rgb, width, height, (height + 3) / 4, bytes};
    return ki_parallel_steps(context, NULL, r.rows * picture_count, encode_row, &r);
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
    for (int y = 0; y < height; y += 4)
        for (int x = 0; x < width; x += 4, bytes += KI_BC6H_BYTES) {
            uint16_t halfs[16][3];
            decode_block(bytes, halfs);
            for (int i = 0; i < 16; i++)
                if (x + i % 4 < width && y + i / 4 < height) {
                    size_t at = (size_t)(y + i / 4) * (size_t)width + (size_t)(x + i % 4);
                    ki_floats_from_halfs(halfs[i], 3, rgb + 3 * at);
                }
        }
}

#include "codec/blocks.h"

#include "image/pack.h"

size_t ki_blocks_size(int width, int height)
{
    size_t columns = ((size_t)width + 3) / 4, rows = ((size_t)height + 3) / 4;
    return columns * rows * KI_BLOCK_BYTES;
}

typedef struct block_rows {
    ki_block_row *row;
    const float *rgb;
    int width, height, rows;
    uint8_t *bytes;
} block_rows;

static void encode_row(void *data, int index)
{
    const block_rows *r = data;
    size_t picture = (size_t)(index / r->rows), y = (size_t)(index % r->rows);
    size_t texels = (size_t)r->width * (size_t)r->height;
    size_t size = ki_blocks_size(r->width, r->height);
    r->row(r->rgb + 3 * texels * picture, r->width, r->height, (int)y,
           r->bytes + size * picture + size / (size_t)r->rows * y);
}

bool ki_blocks_encode(kiln_context *context, ki_block_row *row, const float *rgb, int width,
                      int height, int picture_count, uint8_t *bytes)
{
    block_rows r = {row, rgb, width, height, (height + 3) / 4, bytes};
    return ki_parallel_steps(context, NULL, r.rows * picture_count, encode_row, &r);
}

void ki_blocks_decode(ki_block_decoder *decode, const uint8_t *bytes, int width, int height,
                      float *rgb)
{
    for (int y = 0; y < height; y += 4)
        for (int x = 0; x < width; x += 4, bytes += KI_BLOCK_BYTES) {
            uint16_t halfs[16][3];
            decode(bytes, halfs);
            for (int i = 0; i < 16; i++)
                if (x + i % 4 < width && y + i / 4 < height) {
                    size_t at = (size_t)(y + i / 4) * (size_t)width + (size_t)(x + i % 4);
                    ki_floats_from_halfs(halfs[i], 3, rgb + 3 * at);
                }
        }
}

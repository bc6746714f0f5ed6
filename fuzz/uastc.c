// Blocks of UASTC HDR. The bytes are taken for blocks: a block is refused and black, or its texels
// are finite, and the block's content, written again, gives the same texels. Then the bytes are
// taken for half floats of a picture, whose blocks the decoder must know.
#include "fuzz.h"

#include "codec/uastc.h"
#include "image/pack.h"

#include <string.h>

static void check_block(const uint8_t *bytes)
{
    ki_uastc_block b;
    uint8_t again[KI_BLOCK_BYTES];
    float rgb[48], back[48];
    bool known = ki_uastc_unpack(bytes, &b);
    ki_uastc_decode(bytes, 4, 4, rgb);
    for (int i = 0; i < 48; i++)
        fuzz_must(rgb[i] >= 0 && rgb[i] <= (known ? 65504.0f : 0));
    if (!known)
        return;
    ki_uastc_pack(&b, again);
    fuzz_must(ki_uastc_first_unknown(again, 1) == 1);
    ki_uastc_decode(again, 4, 4, back);
    fuzz_must(!memcmp(rgb, back, sizeof rgb));
}

static void encode_block(const uint8_t *bytes, size_t size)
{
    float rgb[48] = {0}, back[48];
    uint8_t block[KI_BLOCK_BYTES];
    ki_floats_from_half_bytes(bytes, size / 2 < 48 ? size / 2 : 48, rgb);
    ki_uastc_row_scalar(rgb, 4, 4, 0, block);
    fuzz_must(ki_uastc_first_unknown(block, 1) == 1);
    ki_uastc_decode(block, 4, 4, back);
}

void fuzz_uastc(const uint8_t *bytes, size_t size)
{
    for (size_t at = 0; at + KI_BLOCK_BYTES <= size; at += KI_BLOCK_BYTES)
        check_block(bytes + at);
    for (size_t at = 0; at < size; at += 96)
        encode_block(bytes + at, size - at);
}

// The texel formats of KTX2 and DDS cubes.
#ifndef KI_TEXEL_H
#define KI_TEXEL_H

#include "base/base.h"

/// In the order of kiln_format, NULL behind the last.
extern const char *const ki_format_names[];

typedef struct ki_texel {
    kiln_format format;
    uint32_t vk, dxgi;
    int bytes;     // of a texel, or of a block
    int type_size; // of what is swapped for byte order
    int block;     // edge of a block: 1 or 4
    int channels;
} ki_texel;

enum { KI_TEXELS = 5 };
extern const ki_texel ki_texels[KI_TEXELS];

/// NULL where there is none. KILN_FORMAT_AUTO is RGBA16F.
const ki_texel *ki_texel_of_format(kiln_format format);
const ki_texel *ki_texel_of_vk(uint32_t vk);
const ki_texel *ki_texel_of_dxgi(uint32_t dxgi);

/// Bytes of a picture of any size; a block at its edge may reach beyond it.
uint64_t ki_texels_size(const ki_texel *texel, int width, int height);
/// RGB floats of `count` pictures, one after the other, to texels, on all threads. False where a report
/// of progress asks to stop. Bytes need no alignment.
bool ki_texels_pack(kiln_context *context, const ki_texel *texel, const float *rgb, int width,
                    int height, int count, uint8_t *bytes);
/// Back, one picture. Not-a-number and negatives become 0, infinities the largest finite value.
void ki_texels_unpack(const ki_texel *texel, const uint8_t *bytes, int width, int height,
                      float *rgb);

#endif

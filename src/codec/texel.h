// The texel formats of KTX2 and DDS cubes.
#ifndef KI_TEXEL_H
#define KI_TEXEL_H

#include "base/base.h"

typedef struct ki_texel {
    kiln_format format;
    const char *name;
    uint32_t vk, dxgi;
    int bytes;     // of a texel
    int type_size; // of what is swapped for byte order
} ki_texel;

extern const ki_texel ki_texels[4];

/// NULL where there is none. KILN_FORMAT_AUTO is RGBA16F.
const ki_texel *ki_texel_of_format(kiln_format format);
const ki_texel *ki_texel_of_vk(uint32_t vk);
const ki_texel *ki_texel_of_dxgi(uint32_t dxgi);

/// RGB floats to texels and back. Reading makes not-a-number and negatives 0 and infinities the
/// largest finite value. Bytes need no alignment.
void ki_texels_pack(const ki_texel *texel, const float *rgb, size_t count, uint8_t *bytes);
/// The same on all threads. False where a report of progress asks to stop.
bool ki_texels_pack_many(kiln_context *context, const ki_texel *texel, const float *rgb,
                         size_t count, uint8_t *bytes);
void ki_texels_unpack(const ki_texel *texel, const uint8_t *bytes, size_t count, float *rgb);

#endif

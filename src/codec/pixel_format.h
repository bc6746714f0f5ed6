// What kiln_format means: one row a format with its name, its largest radiance, its numbers in Vulkan's
// and DXGI's lists, and texels packed to bytes and back.
#ifndef KI_PIXEL_FORMAT_H
#define KI_PIXEL_FORMAT_H

#include "codec/rgbx.h"

/// In the order of kiln_format, NULL behind the last.
extern const char *const ki_format_names[];

typedef struct ki_pixel_format {
    kiln_format format;
    double limit;      ///< the largest radiance, 0 where floats hold all
    uint32_t vk, dxgi; ///< 0 where KTX2 and DDS have no such format
    int bytes;         ///< of a texel, or of a block
    int type_size;     ///< bytes of what is swapped for byte order
    int block;         ///< edge of a block in texels: 1 or 4
    int channels;
    ki_rgbx *rgbx; ///< a texel to four numbers for PNG, or NULL
} ki_pixel_format;

/// NULL where the number is no format. KILN_FORMAT_AUTO is as RGBA16F.
const ki_pixel_format *ki_pixel_format_of(kiln_format format);
/// NULL where kiln reads no such format.
const ki_pixel_format *ki_pixel_format_of_vk(uint32_t vk);
const ki_pixel_format *ki_pixel_format_of_dxgi(uint32_t dxgi);

/// Bytes of a picture of any size; a block at its edge may reach beyond it.
uint64_t ki_pixels_size(const ki_pixel_format *pixel, int width, int height);
/// RGB floats of `count` pictures, one after the other, to texels of a KTX2 or DDS format, on all
/// threads. False where a report of progress asks to stop. Bytes need no alignment.
bool ki_pixels_pack(kiln_context *context, const ki_pixel_format *pixel, const float *rgb,
                    int width, int height, int count, uint8_t *bytes);
/// The inverse, for one picture. Not-a-number and negatives become 0, infinities the largest finite
/// value.
void ki_pixels_unpack(const ki_pixel_format *pixel, const uint8_t *bytes, int width, int height,
                      float *rgb);

#endif

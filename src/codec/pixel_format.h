// The table of formats behind kiln_format: one row for each format with its name, its largest
// radiance and its Vulkan and DXGI numbers; and the packing of texels to bytes and back.
#ifndef KI_PIXEL_FORMAT_H
#define KI_PIXEL_FORMAT_H

#include "codec/rgbx.h"

/// Names of the texel formats, such as "rgb9e5", in the order of kiln_format, with NULL after the
/// last name.
extern const char *const ki_format_names[];

typedef struct ki_pixel_format {
    kiln_format format;
    double limit; ///< largest radiance that the format holds; 0 if floats hold every radiance
    /// the format's number in Vulkan and in DXGI; 0 if KTX2 and DDS cannot hold the format
    uint32_t vk, dxgi;
    int bytes;     ///< number of bytes of a texel, or of a block of texels
    int type_size; ///< number of bytes of the unit that is swapped for byte order
    int block;     ///< texels along the side of a block: 4, or 1 for formats without blocks
    int channels;
    /// colour model of the Khronos Data Format, which KTX2 files state
    int model;
    ki_rgbx *rgbx; ///< converts a texel of radiance to the four numbers that PNG stores, or NULL
} ki_pixel_format;

/// Returns the row of a format, or NULL if `format` is not in the enum. KILN_FORMAT_AUTO gives the
/// row of RGBA16F.
const ki_pixel_format *ki_pixel_format_of(kiln_format format);
/// Return the row of the format with a Vulkan or DXGI number, or NULL if kiln reads no such format.
const ki_pixel_format *ki_pixel_format_of_vk(uint32_t vk);
const ki_pixel_format *ki_pixel_format_of_dxgi(uint32_t dxgi);

/// Returns the number of bytes of a picture of any size. Blocks at the picture's right and lower
/// edge may extend beyond the edge.
uint64_t ki_pixels_size(const ki_pixel_format *pixel, int width, int height);
/// Converts `count` pictures of RGB floats, stored one after the other, to texels of a KTX2 or DDS
/// format, on all threads. Returns false if a progress report asks to stop. `bytes` needs no
/// alignment.
bool ki_pixels_pack(kiln_context *context, const ki_pixel_format *pixel, const float *rgb,
                    int width, int height, int count, uint8_t *bytes);
/// Converts the texels of one picture to RGB floats, which keep negative, infinite and not-a-number
/// values.
void ki_pixels_unpack(const ki_pixel_format *pixel, const uint8_t *bytes, int width, int height,
                      float *rgb);

#endif

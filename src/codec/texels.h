// Texels of textures that other programs write: the formats that KTX and DDS files hold beyond
// those that kiln writes, and their conversion to radiance.
#ifndef KI_TEXELS_H
#define KI_TEXELS_H

#include "codec/pixel_format.h"

typedef enum ki_texel_kind {
    KI_TEXEL_PIXEL, ///< a format of ki_pixel_format
    KI_TEXEL_U8,    ///< channels of 8 bits, linear
    KI_TEXEL_SRGB8, ///< channels of 8 bits by the sRGB curve
    KI_TEXEL_U16,   ///< channels of 16 bits, linear
    KI_TEXEL_F16,
    KI_TEXEL_F32
} ki_texel_kind;

/// How the texels of a texture are stored.
typedef struct ki_texels {
    ki_texel_kind kind;
    int channels;                 ///< 3 or 4
    bool blue_first;              ///< true: the channels come in the order blue, green, red
    const ki_pixel_format *pixel; ///< the format if `kind` is KI_TEXEL_PIXEL, else NULL
} ki_texels;

/// Describe the texels of a Vulkan or DXGI number. Return false for formats that kiln does not
/// read.
bool ki_texels_of_vk(uint32_t vk, ki_texels *texels);
bool ki_texels_of_dxgi(uint32_t dxgi, ki_texels *texels);
enum { KI_TEXELS_NAME = 24 };
/// Writes the name of the format to `name`, for example "rgba16f" or "bgr8 srgb", and returns
/// `name`.
const char *ki_texels_name(const ki_texels *texels, char name[KI_TEXELS_NAME]);
/// Returns the number of bytes of a picture whose rows end at a multiple of `align` bytes; rows of
/// blocks have no gaps.
uint64_t ki_texels_size(const ki_texels *texels, int width, int height, int align);
/// Converts a picture to RGB floats on all threads. Returns false if a progress report asks to
/// stop.
bool ki_texels_read(kiln_context *context, const ki_texels *texels, const uint8_t *bytes, int width,
                    int height, int align, float *rgb);
/// Swaps left and right, top and bottom, or both, of a picture of RGB floats. Returns false if a
/// progress report asks to stop.
bool ki_texels_flip(kiln_context *context, float *rgb, int width, int height, bool left_right,
                    bool top_bottom);

/// Adds notes about texels that were read: how values of 8 bits were taken, and that smaller levels
/// were left aside. `stated` tells whether the file says that values of 8 bits are linear or sRGB.
void ki_texels_note(const ki_texels *texels, bool stated, int level_count,
                    kiln_load_report *report);

#endif

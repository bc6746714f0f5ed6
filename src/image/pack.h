// Conversion between floats and numbers of 16, 14, 11 and 10 bits. Packing rounds to nearest, ties
// to even. Values beyond the range become the largest finite value. Not-a-number becomes 0, and so
// do negative values in formats without a sign.
#ifndef KI_PACK_H
#define KI_PACK_H

#include <stddef.h>
#include <stdint.h>

/// The largest finite values of the formats. For b10g11r11 the value is that of blue, the smallest
/// of its three.
enum { KI_HALF_MAX = 65504, KI_RGB9E5_MAX = 65408, KI_B10G11R11_MAX = 64512 };

uint16_t ki_half_from_float(float value);
float ki_float_from_half(uint16_t half);
/// Convert `count` floats to half floats, and back, with vector instructions.
void ki_halfs_from_floats(const float *values, size_t count, uint16_t *halfs);
void ki_floats_from_halfs(const uint16_t *halfs, size_t count, float *values);
/// Converts halves that lie at any address, for example in a file.
void ki_floats_from_half_bytes(const void *bytes, size_t count, float *values);
/// Convert RGB floats to the format with a shared exponent and 9 bits for each channel
/// (VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, EXT_texture_shared_exponent), and back.
uint32_t ki_rgb9e5_from_float(const float rgb[3]);
void ki_float_from_rgb9e5(uint32_t packed, float rgb[3]);
/// Convert RGB floats to the format VK_FORMAT_B10G11R11_UFLOAT_PACK32, with red in the low bits,
/// and back.
uint32_t ki_b10g11r11_from_float(const float rgb[3]);
void ki_float_from_b10g11r11(uint32_t packed, float rgb[3]);

/// Converts `count` RGB texels of floats to RGBA texels of halves with alpha 1, with vector
/// instructions.
void ki_pack_rgba16f(const float *rgb, size_t count, uint16_t *rgba);
/// Convert `count` RGB texels as ki_rgb9e5_from_float and ki_b10g11r11_from_float do, with vector
/// instructions.
void ki_pack_rgb9e5(const float *rgb, size_t count, uint32_t *words);
void ki_pack_b10g11r11(const float *rgb, size_t count, uint32_t *words);
/// The exact sRGB transfer function: convert an sRGB value in [0, 1] to linear, and back.
float ki_linear_from_srgb(float value);
float ki_srgb_from_linear(float value);

#endif

// Conversion between floats and the small number formats of textures. In and out: arrays of floats,
// halves (16 bits), r9g9b9e5, b10g11r11 and sRGB values. Method: integers and exact float
// operations only, so that every machine gives the same bits. The roundings are to nearest, ties to
// even.
#include "image/pack.h"
#include "image/convert.h"
#include "image/small_float.h"
#include "math/math.h"

#include <stdbool.h>
#include <string.h>

// Converts the bits of a non-negative float to a small float of 5 exponent bits, biased by 15, and
// `m` mantissa bits. The code has no branches, so that compilers vectorise loops over it.
//
// Adding a power of two that is 2^(23 - m) times the power of two in the value leaves m bits after
// the leading bit and rounds the lower bits, to nearest and ties to even. The difference of the
// bits of sum and power is the rounded mantissa. Below 2^-14, the smallest normal number of the
// small format, the power stays constant. A mantissa that rounds up to 2 carries into the exponent.
static inline int32_t small_float(int32_t bits, int m)
{
    const int32_t largest = 142 << 23 | ((1 << m) - 1) << (23 - m);
    bits = bits > 0x7f800000 ? 0 : bits;
    bits = bits < largest ? bits : largest;
    int32_t exponent = (bits > 113 << 23 ? bits : 113 << 23) & 0x7f800000;
    int32_t power = exponent + ((23 - m) << 23);
    int32_t mantissa = ki_bits_of(ki_float_of(bits) + ki_float_of(power)) - power;
    return mantissa + (exponent >> (23 - m)) - (113 << m);
}

static inline uint16_t half_of(float value)
{
    int32_t bits = ki_bits_of(value), sign = value == value ? bits >> 16 & 0x8000 : 0;
    return (uint16_t)(sign | small_float(bits & 0x7fffffff, 10));
}

static inline uint32_t unsigned_of(float value, int m)
{
    return value > 0 ? (uint32_t)small_float(ki_bits_of(value), m) : 0;
}

uint16_t ki_half_from_float(float value)
{
    return half_of(value);
}

float ki_float_from_half(uint16_t half)
{
    return ki_float_of_half(half);
}

void ki_halfs_from_floats(const float *restrict values, size_t count, uint16_t *restrict halfs)
{
    for (size_t i = 0; i < count; i++)
        halfs[i] = half_of(values[i]);
}

void ki_floats_from_halfs(const uint16_t *restrict halfs, size_t count, float *restrict values)
{
    for (size_t i = 0; i < count; i++)
        values[i] = ki_float_of_half(halfs[i]);
}

void ki_floats_from_half_bytes(const void *bytes, size_t count, float *values)
{
#if defined(KILN_HAVE_SIMD128)
    ki_widen_halfs_simd128(bytes, count, values);
#else
    ki_widen_halfs_scalar(bytes, count, values);
#endif
}

// Packs by EXT_texture_shared_exponent: a channel is mantissa 2^(exponent - 15 - 9), with mantissas
// of 9 bits and one exponent for all three. The exponent is the smallest for which the mantissa of
// the largest channel, rounded, still fits in 9 bits.
uint32_t ki_rgb9e5_from_float(const float rgb[3])
{
    const float largest = KI_RGB9E5_MAX; // the largest value of the format, 511 / 512 * 2^16
    float c[3], most = 0;
    for (int i = 0; i < 3; i++) {
        c[i] = rgb[i] > 0 ? rgb[i] : 0;
        c[i] = c[i] > largest ? largest : c[i];
        most = c[i] > most ? c[i] : most;
    }
    int exponent = (ki_bits_of(most) >> 23) - 127 + 16;
    exponent = exponent < 0 ? 0 : exponent;
    // The unit in the last place of the float 2^23 is 1, so adding 2^23 rounds a mantissa to an
    // integer, ties to even.
    const float round = 8388608;
    float scale = ki_float_of((127 + 24 - exponent) << 23);
    if ((most * scale + round) - round >= 512) {
        exponent++;
        scale *= 0.5f;
    }
    uint32_t packed = (uint32_t)exponent << 27;
    for (int i = 0; i < 3; i++)
        packed |= (uint32_t)((c[i] * scale + round) - round) << (9 * i);
    return packed;
}

void ki_float_from_rgb9e5(uint32_t packed, float rgb[3])
{
    float scale = ki_float_of((int32_t)(127 - 24 + (packed >> 27)) << 23);
    for (int i = 0; i < 3; i++)
        rgb[i] = (float)(packed >> (9 * i) & 511U) * scale;
}

uint32_t ki_b10g11r11_from_float(const float rgb[3])
{
    return unsigned_of(rgb[0], 6) | unsigned_of(rgb[1], 6) << 11 | unsigned_of(rgb[2], 5) << 22;
}

void ki_float_from_b10g11r11(uint32_t packed, float rgb[3])
{
    rgb[0] = ki_large_float((int32_t)(packed & 0x7ffU), 6);
    rgb[1] = ki_large_float((int32_t)(packed >> 11 & 0x7ffU), 6);
    rgb[2] = ki_large_float((int32_t)(packed >> 22), 5);
}

// Converts STRETCH texels at a time: RGB floats to RGB halves without gaps, then the halves to RGBA
// texels. The compiler makes vector instructions of the first loop and copies of whole words of the
// second.
void ki_pack_rgba16f(const float *rgb, size_t count, uint16_t *rgba)
{
    enum { STRETCH = 64 };
    // Three halves a texel and one more, because each texel is copied as four halves.
    uint16_t half[STRETCH * 3 + 1] = {0};
    while (count) {
        size_t n = count < STRETCH ? count : STRETCH;
        ki_halfs_from_floats(rgb, n * 3, half);
        for (size_t i = 0; i < n; i++) {
            uint16_t texel[4];
            memcpy(texel, half + 3 * i, sizeof texel);
            texel[3] = 0x3c00; // alpha: the half with the value 1
            memcpy(rgba + 4 * i, texel, sizeof texel);
        }
        rgb += 3 * n;
        rgba += 4 * n;
        count -= n;
    }
}

// The next two functions convert between sRGB values and linear values by the transfer functions of
// IEC 61966-2-1.
float ki_linear_from_srgb(float value)
{
    double v = (double)value;
    return (float)(v <= 0.04045 ? v / 12.92 : ki_pow((v + 0.055) / 1.055, 2.4));
}

float ki_srgb_from_linear(float value)
{
    double v = (double)value;
    return (float)(v <= 0.0031308 ? v * 12.92 : 1.055 * ki_pow(v, 1 / 2.4) - 0.055);
}

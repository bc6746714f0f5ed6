// Conversion between floats and the small number formats of textures. In and out: arrays of floats,
// halves (16 bits), r9g9b9e5, b10g11r11 and sRGB values. Method: integers and exact float
// operations only, so that every machine gives the same bits. The roundings are to nearest, ties to
// even.
#include "image/pack.h"

#include "base/vector.h"
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
// the largest channel, rounded, still fits in 9 bits. The code has no branches.
static inline uint32_t rgb9e5_of(float r, float g, float b)
{
    const float largest = KI_RGB9E5_MAX; // the largest value of the format, 511 / 512 * 2^16
    // The unit in the last place of the float 2^23 is 1, so adding 2^23 rounds a mantissa to an
    // integer, ties to even, which the low bits of the sum then hold.
    const float round = 8388608;
    r = r > 0 ? r : 0;
    g = g > 0 ? g : 0;
    b = b > 0 ? b : 0;
    r = r > largest ? largest : r;
    g = g > largest ? largest : g;
    b = b > largest ? largest : b;
    float most = r > g ? r : g;
    most = most > b ? most : b;
    int32_t exponent = (ki_bits_of(most) >> 23) - 127 + 16;
    exponent = exponent < 0 ? 0 : exponent;
    float scale = ki_float_of((127 + 24 - exponent) << 23);
    exponent += (most * scale + round) - round >= 512 ? 1 : 0;
    scale = ki_float_of((127 + 24 - exponent) << 23);
    uint32_t red = (uint32_t)ki_bits_of(r * scale + round) & 511U;
    uint32_t green = (uint32_t)ki_bits_of(g * scale + round) & 511U;
    uint32_t blue = (uint32_t)ki_bits_of(b * scale + round) & 511U;
    return (uint32_t)exponent << 27 | blue << 18 | green << 9 | red;
}

uint32_t ki_rgb9e5_from_float(const float rgb[3])
{
    return rgb9e5_of(rgb[0], rgb[1], rgb[2]);
}

void ki_float_from_rgb9e5(uint32_t packed, float rgb[3])
{
    float scale = ki_float_of((int32_t)(127 - 24 + (packed >> 27)) << 23);
    for (int i = 0; i < 3; i++)
        rgb[i] = (float)(packed >> (9 * i) & 511U) * scale;
}

static inline uint32_t b10g11r11_of(float r, float g, float b)
{
    return unsigned_of(r, 6) | unsigned_of(g, 6) << 11 | unsigned_of(b, 5) << 22;
}

uint32_t ki_b10g11r11_from_float(const float rgb[3])
{
    return b10g11r11_of(rgb[0], rgb[1], rgb[2]);
}

void ki_float_from_b10g11r11(uint32_t packed, float rgb[3])
{
    rgb[0] = ki_large_float((int32_t)(packed & 0x7ffU), 6);
    rgb[1] = ki_large_float((int32_t)(packed >> 11 & 0x7ffU), 6);
    rgb[2] = ki_large_float((int32_t)(packed >> 22), 5);
}

enum { STRETCH = 64 }; // number of texels that are packed at a time

// Splits up to STRETCH texels into red, green and blue.
static void split(const float *rgb, size_t count, float colors[3][STRETCH])
{
    size_t i = 0;
    for (; i + 4 <= count; i += 4) {
        ki_float4 texels[3], four[3];
        memcpy(texels, rgb + 3 * i, sizeof texels);
        ki_split_rgb4(texels, four);
        for (int c = 0; c < 3; c++)
            memcpy(colors[c] + i, &four[c], sizeof four[c]);
    }
    for (; i < count; i++)
        for (size_t c = 0; c < 3; c++)
            colors[c][i] = rgb[3 * i + c];
}

// Packs texels to words by `pack_one`. The function is part of its callers, each with its own
// `pack_one`, so that the compiler makes vector instructions of the innermost loop.
__attribute__((always_inline)) static inline void
pack_words(const float *rgb, size_t count, uint32_t (*pack_one)(float r, float g, float b),
           uint32_t *words)
{
    float c[3][STRETCH];
    for (size_t done = 0; done < count; done += STRETCH) {
        size_t n = count - done < STRETCH ? count - done : STRETCH;
        split(rgb + 3 * done, n, c);
        for (size_t i = 0; i < n; i++)
            words[done + i] = pack_one(c[0][i], c[1][i], c[2][i]);
    }
}

void ki_pack_rgb9e5(const float *rgb, size_t count, uint32_t *words)
{
    pack_words(rgb, count, rgb9e5_of, words);
}

void ki_pack_b10g11r11(const float *rgb, size_t count, uint32_t *words)
{
    pack_words(rgb, count, b10g11r11_of, words);
}

// Converts STRETCH texels at a time: RGB floats to RGB halves without gaps, then the halves to RGBA
// texels. The compiler makes vector instructions of the first loop and copies of whole words of the
// second.
void ki_pack_rgba16f(const float *rgb, size_t count, uint16_t *rgba)
{
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

// Inline functions that convert the small floats of textures, of 16, 14, 11 and 10 bits, to floats.
// They use integers and exact float operations alone, so that every machine gives the same bits,
// and no branches, so that compilers turn loops that call them into vector instructions.
#ifndef KI_SMALL_FLOAT_H
#define KI_SMALL_FLOAT_H

#include <stdint.h>
#include <string.h>

/// Returns the bits of a float as a signed integer, because vector units compare signed integers
/// fastest.
static inline int32_t ki_bits_of(float value)
{
    int32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/// Returns the float that has these bits.
static inline float ki_float_of(int32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/// Converts a small float without sign, of 5 exponent bits and `m` mantissa bits, to a float.
static inline float ki_large_float(int32_t bits, int m)
{
    // bits of the float 2^(9-m), whose unit in the last place, 2^(-14-m), is that of the smallest
    // numbers of the small format
    int32_t unit = (127 + 9 - m) << 23;
    float low = ki_float_of(bits + unit) - ki_float_of(unit);
    int32_t high = (bits << (23 - m)) + (bits >> m == 31 ? 224 << 23 : 112 << 23);
    return bits >> m == 0 ? low : ki_float_of(high);
}

/// Converts a half float to a float.
static inline float ki_float_of_half(uint16_t half)
{
    float magnitude = ki_large_float(half & 0x7fff, 10);
    return ki_float_of(ki_bits_of(magnitude) | (int32_t)((uint32_t)(half >> 15) << 31));
}

#endif

// The choice of kernels by instruction set, and vectors of 16 bytes by the vector extension of GCC
// and clang. The compilers translate the extension to instructions of the processor, or to scalar
// arithmetic where there are no such instructions.
#ifndef KI_VECTOR_H
#define KI_VECTOR_H

#include "base/base.h"

/// Selects a variant of a vectorised function by the context's instruction set: the best that is
/// built of NAME_scalar, NAME_simd128 (vectors of 128 bits: SSE2, NEON, WebAssembly), NAME_avx2 and
/// NAME_avx512.
#if defined(KILN_HAVE_AVX)
#define KI_FASTEST(context, name)                                                                  \
    (ki_context_cpu(context) >= KILN_CPU_AVX512 ? name##_avx512                                    \
     : ki_context_cpu(context) >= KILN_CPU_AVX2 ? name##_avx2                                      \
     : ki_context_cpu(context) >= KILN_CPU_SSE2 ? name##_simd128                                   \
                                                : name##_scalar)
#elif defined(KILN_HAVE_SIMD128)
#define KI_FASTEST(context, name)                                                                  \
    (ki_context_cpu(context) >= KILN_CPU_SSE2 ? name##_simd128 : name##_scalar)
#else
#define KI_FASTEST(context, name) ((void)(context), name##_scalar)
#endif

typedef float ki_float4 __attribute__((vector_size(16)));
typedef uint8_t ki_bytes16 __attribute__((vector_size(16)));

/// Selects lanes of the vectors a and b by indices, which count the lanes of a first and continue
/// with those of b. GCC before 12 has only __builtin_shuffle, whose indices are a vector of
/// integers of the lanes' size.
#if defined(__clang__) || __GNUC__ >= 12
#define KI_SHUFFLE4(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#define KI_SHUFFLE16(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#define KI_SHUFFLE_DOUBLES2(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#define KI_SHUFFLE_DOUBLES4(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#define KI_JOIN_DOUBLES4(a, b) __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7)
#define KI_LOWER_DOUBLES4(v) __builtin_shufflevector(v, v, 0, 1, 2, 3)
#define KI_UPPER_DOUBLES4(v) __builtin_shufflevector(v, v, 4, 5, 6, 7)
#else
typedef int32_t ki_index4 __attribute__((vector_size(16)));
#define KI_SHUFFLE4(a, b, ...) __builtin_shuffle(a, b, (ki_index4){__VA_ARGS__})
#define KI_SHUFFLE16(a, b, ...) __builtin_shuffle(a, b, (ki_bytes16){__VA_ARGS__})
typedef int64_t ki_index_doubles2 __attribute__((vector_size(16)));
typedef int64_t ki_index_doubles4 __attribute__((vector_size(32)));
#define KI_SHUFFLE_DOUBLES2(a, b, ...) __builtin_shuffle(a, b, (ki_index_doubles2){__VA_ARGS__})
#define KI_SHUFFLE_DOUBLES4(a, b, ...) __builtin_shuffle(a, b, (ki_index_doubles4){__VA_ARGS__})
#define KI_JOIN_DOUBLES4(a, b)                                                                     \
    {                                                                                              \
        a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3]                                             \
    }
#define KI_LOWER_DOUBLES4(v)                                                                       \
    {                                                                                              \
        v[0], v[1], v[2], v[3]                                                                     \
    }
#define KI_UPPER_DOUBLES4(v)                                                                       \
    {                                                                                              \
        v[4], v[5], v[6], v[7]                                                                     \
    }
#endif

/// Transposes a matrix of 4 x 4 floats, given as four rows.
static inline void ki_transpose4(ki_float4 rows[4])
{
    ki_float4 low01 = KI_SHUFFLE4(rows[0], rows[1], 0, 4, 1, 5);
    ki_float4 low23 = KI_SHUFFLE4(rows[2], rows[3], 0, 4, 1, 5);
    ki_float4 high01 = KI_SHUFFLE4(rows[0], rows[1], 2, 6, 3, 7);
    ki_float4 high23 = KI_SHUFFLE4(rows[2], rows[3], 2, 6, 3, 7);
    rows[0] = KI_SHUFFLE4(low01, low23, 0, 1, 4, 5);
    rows[1] = KI_SHUFFLE4(low01, low23, 2, 3, 6, 7);
    rows[2] = KI_SHUFFLE4(high01, high23, 0, 1, 4, 5);
    rows[3] = KI_SHUFFLE4(high01, high23, 2, 3, 6, 7);
}

/// Converts four RGB texels of three floats each to vectors of red, green and blue.
static inline void ki_split_rgb4(const ki_float4 texels[3], ki_float4 rgb[3])
{
    ki_float4 red = KI_SHUFFLE4(texels[0], texels[1], 0, 3, 6, -1);
    ki_float4 green = KI_SHUFFLE4(texels[0], texels[1], 1, 4, 7, -1);
    ki_float4 blue = KI_SHUFFLE4(texels[0], texels[1], 2, 5, -1, -1);
    rgb[0] = KI_SHUFFLE4(red, texels[2], 0, 1, 2, 5);
    rgb[1] = KI_SHUFFLE4(green, texels[2], 0, 1, 2, 6);
    rgb[2] = KI_SHUFFLE4(blue, texels[2], 0, 1, 4, 7);
}

/// Converts vectors of red, green and blue to four RGB texels of three floats each.
static inline void ki_join_rgb4(const ki_float4 rgb[3], ki_float4 texels[3])
{
    ki_float4 low = KI_SHUFFLE4(rgb[0], rgb[1], 0, 4, 1, 5);
    ki_float4 high = KI_SHUFFLE4(rgb[0], rgb[1], 2, 6, 3, 7);
    ki_float4 one = KI_SHUFFLE4(low, rgb[2], 2, 3, 5, -1);
    texels[0] = KI_SHUFFLE4(low, rgb[2], 0, 1, 4, 2);
    texels[1] = KI_SHUFFLE4(one, high, 1, 2, 4, 5);
    texels[2] = KI_SHUFFLE4(rgb[2], high, 2, 6, 7, 3);
}

#endif

// The kernels of convert.inl, compiled for each instruction set; KI_FASTEST chooses among them.
#ifndef KI_CONVERT_H
#define KI_CONVERT_H

#include "image/color.h"

/// Number of texels that ki_transform_texels multiplies at once.
enum { KI_TRANSFORMED = 8 };

/// Multiplies RGB texels by the matrix, KI_TRANSFORMED at a time, and returns the number of texels
/// that it has multiplied. Ends where fewer are left, and before texels of which a channel is not
/// finite or a product is beyond the largest float.
typedef size_t ki_transform_texels(const ki_matrix3 *matrix, float *rgb, size_t count);
ki_transform_texels ki_transform_texels_scalar, ki_transform_texels_simd128,
    ki_transform_texels_avx2, ki_transform_texels_avx512;

/// Joins `count` values of red, green and blue to RGB texels.
typedef void ki_join_colors(const float *const colors[3], size_t count, float *rgb);
ki_join_colors ki_join_colors_scalar, ki_join_colors_simd128, ki_join_colors_avx2,
    ki_join_colors_avx512;

/// Converts `count` half floats, which may lie at any address, to floats.
typedef void ki_widen_halfs(const void *bytes, size_t count, float *values);
ki_widen_halfs ki_widen_halfs_scalar, ki_widen_halfs_simd128, ki_widen_halfs_avx2,
    ki_widen_halfs_avx512;

#endif

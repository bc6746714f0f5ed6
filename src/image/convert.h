// The kernels of convert.inl, compiled for each instruction set; KI_FASTEST chooses among them.
#ifndef KI_CONVERT_H
#define KI_CONVERT_H

#include "image/color.h"

/// Number of texels that one call of ki_transform_stretch multiplies by a matrix.
enum { KI_STRETCH = 64 };

/// Multiplies KI_STRETCH RGB texels by the matrix and returns true. Returns false and changes
/// nothing if a channel is not finite or a product is beyond the largest float.
typedef bool ki_transform_stretch(const ki_matrix3 *matrix, float *rgb);
ki_transform_stretch ki_transform_stretch_scalar, ki_transform_stretch_simd128,
    ki_transform_stretch_avx2, ki_transform_stretch_avx512;

/// Converts `count` half floats, which may lie at any address, to floats.
typedef void ki_widen_halfs(const void *bytes, size_t count, float *values);
ki_widen_halfs ki_widen_halfs_scalar, ki_widen_halfs_simd128, ki_widen_halfs_avx2,
    ki_widen_halfs_avx512;

#endif

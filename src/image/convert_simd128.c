#define TRANSFORM ki_transform_texels_simd128
#define WIDEN ki_widen_halfs_simd128
#define JOIN ki_join_colors_simd128
#include "image/convert.inl"

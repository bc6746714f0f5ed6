#define TRANSFORM ki_transform_stretch_simd128
#define WIDEN ki_widen_halfs_simd128
#include "image/convert.inl"

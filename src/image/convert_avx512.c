#define TRANSFORM ki_transform_stretch_avx512
#define WIDEN ki_widen_halfs_avx512
#include "image/convert.inl"

#define TRANSFORM ki_transform_stretch_avx2
#define WIDEN ki_widen_halfs_avx2
#include "image/convert.inl"

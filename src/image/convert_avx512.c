#define TRANSFORM ki_transform_texels_avx512
#define WIDEN ki_widen_halfs_avx512
#define JOIN ki_join_colors_avx512
#include "image/convert.inl"

#define TRANSFORM ki_transform_texels_avx2
#define WIDEN ki_widen_halfs_avx2
#define JOIN ki_join_colors_avx2
#include "image/convert.inl"

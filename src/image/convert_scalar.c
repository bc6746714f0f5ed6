#define TRANSFORM ki_transform_texels_scalar
#define WIDEN ki_widen_halfs_scalar
#define JOIN ki_join_colors_scalar
#include "image/convert.inl"

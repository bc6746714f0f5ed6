#define TRANSFORM ki_transform_stretch_scalar
#define WIDEN ki_widen_halfs_scalar
#include "image/convert.inl"

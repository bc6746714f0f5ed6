#define KI_WIDTH 2
#define KI_RUN_GROUP ki_reference_group_simd128
#include "bake/reference_rows.inl"

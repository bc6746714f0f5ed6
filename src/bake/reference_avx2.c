#define KI_WIDTH 4
#define KI_RUN_GROUP ki_reference_group_avx2
#include "bake/reference_rows.inl"

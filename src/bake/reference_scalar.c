#define KI_WIDTH 1
#define KI_RUN_GROUP ki_reference_group_scalar
#include "bake/reference_rows.inl"

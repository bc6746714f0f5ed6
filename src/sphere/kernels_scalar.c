#define KI_WIDTH 1
#define KI_BLOCK 1
#define KI_TABLE ki_kernels_scalar
#include "sphere/kernels_tables.h"

#include "sphere/kernels.inl"

#define KI_WIDTH 2
#define KI_BLOCK 1
#define KI_TABLE ki_kernels_simd128
#include "sphere/kernels_tables.h"

#include "sphere/kernels.inl"

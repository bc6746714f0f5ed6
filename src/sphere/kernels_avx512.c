#define KI_WIDTH 8
#define KI_BLOCK 2
#define KI_TABLE ki_kernels_avx512
#include "sphere/kernels_tables.h"

#include "sphere/kernels.inl"

#define KI_WIDTH 4
#define KI_BLOCK 1
#define KI_TABLE ki_kernels_avx2
#include "sphere/kernels_tables.h"

#include "sphere/kernels.inl"

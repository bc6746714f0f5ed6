// The tables of kernels, one for each instruction set.
#ifndef KI_KERNELS_TABLES_H
#define KI_KERNELS_TABLES_H

#include "sphere/kernels.h"

extern const ki_kernels ki_kernels_scalar, ki_kernels_simd128, ki_kernels_avx2, ki_kernels_avx512;

#endif

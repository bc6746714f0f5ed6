#define KI_BC6H_ROW ki_bc6h_row_simd128
#include "codec/bc6h.inl"

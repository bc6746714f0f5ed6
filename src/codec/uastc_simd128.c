#define KI_UASTC_ROW ki_uastc_row_simd128
#include "codec/uastc.inl"

#define KI_UASTC_ROW ki_uastc_row_avx512
#include "codec/uastc.inl"

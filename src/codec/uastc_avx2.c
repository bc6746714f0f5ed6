#define KI_UASTC_ROW ki_uastc_row_avx2
#include "codec/uastc.inl"

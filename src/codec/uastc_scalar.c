#define KI_UASTC_ROW ki_uastc_row_scalar
#include "codec/uastc.inl"

#define KI_ROW ki_energy_row_avx512
#include "brdf/energy.inl"

#define KI_ROW ki_energy_row_avx2
#include "brdf/energy.inl"

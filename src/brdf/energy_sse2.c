#define KI_ROW ki_energy_row_sse2
#include "brdf/energy.inl"

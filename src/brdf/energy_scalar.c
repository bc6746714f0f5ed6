#define KI_ROW ki_energy_row_scalar
#include "brdf/energy.inl"

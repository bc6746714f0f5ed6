#define KI_ROW ki_energy_row_scalar
#include "brdf/energy.inl"
#define KI_SURFACE_ROW ki_surface_row_scalar
#include "brdf/surface.inl"

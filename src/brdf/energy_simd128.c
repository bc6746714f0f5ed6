#define KI_ROW ki_energy_row_simd128
#include "brdf/energy.inl"
#define KI_SURFACE_ROW ki_surface_row_simd128
#include "brdf/surface.inl"

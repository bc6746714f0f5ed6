// The albedo of a rough surface: E, the share of light from one direction that the specular lobe
// with F = 1 reflects; E_avg, the average of E under diffuse light; A and B of the split sum. E, A
// and B are computed as integrals over the cosine of the light, which docs/theory/energy.md
// derives.
#ifndef KI_ENERGY_H
#define KI_ENERGY_H

#include "base/base.h"

#include <kiln/brdf.h>

/// Returns the albedo E of the lobe with F = 1 at the cosine nov = n.v. Roughness and nov are in
/// [0, 1]. The error is below 1e-11 for GGX and below 1e-8 for Beckmann's D. At roughness 0, E is
/// the limit as roughness tends to 0 while nov is fixed. At roughness 0 and nov = 0, E is the limit
/// of the values at roughness 0 as nov tends to 0.
double ki_energy(const kiln_model *model, double roughness, double nov);
/// Returns the average albedo under diffuse light, E_avg = 2 int_0^1 E(mu) mu dmu, of the lobe with
/// F = 1. Roughness is in [0, 1]. The error is below 1e-10.
double ki_energy_average(const kiln_model *model, double roughness);
/// Sets ab[0] and ab[1] to A and B of the split sum: with Schlick's F the albedo is f0 A + B, and
/// E = A + B. Ranges and error are those of ki_energy.
void ki_energy_split(const kiln_model *model, double roughness, double nov, double ab[2]);

/// Computes the values for `count` cosines nov at one roughness: albedos E of ki_energy to
/// out[count], or with `split` the pairs A, B of the split sum of ki_energy_split to out[count][2].
/// The results are bit-identical to the results of these two functions, on every instruction set.
void ki_energy_values(const kiln_context *context, const kiln_model *model, double roughness,
                      const double *nov, int count, bool split, double *out);

/// The kernels of ki_energy_values for GGX. Each compiles energy.inl for one instruction set.
typedef void ki_energy_row(const kiln_model *model, double roughness, const double *nov, int count,
                           bool split, double *out);
ki_energy_row ki_energy_row_scalar, ki_energy_row_simd128, ki_energy_row_avx2, ki_energy_row_avx512;

#endif

// What a rough surface reflects in all: E, E_avg and the split sum's A and B, each as one integral
// over the cosine of the light. docs/theory/energy.md derives it.
#ifndef KI_ENERGY_H
#define KI_ENERGY_H

#include "base/base.h"

#include <kiln/brdf.h>

/// E(n.v) with F = 1; error below 1e-11, with Beckmann's D 1e-8. roughness and nov in [0, 1]; the corners are
/// limits: roughness to 0 at this nov, then nov to 0.
double ki_energy(const kiln_model *model, double roughness, double nov);
/// 2 int_0^1 E(mu) mu dmu; error below 1e-10.
double ki_energy_average(const kiln_model *model, double roughness);
/// A and B: with Schlick's F the directional albedo is f0 A + B, and E = A + B. As exact as E.
void ki_energy_split(const kiln_model *model, double roughness, double nov, double ab[2]);

/// The same for `count` values of nov: E to out[count], or with `split` A and B to out[count][2]. The
/// same bits on every instruction set, and as the functions above.
void ki_energy_values(const kiln_context *context, const kiln_model *model, double roughness,
                      const double *nov, int count, bool split, double *out);

/// GGX, compiled once an instruction set: the body is energy.inl, KI_ROW_OF names the one to use.
typedef void ki_energy_row(const kiln_model *model, double roughness, const double *nov, int count,
                           bool split, double *out);
ki_energy_row ki_energy_row_scalar, ki_energy_row_sse2, ki_energy_row_avx2, ki_energy_row_avx512;

#endif

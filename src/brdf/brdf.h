// Microfacet functions of numbers. The normal is n = (0, 0, 1); nov, nol, noh are cosines with the
// view, light and half vectors in [0, 1]; alpha is roughness squared.
#ifndef KI_BRDF_H
#define KI_BRDF_H

#include <stdint.h>

/// The bits of `index` mirrored about the binary point: van der Corput's sequence in [0, 1).
double ki_radical_inverse(uint32_t index);
/// Point `index` of `count` of the Hammersley set, xi in [0, 1)^2: (index / count, radical inverse).
void ki_hammersley(uint32_t index, uint32_t count, double xi[2]);

/// Trowbridge and Reitz's distribution, GGX: alpha^2 / (pi ((n.h)^2 (alpha^2 - 1) + 1)^2).
/// Walter et al. 2007, eq. 33. Infinite where alpha is 0 and noh 1.
double ki_ggx_d(double alpha, double noh);
/// A half vector with the density D(h) (n.h), from xi: Walter et al. 2007, eqs. 35 and 36.
void ki_ggx_half_vector(double alpha, const double xi[2], double h[3]);

/// Schlick's one-sided shadowing, nox / (nox (1 - k) + k).
double ki_smith_g1_schlick(double k, double nox);
/// The uncorrelated product for view and light.
double ki_smith_g_schlick(double k, double nov, double nol);
/// k for image-based light, alpha / 2 = roughness^2 / 2. Karis 2013.
double ki_schlick_k_ibl(double alpha);
/// k for point lights, (roughness + 1)^2 / 8. Karis 2013.
double ki_schlick_k_direct(double roughness);

/// (1 - voh)^5, the varying part of Schlick's Fresnel F = f0 + (1 - f0) (1 - voh)^5.
double ki_schlick_fresnel(double voh);

#endif

// Beckmann's distribution of microfacet normals, a Gaussian of the surface's slope, with the Smith
// masking that follows from it and the albedo of its specular lobe. The arguments are those of
// brdf.h.
#ifndef KI_BECKMANN_H
#define KI_BECKMANN_H

#include <kiln/brdf.h>

/// D = exp(-tan^2 theta_h / alpha^2) / (pi alpha^2 cos^4 theta_h), where cos theta_h = noh. Walter
/// et al. 2007, eq. 25. Returns 0 at noh = 0, and DBL_MAX for infinity at alpha = 0 and noh = 1.
double ki_beckmann_d(double alpha, double noh);
/// Smith's Lambda, exact: (exp(-a^2) / (a sqrt pi) - (1 - erf a)) / 2 with a = cosine / (alpha
/// sine), where `cosine` is n.v or n.l. Masking is G1 = 1 / (1 + Lambda). Heitz 2014, eq. 66.
/// Returns DBL_MAX for infinity at cosine = 0.
double ki_beckmann_lambda(double alpha, double cosine);

/// Sets ab[0] and ab[1] to A and B of the split sum: the specular albedo is F0 A + B, and E = A +
/// B. model->d is KILN_D_BECKMANN, and model->g any of the four maskings. Roughness and nov are
/// clamped to [0, 1]. The error is below 1e-8.
void ki_beckmann_energy(const kiln_model *model, double roughness, double nov, double ab[2]);

#endif

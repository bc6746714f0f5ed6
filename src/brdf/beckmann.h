// Beckmann's distribution of normals, Gaussian in the slopes, with Smith's shadowing of its own.
#ifndef KI_BECKMANN_H
#define KI_BECKMANN_H

#include <kiln/brdf.h>

/// exp(-tan^2 theta_h / alpha^2) / (pi alpha^2 cos^4 theta_h). Walter et al. 2007, eq. 25. 0 at
/// noh = 0; infinite where alpha is 0 and noh 1.
double ki_beckmann_d(double alpha, double noh);
/// Smith's Lambda, exact: (exp(-a^2) / (a sqrt pi) - (1 - erf a)) / 2 with a = cosine / (alpha sine).
/// Heitz 2014, eq. 66. G1 = 1 / (1 + Lambda); infinite at cosine = 0.
double ki_beckmann_lambda(double alpha, double cosine);

/// A and B of the split sum, specular albedo = F0 A + B, E = A + B, for model->d == KILN_D_BECKMANN
/// and any of the four G. Out-of-range arguments are clamped; error below 1e-8.
void ki_beckmann_energy(const kiln_model *model, double roughness, double nov, double ab[2]);

#endif

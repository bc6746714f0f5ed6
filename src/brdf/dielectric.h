// Rough glass: the shares of light from one direction that a rough boundary between two dielectrics
// reflects and transmits, into all directions together. docs/theory/glass.md derives them.
#ifndef KI_DIELECTRIC_H
#define KI_DIELECTRIC_H

#include <kiln/brdf.h>

/// Sets rt[0] to R and rt[1] to T, the reflected and the transmitted share of the flux that arrives
/// from the cosine nov, by one interaction with a microfacet. R + T <= 1: further bounces are not
/// counted. ior is the refractive index beyond the boundary over that on the side of v; inside
/// glass it is below 1. Roughness and nov are clamped to [0, 1], and ior to [1/16, 16]. The error
/// is below 2e-6, or below 6e-6 for ior slightly below 1 with nov below 1e-3.
void ki_dielectric(const kiln_model *model, double roughness, double ior, double nov, double rt[2]);
/// Returns R of ki_dielectric without computing T, in less time.
double ki_dielectric_reflection(const kiln_model *model, double roughness, double ior, double nov);
/// Sets rt[0] and rt[1] to the averages 2 int R mu dmu and 2 int T mu dmu over mu = n.v in [0, 1].
void ki_dielectric_average(const kiln_model *model, double roughness, double ior, double rt[2]);

#endif

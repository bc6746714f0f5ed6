// Rough glass: what a rough boundary between two dielectrics reflects and transmits in all.
#ifndef KI_DIELECTRIC_H
#define KI_DIELECTRIC_H

#include <kiln/brdf.h>

/// Reflected and transmitted flux for light (or a view) at n.v, by one interaction with a microfacet,
/// to rt[0] and rt[1]; ior = n beyond / n on the side of v, below 1 from the inside of glass. Arguments
/// are clamped into roughness and nov in [0, 1], ior in [1/16, 16]; error below 2e-6, from
/// the inside with ior next to 1 and n.v below 1e-3 6e-6.
void ki_dielectric(const kiln_model *model, double roughness, double ior, double nov, double rt[2]);
/// R alone, in less time.
double ki_dielectric_reflection(const kiln_model *model, double roughness, double ior, double nov);
/// 2 int R mu dmu and 2 int T mu dmu.
void ki_dielectric_average(const kiln_model *model, double roughness, double ior, double rt[2]);

#endif

// Rough glass: the shares of light from one direction that a rough boundary between two dielectrics
// reflects and transmits, into all directions together. docs/theory/glass.md derives the integrals.
#ifndef KI_DIELECTRIC_H
#define KI_DIELECTRIC_H

#include <kiln/brdf.h>

/// Returns R of kiln_glass without computing T, in less time.
double ki_dielectric_reflection(const kiln_model *model, double roughness, double ior, double nov);

#endif

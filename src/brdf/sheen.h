// Charlie sheen, the reflection lobe of cloth. The microfacet normals lie near the surface, like
// the normals of fibres that stand up from the cloth. Estevez and Kulla 2017. docs/theory/sheen.md.
#ifndef KI_SHEEN_H
#define KI_SHEEN_H

#include <kiln/brdf.h>

/// D = (2 + 1/alpha) sin(theta_h)^(1/alpha) / (2 pi), with cos theta_h = noh in [0, 1] and alpha >
/// 0. Estevez and Kulla 2017, eq. 2.
double ki_sheen_d(double alpha, double noh);
/// The masking factor V of the lobe D V. KILN_SHEEN_ASHIKHMIN: 1 / (4 (n.l + n.v - (n.l)(n.v))),
/// which does not use alpha. KILN_SHEEN_ESTEVEZ: 1 / (4 (n.v)(n.l) (1 + Lambda(v) + Lambda(l))).
double ki_sheen_visibility(kiln_sheen sheen, double alpha, double nov, double nol);

#endif

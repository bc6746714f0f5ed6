// Charlie sheen: light on fibres that stand up from the cloth. Estevez and Kulla 2017.
#ifndef KI_SHEEN_H
#define KI_SHEEN_H

#include <kiln/brdf.h>

/// (2 + 1/alpha) sin(theta_h)^(1/alpha) / (2 pi). Estevez and Kulla 2017, eq. 2.
double ki_sheen_d(double alpha, double noh);
/// G / (4 (n.v) (n.l)) of the two kinds; alpha is used by the second only.
double ki_sheen_visibility(kiln_sheen sheen, double alpha, double nov, double nol);
/// The directional albedo, F = 1. Roughness is clamped to [0.01, 1] (alpha to 1e-4), n.v to [0, 1]
/// and, for KILN_SHEEN_ESTEVEZ, whose albedo has a pole at 0, to [1e-4, 1]. Error below 1e-9 for the first, 1e-7 for the second, of
/// the greater of 1 and the value.
double ki_sheen_albedo(kiln_sheen sheen, double roughness, double nov);

#endif

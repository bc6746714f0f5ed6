// E over the whole square of n.v and roughness as one Chebyshev series: a thousand integrals instead
// of one a texel.
//
// In t = n.v (1 + c) / (n.v + c), c the width of the grazing layer, every roughness has the same shape,
// so E is smooth in (u, roughness) up to the edges, u a root of t. GGX only.
#ifndef KI_SURFACE_H
#define KI_SURFACE_H

#include "base/base.h"

#include <kiln/brdf.h>

enum { KI_SURFACE_NOV = 48, KI_SURFACE_ROUGHNESS = 40 };

typedef struct ki_surface {
    kiln_model model;
    bool quartic;      ///< u = t^(1/4), else t^(1/2)
    int columns, rows; ///< degrees of u and of roughness in use
    double coefficient[KI_SURFACE_ROUGHNESS][KI_SURFACE_NOV];
} ki_surface;

/// c above: alpha, for Schlick's text k / (1 - k); at least 1e-12.
double ki_grazing_scale(const kiln_model *model, double roughness);

void ki_surface_build(kiln_context *context, const kiln_model *model, ki_surface *surface);

/// E for `count` values of nov in one row: within 7e-8 of ki_energy on [0, 1]^2, without the corner
/// roughness = nov = 0. The same bits on every instruction set.
void ki_surface_values(const kiln_context *context, const ki_surface *surface, double roughness,
                       const double *nov, int count, double *out);

typedef void ki_surface_row(const ki_surface *surface, const double *coefficient, double scale,
                            const double *nov, int count, double *out);
ki_surface_row ki_surface_row_scalar, ki_surface_row_sse2, ki_surface_row_avx2,
    ki_surface_row_avx512;

#endif

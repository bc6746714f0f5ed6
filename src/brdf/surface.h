// The albedo E of GGX as one Chebyshev series over n.v and roughness in [0, 1]. A large table of E
// evaluates this series instead of one integral per texel. The series takes at most 828 integrals
// to build.
//
// E changes fast at grazing angles, n.v < c, where c is about alpha. In t = n.v (1 + c) / (n.v + c)
// that range has the same width at every roughness. Therefore E is a smooth function of u and
// roughness, where u is the square root or the fourth root of t. docs/theory/energy.md.
#ifndef KI_SURFACE_H
#define KI_SURFACE_H

#include "base/base.h"

#include <kiln/brdf.h>

enum { KI_SURFACE_NOV = 48, KI_SURFACE_ROUGHNESS = 40 };

typedef struct ki_surface {
    kiln_model model;
    /// true: u = t^(1/4); false: u = t^(1/2), where t = n.v (1 + c) / (n.v + c)
    bool quartic;
    int columns, rows; ///< numbers of Chebyshev coefficients in u and in roughness
    double coefficient[KI_SURFACE_ROUGHNESS][KI_SURFACE_NOV];
} ki_surface;

/// The width c of the range of n.v at grazing angles in which the albedo E changes fast: alpha, at
/// least 1e-12, or k / (1 - k) with k = (roughness + 1)^2 / 8 for KILN_G_SCHLICK_TEXT.
double ki_grazing_scale(const kiln_model *model, double roughness);

/// Computes the Chebyshev series of the albedo E for a model whose D is GGX, on the context's
/// threads.
void ki_surface_build(kiln_context *context, const kiln_model *model, ki_surface *surface);

/// Sets out[i] to the albedo E at nov[i] for `count` cosines at one roughness, all in [0, 1]. The
/// values differ from ki_energy by less than 7e-8, except near roughness = nov = 0. They are
/// bit-identical on every instruction set.
void ki_surface_values(const kiln_context *context, const ki_surface *surface, double roughness,
                       const double *nov, int count, double *out);

/// The kernels of ki_surface_values, one for each instruction set. `coefficient` has the Chebyshev
/// coefficients in u at the row's roughness, and `scale` is ki_grazing_scale.
typedef void ki_surface_row(const ki_surface *surface, const double *coefficient, double scale,
                            const double *nov, int count, double *out);
ki_surface_row ki_surface_row_scalar, ki_surface_row_simd128, ki_surface_row_avx2,
    ki_surface_row_avx512;

#endif

// Declarations that the viewer's source files share.
#ifndef KILN_VIEWER_INTERNAL_H
#define KILN_VIEWER_INTERNAL_H

#include "viewer.h"

#include <kiln/brdf.h>

/// Stores the result and a formatted message in `error`, unless `error` is NULL.
void view_describe(kiln_error *error, kiln_result result, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/// Does what view_describe does; its value is `result`.
#define view_fail(error, result, ...) (view_describe((error), (result), __VA_ARGS__), (result))

/// Sources of the shaders with their #includes replaced by the included text, without version and
/// precision lines. Each ends in NUL.
extern const char view_shader_screen_vert[], view_shader_scene_frag[];

/// Set a metal's Fresnel reflectance, in linear Rec. 709 under daylight, at v.h, and its
/// cosine-weighted mean 2 int F(mu) mu dmu. Values are clamped to [0, 1].
void view_metal_fresnel(view_material metal, double voh, double f[3]);
void view_metal_average(view_material metal, double average[3]);

/// Returns the split sum's third term: the integral over l of D G / (4 n.v n.l) voh (1 - voh)^6
/// (n.l), with GGX and height-correlated Smith shadowing, with an error of at most 1e-4.
/// view_edge_create makes a table of this term: one channel, 48 x 48 texels at corners,
/// KILN_AXIS_SQRT.
double view_edge(double roughness, double nov);
KILN_CHECKED kiln_result view_edge_create(kiln_context *context, kiln_table *table,
                                          kiln_error *error);

/// The GAMES202 handout's albedo texture of copper, which its figure 6 uses as E_avg.
extern const double view_handout_albedo[3];

#endif

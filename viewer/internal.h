// What the viewer's files share among themselves.
#ifndef KILN_VIEWER_INTERNAL_H
#define KILN_VIEWER_INTERNAL_H

#include "viewer.h"

#include <kiln/brdf.h>

/// Writes the sentence unless `error` is NULL.
void view_describe(kiln_error *error, kiln_result result, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/// The same, and is `result`.
#define view_fail(error, result, ...) (view_describe((error), (result), __VA_ARGS__), (result))

/// A shader with its #includes in place, without version and precision lines; ends in NUL.
extern const char view_shader_screen_vert[], view_shader_scene_frag[];

/// A metal's exact reflectance in linear Rec. 709 under daylight, and its mean 2 int F(mu) mu dmu. Cut
/// to [0, 1].
void view_metal_fresnel(view_material metal, double voh, double f[3]);
void view_metal_average(view_material metal, double average[3]);

/// The split sum's third term, int f / F voh (1 - voh)^6 (n.l) dl with height-correlated Smith, to
/// 1e-4; and a table of it, one channel, texels at corners, on the square root.s axis.
double view_edge(double roughness, double nov);
KILN_CHECKED kiln_result view_edge_create(kiln_context *context, kiln_table *table,
                                          kiln_error *error);

/// What the handout's figure 6 reads for E_avg: the albedo texture.
extern const double view_handout_albedo[3];

#endif

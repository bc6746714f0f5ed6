// The light of maps: values times the solid angles of their texels.
#ifndef KI_LIGHT_H
#define KI_LIGHT_H

#include "image/image.h"

/// Returns the solid angle of a texel up to a factor that depends on the shape and on `size`, the
/// rows of a panorama, of a cube's face or of an octahedron. `row` counts the rows of all faces.
/// The solid angles of an octahedron's texels are taken as equal, and so are those of flat
/// pictures, whose shape is KILN_SHAPE_AUTO.
double ki_texel_weight(kiln_shape shape, int size, int row, int x);

/// Light: sums over the values of texels, each multiplied by its texel's ki_texel_weight.
typedef struct ki_light {
    /// light of the values above 0, and of the magnitudes of the values below 0
    double above_zero, below_zero;
    double above_limit; ///< light of the amounts by which values exceed ki_add_light's `limit`
} ki_light;

/// Adds the light of a row of RGB texels to *light. `limit` may be infinite.
void ki_add_light(kiln_shape shape, int size, int row, int width, const float *rgb, double limit,
                  ki_light *light);
/// Returns the light of values below zero relative to that of values above zero; 1 if there is only
/// light below zero.
double ki_share_below(const ki_light *light);
/// Returns the light of all levels of a map. `above_limit` of the result is the light by which
/// values exceed `limit`.
ki_light ki_map_light(const kiln_map *map, double limit);

/// Sets the values below zero of `count` levels from `first` on to 0, as kiln_map_cut_negative
/// does.
void ki_cut_negative(kiln_context *context, kiln_map *map, int first, int count, kiln_cut *cut);

#endif

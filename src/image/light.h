// Light in maps. The light of a value, of one channel of a texel, is the value times the solid
// angle of its texel.
#ifndef KI_LIGHT_H
#define KI_LIGHT_H

#include "image/image.h"

/// Returns the solid angle of a texel up to a factor that depends on the shape and on `size`, the
/// rows of a panorama, of a cube's face or of an octahedron. `row` counts the rows of all faces.
/// The solid angles of an octahedron's texels are taken as equal, and so are those of flat
/// pictures, whose shape is KILN_SHAPE_AUTO.
double ki_texel_weight(kiln_shape shape, int size, int row, int x);

/// Sums over the three channels of texels. Each value of a channel is multiplied by the solid angle
/// of its texel, up to the constant factor of ki_texel_weight.
typedef struct ki_light {
    double above_zero;  ///< sum over the values above 0
    double below_zero;  ///< sum over the absolute values of the values below 0
    double above_limit; ///< sum over (value - limit) for the values above `limit`
} ki_light;

/// Adds the values of a row of RGB texels, times the solid angles of the texels, to the sums in
/// *light. `limit` may be infinite.
void ki_add_light(kiln_shape shape, int size, int row, int width, const float *rgb, double limit,
                  ki_light *light);
/// Returns the light of values below zero relative to the light of values above zero, below_zero /
/// above_zero. If no value is above zero, returns 1 if there are values below zero, else 0.
double ki_share_below(const ki_light *light);
/// Returns the sums of ki_light over the texels of all levels of a map. `above_limit` of the result
/// counts from `limit`.
ki_light ki_map_light(const kiln_map *map, double limit);

/// Sets the values below zero of `count` levels from `first` on to 0, as kiln_map_cut_negative
/// does.
void ki_cut_negative(kiln_context *context, kiln_map *map, int first, int count, kiln_cut *cut);

#endif

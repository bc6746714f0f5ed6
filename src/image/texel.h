// Single texels of level 0 of a map, whatever its shape: where a texel lies, how large it is, and
// which texels touch it.
#ifndef KI_TEXEL_H
#define KI_TEXEL_H

#include "image/image.h"

/// Points that represent the area of a texel: Gauss-Legendre nodes, with weights in steradians
/// whose sum is the solid angle of the texel.
typedef struct ki_texel_nodes {
    int count;
    double direction[16][3], weight[16];
} ki_texel_nodes;

/// Fills in 2 x 2 or 4 x 4 nodes, as `side` says. With 2 x 2 nodes, integrals of smooth functions
/// over a texel of h radians have a relative error of about h^4 / 4000.
void ki_texel_nodes_find(const kiln_map *map, size_t index, int side, ki_texel_nodes *nodes);
/// Returns the solid angle of a texel in steradians, exact for panoramas.
double ki_texel_solid_angle(const kiln_map *map, size_t index);
/// Returns the texel that holds a direction, which need not be a unit vector.
size_t ki_texel_of_direction(const kiln_map *map, const double direction[3]);
/// Sets the four texels that touch the left, right, upper and lower edge of a texel, across the
/// seam and the poles of a panorama and across the edges of cube faces and octahedra. A texel at
/// such an edge may touch more texels than these.
void ki_texel_neighbors(const kiln_map *map, size_t index, size_t neighbors[4]);

#endif

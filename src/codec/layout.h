// How flat pictures lie on the sphere.
#ifndef KI_LAYOUT_H
#define KI_LAYOUT_H

#include "base/base.h"

/// "panorama", "cross" or "strip", from a picture's sides; NULL where the sides fit none of them.
const char *ki_layout_name(int width, int height);
/// Copies a face of `size` texels a side from a picture of three channels, where the face's upper left
/// corner lies at (x, y); turned by half a turn or not.
void ki_cut_face(const kiln_image *image, int x, int y, int size, bool turned, float *face);
/// Makes a map of one level from a picture of three channels. Where the layout keeps texels in their
/// order, the picture's memory becomes the map's and `image` is zeroed.
kiln_result ki_lay_out(kiln_context *context, kiln_image *image, const char *name,
                       enum kiln_layout layout, kiln_map *map, kiln_error *error);

#endif

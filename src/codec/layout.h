// Makes maps from flat pictures: a picture is a panorama, a cross or strip of cube faces, or an
// octahedron.
#ifndef KI_LAYOUT_H
#define KI_LAYOUT_H

#include "base/base.h"

/// Returns "panorama", "cross" or "strip" for the size of a picture, or NULL if the ratio of the
/// sides fits none of these layouts.
const char *ki_layout_name(int width, int height);
/// Copies a face of `size` x `size` texels from a picture of three channels. The upper left corner
/// of the face is at (x, y); `turned` turns the face by 180 degrees. Returns false if the caller of
/// the library wants to stop.
bool ki_cut_face(kiln_context *context, const kiln_image *image, int x, int y, int size,
                 bool turned, float *face);
/// Makes a map of one level from a picture of three channels. If the layout keeps the order of the
/// texels, the map takes over the picture's memory and `image` is zeroed. Layouts that mix texels
/// mend the picture first and add what was mended, and a note, to *report.
kiln_result ki_lay_out(kiln_context *context, kiln_image *image, const char *name,
                       enum kiln_layout layout, kiln_map *map, kiln_load_report *report,
                       kiln_error *error);

#endif

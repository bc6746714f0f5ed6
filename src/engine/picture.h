// Pictures that a shader reads bilinearly inside a border of their own: parts of an atlas.
#ifndef KI_PICTURE_H
#define KI_PICTURE_H

#include "base/base.h"

/// The radiance wanted at (u, v), from 0 to 1 inside the border and a little beyond in it; returns the
/// solid angle there, in any unit.
typedef double ki_picture_read(const void *data, double u, double v, double rgb[3]);

typedef struct ki_picture {
    int width, height; ///< with the border
    int border;        ///< texels at every edge, 1 at least
    int times;         ///< samples along a texel's side, an even number
    bool roots;        ///< the shader interpolates square roots of radiance
    ki_picture_read *read;
    const void *data;
    float *texels; ///< height * width * 3, radiance or its roots
    float *room;   ///< ki_picture_room(picture) numbers
} ki_picture;

/// How many numbers `room` must have.
size_t ki_picture_room(const ki_picture *picture);
/// Without steps every texel is the mean over its place. Each step moves all texels toward those whose
/// *interpolation* is nearest to what is wanted, by least squares over the solid angle: 12 are enough.
/// False where a report of progress asks to stop.
bool ki_picture_draw(kiln_context *context, const ki_picture *picture, int steps);

#endif

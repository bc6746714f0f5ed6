// Draws pictures that a shader reads bilinearly and that have a border of texels of their own: the
// parts of an atlas.
#ifndef KI_PICTURE_H
#define KI_PICTURE_H

#include "base/base.h"

/// A function that gives the radiance wanted at (u, v) in `rgb` and returns the solid angle per
/// area at (u, v), in any unit. u and v run from 0 to 1 inside the picture's border. In the border
/// they lie slightly outside of this range.
typedef double ki_picture_read(const void *data, double u, double v, double rgb[3]);

typedef struct ki_picture {
    int width, height; ///< size of the picture with its border
    int border;        ///< width of the border at each edge in texels, at least 1
    int times;  ///< number of samples of wanted radiance along a texel's side, an even number
    bool roots; ///< true: the shader interpolates square roots of radiance
    ki_picture_read *read;
    const void *data;
    float *texels; ///< the picture: height * width * 3 numbers, radiance or its square roots
    float *room;   ///< scratch memory, ki_picture_room(picture) numbers
} ki_picture;

/// Returns the number of floats that `room` must have.
size_t ki_picture_room(const ki_picture *picture);
/// Draws a picture. With 0 steps every texel is the mean radiance over its area. Each step moves
/// the texels towards those whose bilinear interpolation has the least square error over the solid
/// angle; 12 steps suffice. Returns false if a progress report asks to stop.
bool ki_picture_draw(kiln_context *context, const ki_picture *picture, int steps);

#endif

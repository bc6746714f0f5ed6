// Colours of files whose red, green and blue are not those of Rec. 709: the matrices that convert
// linear values to linear RGB with the primaries and the white of Rec. 709 (D65), which are those
// of sRGB.
#ifndef KI_COLOR_H
#define KI_COLOR_H

#include "base/base.h"

/// The chromaticities x and y of red, green, blue and white, in this order.
typedef struct ki_primaries {
    double xy[8];
} ki_primaries;

/// A matrix that is multiplied from the left to a column of three values; m[row][column].
typedef struct ki_matrix3 {
    double m[3][3];
} ki_matrix3;

extern const ki_primaries ki_rec709, ki_rec2020, ki_p3_d65;
/// The chromaticity of equal amounts of X, Y and Z (CIE illuminant E), and that of illuminant D50.
extern const double ki_white_e[2], ki_white_d50[2];

/// Sets `matrix` so that it converts linear RGB with the given primaries to linear RGB of Rec. 709.
/// The colour (1, 1, 1) becomes (1, 1, 1): whites are adapted by the Bradford transform. If
/// `neutral` is not NULL, the colour with this chromaticity x, y is adapted to the white of Rec.
/// 709 instead. Primaries within 2e-4 of Rec. 709's, which are those rounded, give the identity
/// without error. Returns false, with the matrix zeroed, if a number is not finite, the primaries
/// do not span a triangle, or the white lies outside the triangle.
bool ki_rec709_from_rgb(const ki_primaries *primaries, const double *neutral, ki_matrix3 *matrix);
/// Sets `matrix` so that it converts CIE XYZ to linear RGB of Rec. 709, where the colour with
/// chromaticity `white` (x, y) and Y = 1 becomes (1, 1, 1). Returns false, with the matrix zeroed,
/// if the white is no colour with positive y.
bool ki_rec709_from_xyz(const double white[2], ki_matrix3 *matrix);

/// Sets `weights` to the luminances Y of the primaries, of which white has 1. Returns false as
/// ki_rec709_from_rgb does.
bool ki_luminance_weights(const ki_primaries *primaries, double weights[3]);

bool ki_matrix_is_identity(const ki_matrix3 *matrix);
ki_matrix3 ki_matrix_multiply(const ki_matrix3 *a, const ki_matrix3 *b);
/// Multiplies each RGB value of a picture of three channels by the matrix. A texel with a channel
/// that is not finite stays as it is, because no colour can be computed for it.
/// Returns false if the caller asks to stop; some rows are then not converted.
bool ki_image_transform(kiln_context *context, const ki_matrix3 *matrix, kiln_image *image);
/// Does the same to one row of `width` texels.
void ki_row_transform(kiln_context *context, const ki_matrix3 *matrix, float *rgb, int width);

#endif

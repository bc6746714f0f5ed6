// Cube faces in the memory layout in which tuning reads and solves levels: every channel of every
// face is a plane of doubles of its own, with a rim one texel wide that repeats the nearest texels
// of the neighbouring faces. Bilinear reads and sums over neighbouring texels then are plain loops
// over a plane, with no special case at the edges of faces.
#ifndef KI_TUNE_FACES_H
#define KI_TUNE_FACES_H

#include "base/base.h"

/// KI_PLANES: number of planes of a cube. Channel c of face f is plane 3 f + c.
enum { KI_PLANES = 18 };

/// A texel of a plane's rim, and the texel of the cube that it repeats.
typedef struct ki_rim_texel {
    uint32_t at;    ///< index of the rim's texel in the planes of face `face`
    uint32_t face;  ///< face whose rim it is
    uint32_t owner; ///< index, in the planes of the owning face, of the texel that is repeated
} ki_rim_texel;

/// Where texels of a cube of one size are in its planes.
typedef struct ki_faces {
    kiln_context *context;
    int size;          ///< texels along the edge of a face
    int width;         ///< texels along the edge of a plane: `size` and a rim of 1 on both sides
    size_t plane;      ///< texels of a plane, `width` squared
    size_t guard;      ///< zeros before each plane, and after the last one
    size_t stride;     ///< floats from the first texel of a plane to that of the next
    ki_rim_texel *rim; ///< texels of all rims, in the order of the faces that own what they repeat
    size_t start[7];   ///< index in `rim` of the first texel that each face owns
} ki_faces;

/// Fails, with `*faces` zeroed, if memory runs out.
kiln_result ki_faces_create(kiln_context *context, int size, ki_faces *faces, kiln_error *error);
void ki_faces_destroy(ki_faces *faces);
/// Returns the number of doubles of the KI_PLANES planes of a cube with their guards.
size_t ki_faces_count(const ki_faces *faces);
/// Returns the first texel, a corner of the rim, of a plane of `planes`.
double *ki_faces_plane(const ki_faces *faces, double *planes, int plane);
/// Copies the texels of one plane that rims of other planes of the same channel repeat, to those
/// rims.
void ki_faces_fill_rims(const ki_faces *faces, double *planes, int plane);
/// Adds what the rims of other planes hold to the texels of one plane that they repeat.
void ki_faces_add_rims(const ki_faces *faces, double *planes, int plane);
/// Fills planes and their rims from the RGB texels of a cube's level.
void ki_faces_load(const ki_faces *faces, const float *texels, double *planes);

/// Where the texels of a finer grid lie between the texels of a plane, along one axis.
typedef struct ki_face_tap {
    int first;       ///< the texel of the plane before the point; the next texel is after it
    double share[2]; ///< weights of these two texels in a linear interpolation, with the sum 1
} ki_face_tap;

/// Sets taps[i] to where texel i of `edge` texels along a face's edge lies in a plane.
void ki_face_taps_set(const ki_faces *faces, int edge, ki_face_tap *taps);
/// Reads a plane bilinearly at row y of `edge` x `edge` points, whose taps ki_face_taps_set has
/// set, and adds `factor` times the values to every third float of `to`. `line` has room for a row
/// of the plane.
void ki_faces_read_row(const ki_faces *faces, const double *plane, int edge,
                       const ki_face_tap *taps, int y, double factor, double *line, float *to);

#endif

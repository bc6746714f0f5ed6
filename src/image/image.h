// Maps and pictures, and the directions of their texels: what cubes, panoramas and octahedra look
// like in memory and on the sphere.
//
// The direction of a texel, the texel of a direction and the solid angle of a texel are defined
// only here. The GLSL functions and the textbook methods use the same definitions.
#ifndef KI_IMAGE_H
#define KI_IMAGE_H

#include "base/base.h"

/// Suffixes of the six cube faces in file names, "px" to "nz".
extern const char *const ki_face_names[6];

/// Sets `direction` for a point of a cube face, with s and t in [-1, 1] across the face (t grows
/// downwards). The direction is not normalised: its largest component is 1.
void ki_face_direction(int face, double s, double t, double direction[3]);
/// Inverts ki_face_direction: returns the face that a direction meets, and sets s and t on that
/// face.
int ki_direction_face(const double direction[3], double *s, double *t);

/// Convert between a point of a panorama, u and v in [0, 1] (v grows downwards), and a unit
/// direction.
void ki_panorama_direction(double u, double v, double direction[3]);
void ki_direction_panorama(const double direction[3], double *u, double *v);

/// Convert between a point of an octahedron map, u and v in [0, 1], and a unit direction.
void ki_octahedron_direction(double u, double v, double direction[3]);
void ki_direction_octahedron(const double direction[3], double *u, double *v);

/// Turns a direction by `degrees` about +Y. The sign is that of every `rotation` in kiln: the map
/// filtered with this rotation has in direction d the value that the unturned map has in direction
/// turn(d).
void ki_turn(const double direction[3], double degrees, double turned[3]);

/// A turn of the environment about any axis: the turned environment has in direction d the value
/// that the unturned one has in direction m d.
typedef struct ki_tilt {
    bool any;     ///< false: no turn, `m` is not used
    bool quarter; ///< true: the turn maps the axes to axes
    double m[3][3];
} ki_tilt;

/// Makes the turn of the angles `rotation`, `pitch` and `roll` in degrees and of the upward axis,
/// as kiln_prefilter_def defines these.
void ki_tilt_make(double rotation, double pitch, double roll, kiln_up up, ki_tilt *tilt);
/// Replaces d by m d, or does nothing if `tilt` is NULL or no turn.
void ki_tilt_apply(const ki_tilt *tilt, double d[3]);
/// Replaces d by the direction that ki_tilt_apply turns to d.
void ki_tilt_undo(const ki_tilt *tilt, double d[3]);

/// Allocates the levels of a map whose shape, size and level_count are set, with texels 0.
kiln_result ki_map_allocate(kiln_context *context, kiln_map *map, kiln_error *error);
kiln_result ki_image_allocate(kiln_context *context, kiln_image *image, kiln_error *error);

/// Sets the width and height in texels of a level whose faces lie one below the other.
void ki_level_extent(const kiln_map *map, int level, int *width, int *height);

/// Fails unless the map's fields are in their ranges and no level is NULL.
kiln_result ki_map_check(const kiln_map *map, kiln_error *error);

/// Fails unless ki_map_check passes and the map is a panorama.
kiln_result ki_map_check_panorama(const kiln_map *map, kiln_error *error);

/// Returns the index of texel (x, y) of a face of a cube of size n. If (x, y) lies one texel beyond
/// the face's edge, the nearest texel of the neighbouring face is returned.
size_t ki_cube_texel(int n, int face, int x, int y);
/// Finds the four texels, and their weights, from which a graphics processor reads a cube of `size`
/// bilinearly, across the edges of faces too, in a direction that is not 0.
void ki_cube_taps(int size, const double direction[3], size_t texels[4], double weights[4]);
/// Reads a level of a cube in a direction, with the texels and weights of ki_cube_taps.
void ki_cube_read(const kiln_map *cube, int level, const double direction[3], double rgb[3]);

/// Mirrors a row of a panorama left to right.
void ki_mirror_row(float *rgb, int width);
/// Multiplies values by 2^stops, as kiln_map_expose does.
void ki_expose_values(float *value, size_t count, double stops);

/// Rows of a panorama in memory, one after the other from north to south.
typedef struct ki_rows {
    const float *rgb; ///< RGB texels of row `first`, which the texels of the other rows follow
    int first, count; ///< number of the first row, and number of rows
} ki_rows;

/// Resamples a map by area as kiln_map_convert does, into level `level` of `target`, which is
/// allocated.
kiln_result ki_map_resample(kiln_context *context, const kiln_map *source, double rotation,
                            kiln_map *target, int level, kiln_error *error);

#endif

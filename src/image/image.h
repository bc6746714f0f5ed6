// Containers and where their texels are.
//
// A texel's solid angle, the direction of a texel and the texel of a direction are defined here
// and nowhere else; GLSL and the textbook methods follow.
#ifndef KI_IMAGE_H
#define KI_IMAGE_H

#include "base/base.h"

/// Suffixes of cube faces in file names, "px" to "nz".
extern const char *const ki_face_names[6];

/// Face, and s and t in [-1, 1] across it (t grows downwards), to a direction that is not
/// normalised: its largest component is 1.
void ki_face_direction(int face, double s, double t, double direction[3]);
/// The inverse: the face a direction meets, and s and t on it.
int ki_direction_face(const double direction[3], double *s, double *t);

/// Panorama: u and v in [0, 1] (v grows downwards) to a unit direction and back.
void ki_panorama_direction(double u, double v, double direction[3]);
void ki_direction_panorama(const double direction[3], double *u, double *v);

/// Octahedron: u and v in [0, 1] to a unit direction and back.
void ki_octahedron_direction(double u, double v, double direction[3]);
void ki_direction_octahedron(const double direction[3], double *u, double *v);

/// Turns a direction by `degrees` about +Y the way `rotation` is meant throughout: the result of
/// filtering with this rotation in direction d is the unturned one in direction turn(d).
void ki_turn(const double direction[3], double degrees, double turned[3]);

/// Fills the levels of a map whose shape, size and level_count are set. Zeroed memory.
kiln_result ki_map_allocate(kiln_context *context, kiln_map *map, kiln_error *error);
kiln_result ki_image_allocate(kiln_context *context, kiln_image *image, kiln_error *error);

/// Width and height of a level, all faces one below the other.
void ki_level_extent(const kiln_map *map, int level, int *width, int *height);

/// Fails unless the map's own numbers are in range and its levels are there.
kiln_result ki_map_check(const kiln_map *map, kiln_error *error);

/// The same, and that it is a panorama.
kiln_result ki_map_check_panorama(const kiln_map *map, kiln_error *error);

/// A cube of `size` read bilinearly across faces, as graphics processors do, in a direction that is not
/// 0: four texels and their weights.
void ki_cube_taps(int size, const double direction[3], size_t texels[4], double weights[4]);
/// The radiance of a cube's level, read so.
void ki_cube_read(const kiln_map *cube, int level, const double direction[3], double rgb[3]);

/// Resamples by area: see kiln_map_convert. `target` is allocated, its level `level` is written.
kiln_result ki_map_resample(kiln_context *context, const kiln_map *source, double rotation,
                            kiln_map *target, int level, kiln_error *error);

#endif

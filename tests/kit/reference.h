// Levels compared with the brute-force sum over all texels of their source.
#ifndef KILN_KIT_REFERENCE_H
#define KILN_KIT_REFERENCE_H

#include <kiln/kiln.h>

#include <stdint.h>

/// A panorama with the scene of scene.h.
kiln_map scene_panorama(kiln_context *context, int size, uint32_t seed);

/// The mean of channel 0 of a picture laid over the whole sphere, seen through the GGX lobe of
/// width alpha around the direction d: each texel is cut into n x n equal areas, by libm and
/// without the library. The picture is the first `columns` x `rows` texels of a panorama.
double ggx_mean(const kiln_map *map, int columns, int rows, double alpha, const double d[3], int n);

typedef struct scene_errors {
    double rms, most; // both relative: to the root mean square of the reference, and to each value
} scene_errors;

/// Compares up to `count` random texels of a level with kiln_reference_filter of the panorama.
scene_errors scene_compare(kiln_context *context, const kiln_map *panorama, const kiln_map *result,
                           int level, const kiln_lobe *lobe, double rotation, int count);

/// White furnace: a uniform environment of `size` rows stays uniform. Returns the largest relative
/// error over all levels of a cube with `face` x `face` texels in level 0, filtered by `lobe`.
double filtered_furnace_error(kiln_context *context, int size, int face, enum kiln_lobe_kind lobe);

#endif

// Levels compared with the brute-force sum over all texels of their source.
#ifndef KILN_KIT_REFERENCE_H
#define KILN_KIT_REFERENCE_H

#include <kiln/kiln.h>

#include <stdint.h>

/// A panorama with the scene of scene.h.
kiln_map scene_panorama(kiln_context *context, int size, uint32_t seed);

typedef struct scene_errors {
    double rms, most; // both relative: to the root mean square of the reference, and to each value
} scene_errors;

/// Compares up to `count` random texels of a level with kiln_reference_filter of the panorama.
scene_errors scene_compare(kiln_context *context, const kiln_map *panorama, const kiln_map *result,
                           int level, const kiln_lobe *lobe, double rotation, int count);

#endif

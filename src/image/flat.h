// Panoramas from flat pictures that are not laid out as panoramas of two to one.
#ifndef KI_FLAT_H
#define KI_FLAT_H

#include "image/image.h"

typedef enum ki_probe {
    KI_PROBE_ANGULAR, ///< an angular map: the angle to -Z grows in proportion to the radius
    KI_PROBE_BALL     ///< the photograph of a mirror ball, by a camera that looks along -Z
} ki_probe;

/// Makes a panorama from a square picture of three channels, which holds all directions in a disc
/// that touches the four sides. The panorama has as many rows as the picture, at most
/// KILN_MAX_SIZE / 2.
kiln_result ki_panorama_from_probe(kiln_context *context, const kiln_image *image, ki_probe probe,
                                   kiln_map *map, kiln_error *error);
/// Makes a panorama from a picture of any sides by stretching both sides over the whole sphere.
/// Each texel is the mean of the picture over the texel's solid angle. The panorama is at least as
/// wide and as high as the picture, unless it would have more than KILN_MAX_SIZE / 2 rows.
kiln_result ki_panorama_stretch(kiln_context *context, const kiln_image *image, kiln_map *map,
                                kiln_error *error);

#endif

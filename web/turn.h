// Turns of panoramas about horizontal axes, for what the web page shows.
#ifndef TURN_H
#define TURN_H

#include <kiln/kiln.h>

/// Turns a map as `pitch`, `roll` (degrees) and `up` of kiln_prefilter_def say, into a panorama.
/// Each texel is the mean of the source's texels at 16 points, which is enough for a picture: the
/// files of the page are turned exactly, by kiln_bake.
kiln_result turn_map(kiln_context *context, const kiln_map *source, double pitch, double roll,
                     kiln_up up, kiln_map *turned, kiln_error *error);

#endif

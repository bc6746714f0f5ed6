// The methods of image-based lighting that textbooks and courses teach, unchanged, to compare with
// kiln's own. docs/theory/textbook.md derives them and lists their errors.
#ifndef KI_TEXTBOOK_H
#define KI_TEXTBOOK_H

#include "base/base.h"

/// Fills level 0 of an allocated map with irradiance / pi, from phi_count x theta_count texels of
/// the panorama for each texel. Both counts are at least 1.
kiln_result ki_textbook_irradiance(kiln_context *context, const kiln_map *panorama, int phi_count,
                                   int theta_count, kiln_map *map, kiln_error *error);
/// Fills all levels of an allocated map with the panorama filtered by GGX, from sample_count
/// samples for each texel. Level k of n gets the roughness k / (n - 1), and a single level the
/// roughness 0.
kiln_result ki_textbook_prefilter(kiln_context *context, const kiln_map *panorama, int sample_count,
                                  kiln_map *map, kiln_error *error);
/// Fills an allocated table of size x size texels and two channels, size at least 2, with A and B
/// of the split sum, from sample_count samples for each texel. Columns run along n.v; roughness
/// falls from 1 in row 0 to 0.
kiln_result ki_textbook_brdf(kiln_context *context, int sample_count, kiln_image *table,
                             kiln_error *error);

#endif

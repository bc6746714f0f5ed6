// The methods that courses teach, kept as they are taught: docs/theory/textbook.md.
#ifndef KI_TEXTBOOK_H
#define KI_TEXTBOOK_H

#include "base/base.h"

/// `map` is allocated; its level 0 is written. Counts are at least 1.
kiln_result ki_textbook_irradiance(kiln_context *context, const kiln_map *panorama, int phi_count,
                                   int theta_count, kiln_map *map, kiln_error *error);
/// `map` is allocated; all its levels are written and their roughness is set to
/// level / (levels - 1), 0 where there is one.
kiln_result ki_textbook_prefilter(kiln_context *context, const kiln_map *panorama, int sample_count,
                                  kiln_map *map, kiln_error *error);
/// `table` is allocated: size x size, two channels, size at least 2.
kiln_result ki_textbook_brdf(kiln_context *context, int sample_count, kiln_image *table,
                             kiln_error *error);

#endif

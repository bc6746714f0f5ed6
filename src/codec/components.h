// The numbers of tables as files hold them: floats, halves, or whole numbers for 0 to 1.
#ifndef KI_COMPONENTS_H
#define KI_COMPONENTS_H

#include "base/base.h"

#include <kiln/brdf.h>

/// Bytes of a number: 4, 2, 2 or 1. Not for KILN_TABLE_FORMAT_AUTO.
int ki_component_bytes(kiln_table_format format);

/// `count` texels of `channels` floats to texels of `stored` numbers, little-endian: colours that
/// are missing become 0, a missing fourth channel 1. Whole numbers are rounded to nearest and clamped
/// to 0 and 1, halves to the largest finite ones.
void ki_components_pack(kiln_table_format format, const float *texels, size_t count, int channels,
                        int stored, uint8_t *bytes);
/// The inverse, for count numbers; not-a-number becomes 0 and infinities the largest finite value.
/// Bytes need no alignment.
void ki_components_unpack(kiln_table_format format, const uint8_t *bytes, size_t count,
                          float *values);

#endif

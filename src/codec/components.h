// The numbers of tables as files store them: floats, halves, or integers that stand for 0 to 1.
#ifndef KI_COMPONENTS_H
#define KI_COMPONENTS_H

#include "base/base.h"

#include <kiln/brdf.h>

/// Returns the number of bytes of one stored number of a table: 4 for floats, 2 for halves and
/// 16-bit integers, 1 for 8-bit integers. `format` is not KILN_TABLE_FORMAT_AUTO.
int ki_component_bytes(kiln_table_format format);

/// Converts `count` texels of `channels` floats to texels of `stored` little-endian numbers.
/// Missing colour channels become 0, a missing fourth channel becomes 1. Integers are rounded to
/// nearest and clamped to 0 to 1, halves are clamped to the largest finite half.
void ki_components_pack(kiln_table_format format, const float *texels, size_t count, int channels,
                        int stored, uint8_t *bytes);
/// Converts `count` stored numbers to floats. Not-a-number becomes 0, and infinities become the
/// largest finite value. `bytes` needs no alignment.
void ki_components_unpack(kiln_table_format format, const uint8_t *bytes, size_t count,
                          float *values);

#endif

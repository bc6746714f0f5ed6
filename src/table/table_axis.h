// Where a table's texels stand: between (n.v, roughness, third) and texel coordinates, both ways, the
// one place that says so. Emitted lookup code follows it.
#ifndef KI_TABLE_AXIS_H
#define KI_TABLE_AXIS_H

#include <kiln/brdf.h>

/// Roughness below which the grazing axis is that of this roughness: its layer would have no width.
#define KI_GRAZING_MIN 1e-6

/// u in [0, 1] of n.v in [0, 1] and back, in the row of a roughness; the grazing axis' c is
/// ki_grazing_scale's. 0 and 1 stay exactly themselves;
/// error below 1e-15.
double ki_axis_from_nov(const kiln_table_def *def, double roughness, double nov);
double ki_axis_to_nov(const kiln_table_def *def, double roughness, double u);

/// n.v of `count` columns of that row from column `from` on.
void ki_axis_columns(const kiln_table_def *def, double roughness, int from, int count, double *nov);

/// What a table's kind has along w: 0 without a third axis.
typedef enum ki_third { KI_THIRD_NONE, KI_THIRD_F0, KI_THIRD_IOR } ki_third;
ki_third ki_table_third(kiln_table_kind kind);
/// w in [0, 1] of F0 or of an ior from 1 to 3, and back.
double ki_third_to_w(ki_third third, double value);
double ki_third_from_w(ki_third third, double w);

/// The place in [0, 1] of texel `index` of `count` (a lone one stands in the middle), and the
/// fractional index of a place, from 0 to count - 1.
double ki_texel_place(int index, int count, bool corners);
double ki_texel_index(double place, int count, bool corners);

#endif

// The arguments that belong to a table's texels: conversions between n.v, roughness and the third
// argument on the one side and places in [0, 1] and texel indices on the other. The lookup code
// that kiln writes (table_code.c) has the same formulas.
#ifndef KI_TABLE_AXIS_H
#define KI_TABLE_AXIS_H

#include <kiln/brdf.h>

/// Least roughness on the axis KILN_AXIS_GRAZING. That axis stretches the range of n.v, about as
/// wide as alpha, in which the albedo E changes fast. At roughness 0 the range is empty, so that
/// table rows of smaller roughness than this are computed at this roughness.
#define KI_GRAZING_MIN 1e-6

/// Returns the place u in [0, 1] along the table's axis def->axis that belongs to nov in [0, 1] in
/// a row of this roughness. Maps 0 to 0 and 1 to 1 exactly; the error is below 1e-15.
/// KILN_AXIS_GRAZING takes its c from ki_grazing_scale.
double ki_axis_from_nov(const kiln_table_def *def, double roughness, double nov);
/// Returns the n.v that belongs to the place u along the table's axis: the inverse function of
/// ki_axis_from_nov.
double ki_axis_to_nov(const kiln_table_def *def, double roughness, double u);

/// Sets nov[i] to the n.v of column from + i of a table's row of this roughness, for i < count.
void ki_axis_columns(const kiln_table_def *def, double roughness, int from, int count, double *nov);

/// The third argument of a kind of table, in addition to n.v and roughness. It varies from slice to
/// slice.
typedef enum ki_third { KI_THIRD_NONE, KI_THIRD_F0, KI_THIRD_IOR } ki_third;
ki_third ki_table_third(kiln_table_kind kind);
/// Returns the place w in [0, 1] along a table's third axis of a value of F0, or of an ior from 1
/// to 3.
double ki_third_to_w(ki_third third, double value);
/// Returns the F0 or ior that belongs to the place w: the inverse function of ki_third_to_w.
double ki_third_from_w(ki_third third, double w);

/// Returns the place in [0, 1] of texel `index` of `count` along an axis. With `corners` the first
/// texel is at 0 and the last at 1; without, texel i is at (i + 1/2) / count. A single texel is at
/// 1/2.
double ki_texel_place(int index, int count, bool corners);
/// Returns the fractional texel index of a place in [0, 1], the inverse function of ki_texel_place,
/// clamped to [0, count - 1].
double ki_texel_index(double place, int count, bool corners);

#endif

// Tables of the reflection model's integrals: their defaults, their texels, and reading them. The
// public structs are in kiln/brdf.h; docs/tables.md describes what a table holds.
#ifndef KI_TABLE_H
#define KI_TABLE_H

#include "base/base.h"

#include <kiln/brdf.h>

/// The number of channels of a table of this kind, 1 to 4.
int ki_table_channels(kiln_table_kind kind);

/// Replaces zeros in `def` by defaults and checks every field. Fails with KILN_ERROR_ARGUMENT.
kiln_result ki_table_complete(kiln_table_def *def, kiln_error *error);

/// Computes the texels of a table whose def ki_table_complete has filled in and whose image is
/// allocated.
kiln_result ki_table_fill(kiln_context *context, kiln_table *table, kiln_error *error);

/// Sets *nov, *roughness and *third (F0 or ior) to the arguments of the texel in column x, row y
/// and `slice`. Implements kiln_table_texel.
void ki_table_texel(const kiln_table *table, int x, int y, int slice, double *nov,
                    double *roughness, double *third);
/// Sets values[channels] to the table's values by linear interpolation. Arguments out of range are
/// clamped. Implements kiln_table_lookup.
void ki_table_lookup(const kiln_table *table, double nov, double roughness, double third,
                     double *values);

/// Fills `average`, a table of one column whose image is allocated, with 2 int E(mu) mu dmu over mu
/// in [0, 1], where E is `table` read by linear interpolation.
kiln_result ki_table_average(kiln_context *context, const kiln_table *table, kiln_table *average,
                             kiln_error *error);

#endif

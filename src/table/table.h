// Tables of the reflection model's integrals, texel by texel.
#ifndef KI_TABLE_H
#define KI_TABLE_H

#include "base/base.h"

#include <kiln/brdf.h>

/// Channels of a kind's texels, 1 to 4.
int ki_table_channels(kiln_table_kind kind);

/// Fills the defaults in and checks every number.
kiln_result ki_table_complete(kiln_table_def *def, kiln_error *error);

/// Fills a table whose def is complete and whose image is allocated.
kiln_result ki_table_fill(kiln_context *context, kiln_table *table, kiln_error *error);

/// See kiln_table_texel, kiln_table_lookup.
void ki_table_texel(const kiln_table *table, int x, int y, int slice, double *nov,
                    double *roughness, double *third);
void ki_table_lookup(const kiln_table *table, double nov, double roughness, double third,
                     double *values);

/// Fills the allocated rows of `average` with 2 int E(mu) mu dmu of what looking `table` up shows.
kiln_result ki_table_average(kiln_context *context, const kiln_table *table, kiln_table *average,
                             kiln_error *error);

#endif

// Tables of the reflection model's integrals, texel by texel.
#ifndef KI_TABLE_H
#define KI_TABLE_H

#include "base/base.h"

/// Channels of a kind's texels, 1 to 4.
int ki_table_channels(kiln_table_kind kind);

/// Fills the defaults in and checks every number.
kiln_result ki_table_complete(kiln_table_def *def, kiln_error *error);

/// Fills a table whose def is complete and whose image is allocated.
kiln_result ki_table_fill(kiln_context *context, kiln_table *table, kiln_error *error);

#endif

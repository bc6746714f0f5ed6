// Tables of the reflection model's integrals: their defaults, their texels, and reading them. The
// public structs are in kiln/brdf.h; docs/tables.md describes what a table holds.
#ifndef KI_TABLE_H
#define KI_TABLE_H

#include "base/base.h"

#include <kiln/brdf.h>

/// Returns the number of channels of a table of this kind, 1 to 4.
int ki_table_channels(kiln_table_kind kind);

/// Replaces zeros in `def` by default values for its kind of table and checks every field. Fails
/// with KILN_ERROR_ARGUMENT.
kiln_result ki_table_complete(kiln_table_def *def, kiln_error *error);

#endif

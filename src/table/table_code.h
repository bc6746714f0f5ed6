// Source code that looks tables up as kiln_table_lookup does.
#ifndef KI_TABLE_CODE_H
#define KI_TABLE_CODE_H

#include "base/bytes.h"

#include <kiln/brdf.h>

typedef enum ki_table_code {
    KI_TABLE_C,            ///< a function on an array of floats
    KI_TABLE_GLSL_TEXTURE, ///< on a sampler2D or, where there are slices, a sampler3D
    KI_TABLE_GLSL_ARRAY    ///< on NAME_number(int), which the caller has written
} ki_table_code;

/// Appends the functions for a complete def; names begin with `name`.
void ki_table_write_code(const kiln_table_def *def, ki_table_code code, const char *name,
                         ki_writer *w);

#endif

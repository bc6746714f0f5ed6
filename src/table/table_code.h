// Writes source code in C or GLSL that reads a table as kiln_table_lookup does.
#ifndef KI_TABLE_CODE_H
#define KI_TABLE_CODE_H

#include "base/bytes.h"

#include <kiln/brdf.h>

typedef enum ki_table_code {
    KI_TABLE_C,            ///< C that reads an array of floats
    KI_TABLE_GLSL_TEXTURE, ///< GLSL that reads a sampler2D, or a sampler3D if depth > 1
    /// GLSL that calls NAME_number(int), a function that the caller writes before this code
    KI_TABLE_GLSL_ARRAY
} ki_table_code;

/// Appends the code that reads a table to `w`. The names of its functions begin with `name`. `def`
/// has been completed by ki_table_complete.
void ki_table_write_code(const kiln_table_def *def, ki_table_code code, const char *name,
                         ki_writer *w);

#endif

// Tables and their lookups as source code, C and GLSL.
#ifndef KI_TABLE_SOURCE_H
#define KI_TABLE_SOURCE_H

#include "base/bytes.h"

#include <kiln/brdf.h>

/// What names begin with: `wanted`, or made from the file's own name where that is NULL.
typedef struct ki_source_name {
    char text[64];
} ki_source_name;
kiln_result ki_source_name_make(const char *path, const char *wanted, ki_source_name *name,
                                kiln_error *error);

/// The table in a C header, floats of any format.
kiln_result ki_table_write_header(const kiln_table *table, const char *path, const char *name,
                                  ki_writer *w, kiln_error *error);
/// The table and its lookup in GLSL; halves and whole numbers are packed into words.
kiln_result ki_table_write_glsl(const kiln_table *table, kiln_table_format format, const char *path,
                                const char *name, ki_writer *w, kiln_error *error);
/// The lookup alone, as a C header or for a GLSL texture.
void ki_table_write_lookup(const kiln_table_def *def, bool glsl, const char *name, ki_writer *w);

#endif

// Writes tables as arrays in C or GLSL source code, with the functions that read them.
#ifndef KI_TABLE_SOURCE_H
#define KI_TABLE_SOURCE_H

#include "base/bytes.h"

#include <kiln/brdf.h>

/// The name with which all identifiers in a table's written source code begin.
typedef struct ki_source_name {
    char text[64];
} ki_source_name;
/// Sets *name to `wanted`, or if `wanted` is NULL to a name made from the file's name in `path`.
/// Fails with KILN_ERROR_ARGUMENT if `wanted` is no identifier of C and GLSL or is too long.
kiln_result ki_source_name_make(const char *path, const char *wanted, ki_source_name *name,
                                kiln_error *error);

/// Appends a C header with the table as an array of floats, `name`_texels. `path` is used in error
/// messages only.
kiln_result ki_table_write_header(const kiln_table *table, const char *path, const char *name,
                                  ki_writer *w, kiln_error *error);
/// Appends GLSL with the table as a constant array and the function that reads it. Halves, 16-bit
/// and 8-bit numbers are packed into 32-bit words. `path` is used in error messages only.
kiln_result ki_table_write_glsl(const kiln_table *table, kiln_table_format format, const char *path,
                                const char *name, ki_writer *w, kiln_error *error);
/// The language of written source code. Only tables of lobes have code in WGSL.
typedef enum ki_language { KI_LANGUAGE_C, KI_LANGUAGE_GLSL, KI_LANGUAGE_WGSL } ki_language;
/// Appends the functions that read a table, without the table: a C header for an array of floats,
/// or functions in GLSL or WGSL for a texture.
void ki_table_write_lookup(const kiln_table_def *def, ki_language language, const char *name,
                           ki_writer *w);

#endif

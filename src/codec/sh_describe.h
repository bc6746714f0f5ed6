// Recognises and describes text files of spherical harmonics.
#ifndef KI_SH_DESCRIBE_H
#define KI_SH_DESCRIBE_H

#include "base/base.h"

/// Return whether bytes begin like a file of kiln_sh_save: its JSON, its lines (or those of
/// Filament's sh.txt), or its C array.
bool ki_sh_json_begins(const uint8_t *bytes, size_t size);
bool ki_sh_lines_begin(const uint8_t *bytes, size_t size);
bool ki_sh_array_begins(const uint8_t *bytes, size_t size);

/// Fill in `info` from a file that the function above with JSON, lines or array in its name
/// recognises.
kiln_result ki_sh_json_describe(kiln_context *context, const uint8_t *bytes, size_t size,
                                const char *name, kiln_file_info *info, kiln_error *error);
kiln_result ki_sh_lines_describe(kiln_context *context, const uint8_t *bytes, size_t size,
                                 const char *name, kiln_file_info *info, kiln_error *error);
kiln_result ki_sh_array_describe(kiln_context *context, const uint8_t *bytes, size_t size,
                                 const char *name, kiln_file_info *info, kiln_error *error);

#endif

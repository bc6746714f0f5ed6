// Spherical harmonics in text files, told and described.
#ifndef KI_SH_DESCRIBE_H
#define KI_SH_DESCRIBE_H

#include "base/base.h"

/// Whether bytes begin as kiln_sh_save's JSON, as its lines or Filament's, or as its C array.
bool ki_sh_json_begins(const uint8_t *bytes, size_t size);
bool ki_sh_lines_begin(const uint8_t *bytes, size_t size);
bool ki_sh_array_begins(const uint8_t *bytes, size_t size);

/// What each of them holds.
kiln_result ki_sh_json_describe(const uint8_t *bytes, size_t size, const char *name,
                                kiln_file_info *info, kiln_error *error);
kiln_result ki_sh_lines_describe(const uint8_t *bytes, size_t size, const char *name,
                                 kiln_file_info *info, kiln_error *error);
kiln_result ki_sh_array_describe(const uint8_t *bytes, size_t size, const char *name,
                                 kiln_file_info *info, kiln_error *error);

#endif

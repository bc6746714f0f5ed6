// Writes spherical harmonics to files.
#ifndef KI_SH_TEXT_H
#define KI_SH_TEXT_H

#include "base/file.h"

/// Fails if the number of bands is out of range. `sh` may be NULL.
kiln_result ki_sh_check(const kiln_sh *sh, kiln_error *error);
/// Adds a file of harmonics to a set; the ending of the path decides the form, as for kiln_sh_save.
kiln_result ki_sh_write(ki_file_set *set, kiln_context *context, const kiln_sh *sh,
                        const char *path, kiln_error *error);

#endif

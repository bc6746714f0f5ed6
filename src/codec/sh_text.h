// Spherical harmonics in files.
#ifndef KI_SH_TEXT_H
#define KI_SH_TEXT_H

#include "base/base.h"

/// Fails where the number of bands is out of range. `sh` may be NULL.
kiln_result ki_sh_check(const kiln_sh *sh, kiln_error *error);

#endif

// Closed forms as source text.
#ifndef KI_FIT_CODE_H
#define KI_FIT_CODE_H

#include "base/bytes.h"

#include <kiln/brdf.h>

/// The function `name` of n.v (mu) and roughness in C (static inline) or GLSL ES 3.00, operation by
/// operation what kiln_fit_evaluate does.
void ki_fit_write_code(const kiln_fit *fit, const char *name, bool glsl, ki_writer *w);

#endif

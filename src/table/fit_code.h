// Writes closed forms of the reflection model's integrals as source code.
#ifndef KI_FIT_CODE_H
#define KI_FIT_CODE_H

#include "base/bytes.h"

#include <kiln/brdf.h>

/// Appends to `w` a function `name` of mu = n.v and roughness in C (static inline), or with `glsl`
/// in GLSL ES 3.00. The function computes the values of kiln_fit_evaluate with the same float
/// operations in the same order. Forms of E_avg have no argument mu.
void ki_fit_write_code(const kiln_fit *fit, const char *name, bool glsl, ki_writer *w);

#endif

// The offline part of GAMES202's fourth assignment (2021), computed as its framework computes it:
// docs/theory/assignment.md.
#ifndef KI_ASSIGNMENT_H
#define KI_ASSIGNMENT_H

#include "base/base.h"

#include <kiln/course.h>

/// `def` is complete: nothing is left 0 for a default. `table` is allocated: size x size, one channel.
kiln_result ki_assignment_energy(kiln_context *context, kiln_assignment_method method,
                                 const kiln_assignment_def *def, kiln_image *table,
                                 kiln_error *error);

/// Fills each row of the allocated `average` with 2 / width sum of E mu over the row of `energy`.
void ki_assignment_average(const kiln_image *energy, kiln_image *average);

/// `table` and `exact` are alike; `map` is allocated with three channels, or NULL.
kiln_difference ki_assignment_compare(const kiln_image *table, const kiln_image *exact,
                                      kiln_image *map);

#endif

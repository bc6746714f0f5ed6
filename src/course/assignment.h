// The tables that the fourth assignment of the course GAMES202 (2021) asks for, computed by the
// methods of the assignment's framework, to compare with the exact integrals.
// docs/theory/assignment.md.
#ifndef KI_ASSIGNMENT_H
#define KI_ASSIGNMENT_H

#include "base/base.h"

#include <kiln/course.h>

/// Fills `table`, an allocated image of size x size with one channel, with estimates of E by
/// `method`. No field of `def` is 0 for a default.
kiln_result ki_assignment_energy(kiln_context *context, kiln_assignment_method method,
                                 const kiln_assignment_def *def, kiln_image *table,
                                 kiln_error *error);

/// Fills each row of `average` with one value, the estimate of E_avg = 2 int E mu dmu from the same
/// row of `energy`: 2 / width times the sum of E mu over the row. `average` is allocated in the
/// size of `energy`.
void ki_assignment_average(const kiln_image *energy, kiln_image *average);

/// Returns the greatest, RMS and mean difference table - exact of two images of the same size, one
/// channel each. If `map` is not NULL, fills it with colours of the difference; it is allocated in
/// their size with three channels.
kiln_difference ki_assignment_compare(const kiln_image *table, const kiln_image *exact,
                                      kiln_image *map);

#endif

// What a sweep over all public functions shares: the numbers that every argument takes, and what
// must hold of each result. The sweep runs under the undefined-behaviour sanitizer in the preset
// asan.
#ifndef KILN_SWEEP_H
#define KILN_SWEEP_H

#include "kit/kit.h"

#include <float.h>
#include <limits.h>

static const int ints[] = {INT_MIN,     INT_MIN + 1,
                           -1024,       -1,
                           0,           1,
                           2,           3,
                           16,          255,
                           1024,        32768,
                           65535,       (1 << 24) + 1,
                           1 << 30,     INT_MAX / 2 + 1,
                           INT_MAX - 1, INT_MAX};
static const double reals[] = {-HUGE_VAL, -DBL_MAX, -1e9,   -1,      -DBL_MIN, -5e-324,
                               -0.0,      0,        5e-324, DBL_MIN, 1e-300,   0.5,
                               1,         1.5,      1e9,    DBL_MAX, HUGE_VAL, (double)NAN};
enum { INTS = sizeof ints / sizeof *ints, REALS = sizeof reals / sizeof *reals };

/// Runs the statement after the macro once for each integer or real number. The arguments name the
/// variables that the loops declare, and a declared name cannot stand in parentheses.
// NOLINTBEGIN(bugprone-macro-parentheses)
#define EACH_INT(n)                                                                                \
    for (int n##_at = 0; n##_at < INTS; n##_at++)                                                  \
        for (int n = ints[n##_at], n##_once = 1; n##_once; n##_once = 0)
#define EACH_REAL(x)                                                                               \
    for (int x##_at = 0; x##_at < REALS; x##_at++)                                                 \
        for (double x = reals[x##_at], x##_once = 1; x##_once > 0; x##_once = 0)
// NOLINTEND(bugprone-macro-parentheses)

/// A context whose work is stopped after a fiftieth of a second and that holds little memory, so
/// that valid but large arguments take no time.
kiln_context *sweep_context(void);
/// Begins the work of the next call: its fiftieth of a second starts now.
void sweep_begin(void);
/// Lets the calls that follow take a minute, for objects that a sweep needs.
void sweep_prepare(void);
/// Number of calls that sweep_check has seen.
extern long sweep_count;
/// Checks that a failure has a message and that the outputs are zeroed: `outputs_empty` says
/// whether they are.
void sweep_check(const char *call, kiln_result result, const kiln_error *e, bool outputs_empty);

/// Makes one call with an error of its own, named `e`, and checks what it returned.
#define SWEEP(call, outputs_empty)                                                                 \
    do {                                                                                           \
        kiln_error e = {0};                                                                        \
        sweep_begin();                                                                             \
        kiln_result sweep_r = (call);                                                              \
        sweep_check(#call, sweep_r, &e, outputs_empty);                                            \
    } while (0)

#endif

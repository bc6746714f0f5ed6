// Includes cmocka with the headers that cmocka needs, and defines checks that print what they
// compare.
#ifndef KILN_CHECK_H
#define KILN_CHECK_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <kiln/kiln.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Checks that |value - wanted| <= bound. All three are doubles.
#define CHECK_NEAR(value, wanted, bound)                                                           \
    do {                                                                                           \
        double check_v = (value), check_w = (wanted), check_b = (bound);                           \
        if (!(fabs(check_v - check_w) <= check_b))                                                 \
            fail_msg("%s is %.17g, wanted %.17g +- %g (off by %g)", #value, check_v, check_w,      \
                     check_b, check_v - check_w);                                                  \
    } while (0)

#define CHECK_BELOW(value, bound)                                                                  \
    do {                                                                                           \
        double check_v = (value), check_b = (bound);                                               \
        if (!(check_v <= check_b))                                                                 \
            fail_msg("%s is %g, the bound is %g", #value, check_v, check_b);                       \
    } while (0)

/// Checks that a call succeeds, and prints its error message if not. The caller must have a
/// kiln_error named `error`.
#define CHECK_OK(call)                                                                             \
    do {                                                                                           \
        if ((call) != KILN_OK)                                                                     \
            fail_msg("%s: %s", #call, error.message);                                              \
    } while (0)

/// Checks that a message contains a part, and prints both if not.
#define CHECK_SAYS(message, part)                                                                  \
    do {                                                                                           \
        const char *check_m = (message), *check_p = (part);                                        \
        if (!strstr(check_m, check_p))                                                             \
            fail_msg("%s is \"%s\", wanted \"%s\" in it", #message, check_m, check_p);             \
    } while (0)

#endif

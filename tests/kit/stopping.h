// Work that is stopped by its progress callback.
#ifndef KILN_KIT_STOPPING_H
#define KILN_KIT_STOPPING_H

#include <stdbool.h>

typedef struct countdown {
    int left;  // number of reports after which the next report stops the work
    int calls; // number of reports until now
} countdown;

/// A progress callback of a context whose user pointer is a countdown. Checks that there is a stage
/// and that the fraction is in [0, 1].
bool count_down(void *user, const char *stage, double fraction);

#endif

// The time, for tests of what happens at a moment or must end soon.
#ifndef KILN_KIT_CLOCK_H
#define KILN_KIT_CLOCK_H

#include <time.h>

// Returns the seconds since a fixed moment in the past.
static inline double seconds_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif

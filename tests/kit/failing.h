// A context whose memory is watched: blocks and bytes are counted, the n-th allocation may fail,
// and what is released is overwritten, so that a later read of it shows.
#ifndef KILN_KIT_FAILING_H
#define KILN_KIT_FAILING_H

#include <kiln/kiln.h>

#include <stdatomic.h>
#include <stdbool.h>

typedef struct failing {
    atomic_long calls; // number of allocations requested since the start
    long fail_at;      // number of the allocation that fails, from 1; 0 for no failure
    bool and_later;    // the allocations after that one fail too
    atomic_long held;  // number of blocks allocated now
    atomic_long bytes; // number of bytes allocated now
    long idle;         // number of blocks that the context held when it was new
} failing;

/// A context with one thread and at most 512 MiB.
kiln_context *failing_context(failing *f);

/// A context with this number of threads and at most 512 MiB.
kiln_context *failing_context_of(failing *f, int threads);

#endif

// What a context is made of. Only the base folder looks inside.
#ifndef KI_CONTEXT_H
#define KI_CONTEXT_H

#include "base/base.h"
#include "base/os.h"

#include <stdatomic.h>

enum { KI_MAX_THREADS = 256 };

typedef struct ki_pool {
    ki_os_mutex mutex;
    ki_os_condition work, done;
    ki_os_thread thread[KI_MAX_THREADS];
    ki_os_work helper; // what each thread runs
    int thread_count;  // helpers; the caller works too
    void (*task)(void *data, int index);
    void *data;
    int count;
    atomic_int next; // the first index nobody has taken
    int running;     // helpers still at it
    unsigned round;  // one a parallel_for
    bool stop;
} ki_pool;

/// Where blocks come from and go back to. It lives as long as the context or any block, so that an object
/// may be freed after its context.
typedef struct ki_heap {
    void *(*allocate)(void *user, size_t size);
    void (*release)(void *user, void *memory, size_t size);
    void *user;
    size_t limit; // 0 for none
    atomic_size_t held, peak;
    atomic_size_t owners; // the context, and every block
} ki_heap;

struct kiln_context {
    kiln_context_def def;
    ki_heap *heap;
    ki_stage said; // the last report of progress
    ki_pool pool;
};

bool ki_threads_start(kiln_context *context);
void ki_threads_stop(kiln_context *context);
enum kiln_cpu ki_cpu_best(void);
const char *ki_cpu_name(enum kiln_cpu cpu);

#endif

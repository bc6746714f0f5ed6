// The fields of a context, which only files in src/base read.
#ifndef KI_CONTEXT_H
#define KI_CONTEXT_H

#include "base/base.h"
#include "base/os.h"
#include "base/region.h"

#include <stdatomic.h>

enum { KI_MAX_THREADS = 256 };
/// Number of depths of calls within progress callbacks whose stops are counted apart; deeper calls
/// are counted with the deepest of these.
enum { KI_MAX_DEPTH = 8 };

typedef struct ki_pool {
    ki_os_mutex mutex;
    ki_os_condition work, done;
    ki_os_thread thread[KI_MAX_THREADS];
    ki_os_work helper; // the function that each helper thread runs, and its data
    int thread_count;  // number of helper threads; the calling thread works too
    void (*task)(void *data, int index);
    void *data;
    int count;
    atomic_int next; // the lowest index of ki_parallel_for that no thread has taken
    // number of helper threads that have not finished the current call of ki_parallel_for
    int running;
    unsigned round; // number of calls of ki_parallel_for so far
    // True while ki_parallel_for runs; written only by the thread that calls it, while no other
    // thread works for the context.
    bool in_use;
    uintptr_t caller; // the thread that called ki_parallel_for, while in_use is true
    int depth;        // the context's depth when ki_parallel_for was called
    bool stop;
} ki_pool;

/// The source of memory blocks. A heap lives until its context and all its blocks are freed, so
/// that an object may be freed after its context.
typedef struct ki_heap {
    void *(*allocate)(void *user, size_t size);
    void (*release)(void *user, void *memory, size_t size);
    void *user;
    size_t limit; // greatest number of bytes that blocks may take at the same time, 0 for no limit
    atomic_size_t held, peak;
    atomic_size_t owners; // number of owners that keep the heap alive: the context and every block
    // Used for blocks of medium size if has_regions is set: if the memory is the system's rather
    // than a caller's.
    ki_regions regions;
    bool has_regions;
} ki_heap;

struct kiln_context {
    // the context's definition, whose thread_count is the number of threads that work
    kiln_context_def def;
    int threads_wanted; // number of threads that the definition asked for
    ki_heap *heap;
    // Scratch of the plan execution that runs; NULL if no execution runs. Only the thread on which
    // the library was called reads or writes it and the next two fields.
    ki_scratch *scratch;
    ki_progress_range said; // stage and range of the last progress report, which ki_go_on repeats
    int depth;              // number of progress callbacks that run, one within the other
    // Number of progress reports that asked to stop, of the calls at each depth. A callback may
    // call the library. A stop of that inner call does not stop the call whose callback made it.
    atomic_uint stops[KI_MAX_DEPTH];
    ki_pool pool;
};

/// Returns whether the calling thread is the one on which the library was called, rather than one
/// that only runs tasks for it.
static inline bool ki_is_caller(const kiln_context *context)
{
    const ki_pool *pool = &context->pool;
    return !pool->in_use || pool->caller == ki_os_this_thread();
}

/// Returns the depth of the call for which the calling thread works, less than KI_MAX_DEPTH.
static inline int ki_depth(const kiln_context *context)
{
    int depth = ki_is_caller(context) ? context->depth : context->pool.depth;
    return depth < KI_MAX_DEPTH ? depth : KI_MAX_DEPTH - 1;
}

/// Starts the threads that the definition asks for, or as many as the system starts. Returns their
/// number, with the calling thread.
int ki_threads_start(kiln_context *context);
void ki_threads_stop(kiln_context *context);
enum kiln_cpu ki_cpu_best(void);
const char *ki_cpu_name(enum kiln_cpu cpu);

#endif

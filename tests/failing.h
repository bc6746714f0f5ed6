// A context whose n-th allocation fails, with a count of the allocated blocks.
#ifndef KILN_TEST_FAILING_H
#define KILN_TEST_FAILING_H

#include "check.h"

typedef struct failing {
    long calls;   // number of allocations requested since the start
    long fail_at; // number of the allocation that fails, from 1; 0 for no failure
    long held;    // number of blocks allocated now
    long idle;    // number of blocks that the context held when it was new
} failing;

static void *failing_allocate(void *user, size_t size)
{
    failing *f = user;
    if (++f->calls == f->fail_at)
        return NULL;
    f->held++;
    return aligned_alloc(64, (size + 63) / 64 * 64);
}

static void failing_release(void *user, void *memory, size_t size)
{
    (void)size;
    ((failing *)user)->held--;
    free(memory);
}

static kiln_context *failing_context(failing *f)
{
    *f = (failing){0};
    kiln_context *context;
    kiln_context_def def = {.allocate = failing_allocate,
                            .release = failing_release,
                            .allocator_user = f,
                            .memory_limit = (size_t)512 << 20,
                            .thread_count = 1};
    assert_int_equal(kiln_context_create(&def, &context, NULL), KILN_OK);
    f->idle = f->held;
    return context;
}

#endif

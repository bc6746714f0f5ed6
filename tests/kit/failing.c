#include "failing.h"

#include "check.h"

static void *failing_allocate(void *user, size_t size)
{
    failing *f = user;
    long call = ++f->calls;
    if (f->fail_at && (call == f->fail_at || (f->and_later && call > f->fail_at)))
        return NULL;
    f->held++;
    f->bytes += (long)size;
    return aligned_alloc(64, (size + 63) / 64 * 64);
}

static void failing_release(void *user, void *memory, size_t size)
{
    failing *f = user;
    f->held--;
    f->bytes -= (long)size;
    memset(memory, 0xdd, size);
    free(memory);
}

kiln_context *failing_context(failing *f)
{
    return failing_context_of(f, 1);
}

kiln_context *failing_context_of(failing *f, int threads)
{
    *f = (failing){0};
    kiln_context *context = NULL;
    kiln_context_def def = {.allocate = failing_allocate,
                            .release = failing_release,
                            .allocator_user = f,
                            .memory_limit = (size_t)512 << 20,
                            .thread_count = threads};
    assert_int_equal(kiln_context_create(&def, &context, NULL), KILN_OK);
    f->idle = f->held;
    return context;
}

// Memory as large as a picture, zeroed. The first write to fresh memory is slow, about a second for
// 3 GB; therefore all threads of the context write together, and the caller can stop them.
#include "base/base.h"

#include <limits.h>
#include <string.h>

enum { PIECE = 1 << 22 }; // number of bytes that one task sets to 0

typedef struct zero_job {
    uint8_t *memory;
    size_t size;
} zero_job;

static void zero_piece(void *data, int index)
{
    const zero_job *job = data;
    size_t first = (size_t)index * PIECE, left = job->size - first;
    memset(job->memory + first, 0, left < PIECE ? left : PIECE);
}

kiln_result ki_alloc_zeroed(kiln_context *context, size_t count, size_t size, const char *what,
                            void **memory, kiln_error *error)
{
    size_t bytes = SIZE_MAX;
    bool fits = ki_mul_size(count, size, &bytes) && bytes / PIECE < INT_MAX;
    *memory = fits ? ki_alloc_raw(context, bytes, 1) : NULL;
    if (!*memory)
        return ki_fail_memory(context, error, what, fits ? bytes : SIZE_MAX);
    zero_job job = {*memory, bytes};
    if (ki_parallel_steps(context, NULL, (int)((bytes + PIECE - 1) / PIECE), zero_piece, &job))
        return KILN_OK;
    ki_free(*memory);
    *memory = NULL;
    return ki_fail_cancelled(error, "allocating memory");
}

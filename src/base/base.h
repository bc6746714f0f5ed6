// The ground everything stands on: errors, memory, threads and the processor's abilities.
#ifndef KI_BASE_H
#define KI_BASE_H

#include <kiln/kiln.h>

#include <float.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

// A double that the compiler keeps with more bits than it stores, as the x87 does, rounds twice: results
// would differ from every other machine's, and loops that compare sums may never end.
_Static_assert(FLT_EVAL_METHOD == 0,
               "kiln needs arithmetic in the precision of its types: on 32-bit x86 compile with "
               "-msse2 -mfpmath=sse");

/// Lets the compiler check a function's arguments against its format, printf's as C17 has it.
#if defined(__MINGW32__) && !defined(__clang__)
#define KI_PRINTF(format_at, first) __attribute__((format(gnu_printf, format_at, first)))
#else
#define KI_PRINTF(format_at, first) __attribute__((format(printf, format_at, first)))
#endif

// ------------------------------------------------------------------------------------------ errors

/// Writes the result and its sentence (printf's format) to `error` unless that is NULL.
void ki_describe(kiln_error *error, kiln_result result, const char *format, ...) KI_PRINTF(3, 4);

/// The same, and is `result`: a macro, so that compilers see that it is not KILN_OK.
#define ki_fail(error, result, ...) (ki_describe((error), (result), __VA_ARGS__), (result))

// ------------------------------------------------------------------------------------------ memory

/// Returns `count` times `size` bytes, zeroed and aligned to 64, or NULL where the context's limit,
/// the allocator or size_t does not suffice. Safe to call from any thread.
void *ki_alloc(kiln_context *context, size_t count, size_t size);
/// The same, not zeroed.
void *ki_alloc_raw(kiln_context *context, size_t count, size_t size);
/// `memory` may be NULL. It knows its context.
void ki_free(void *memory);
/// Writes the sentence "out of memory: WHAT needs N bytes, ...".
void ki_describe_memory(kiln_context *context, kiln_error *error, const char *what,
                        size_t byte_count);
/// Fails with that sentence.
static inline kiln_result ki_fail_memory(kiln_context *context, kiln_error *error, const char *what,
                                         size_t byte_count)
{
    ki_describe_memory(context, error, what, byte_count);
    return KILN_ERROR_MEMORY;
}
/// Multiplies, or returns false on overflow.
bool ki_mul_size(size_t a, size_t b, size_t *product);

// ----------------------------------------------------------------------------------------- threads

typedef void ki_task(void *data, int index);

/// Runs task(data, 0 .. count-1) on the context's threads. The tasks must write different places:
/// then the result cannot depend on their order.
void ki_parallel_for(kiln_context *context, int count, ki_task *task, void *data);

/// The same for tasks that need scratch of their own: `worker` is below ki_context_threads and no
/// two tasks with the same worker run at once.
void ki_parallel_workers(kiln_context *context, int count,
                         void (*task)(void *data, int worker, int index), void *data);

/// Reports progress; false when the caller wants to stop. From the calling thread only. `stage` is a
/// literal.
bool ki_progress(kiln_context *context, const char *stage, double fraction);
/// Says again what was said last: for long work in small steps.
bool ki_go_on(kiln_context *context);
/// Part of a stage's progress, from one fraction to another.
typedef struct ki_stage {
    const char *name;
    double from, to;
} ki_stage;
/// ki_parallel_for that reports progress on its way, or without a stage (NULL) as ki_go_on. False when stopped: some tasks have not run then.
bool ki_parallel_steps(kiln_context *context, const ki_stage *stage, int count, ki_task *task,
                       void *data);
/// KILN_ERROR_CANCELLED with its sentence.
kiln_result ki_fail_cancelled(kiln_error *error, const char *stage);

// --------------------------------------------------------------------------------------- processor

/// The instruction set kernels are chosen by.
enum kiln_cpu ki_context_cpu(const kiln_context *context);
int ki_context_threads(const kiln_context *context);

// -------------------------------------------------------------------------------------- small sums

static inline int ki_min(int a, int b)
{
    return a < b ? a : b;
}

static inline int ki_max(int a, int b)
{
    return a > b ? a : b;
}

/// Not a number becomes `low`.
static inline double ki_clamp(double x, double low, double high)
{
    return x > low ? x < high ? x : high : low;
}

#endif

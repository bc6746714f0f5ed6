// What every other folder of the library uses: error messages, memory, threads, progress reports
// and the instruction set of the processor.
#ifndef KI_BASE_H
#define KI_BASE_H

#include <kiln/kiln.h>

#include <float.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>

// An x87 processor keeps doubles with more bits than memory holds, so that results are rounded
// twice. They would then differ from those of other machines, and loops that compare sums might
// never end.
_Static_assert(FLT_EVAL_METHOD == 0,
               "kiln needs arithmetic in the precision of its types: on 32-bit x86 compile with "
               "-msse2 -mfpmath=sse");

/// Lets the compiler check the arguments of a function against its format string, by the rules of
/// printf in C17.
#if defined(__MINGW32__) && !defined(__clang__)
#define KI_PRINTF(format_at, first) __attribute__((format(gnu_printf, format_at, first)))
#else
#define KI_PRINTF(format_at, first) __attribute__((format(printf, format_at, first)))
#endif

// ------------------------------------------------------------------------------------------ errors

/// Writes the result and an error message (printf's format) to `error`, unless `error` is NULL.
void ki_describe(kiln_error *error, kiln_result result, const char *format, ...) KI_PRINTF(3, 4);

/// Writes the message as ki_describe does and evaluates to `result`. This is a macro, so that
/// compilers see at each call that the value is not KILN_OK.
#define ki_fail(error, result, ...) (ki_describe((error), (result), __VA_ARGS__), (result))

// -------------------------------------------------------------------------------------------- text

/// Prints as snprintf does, with a decimal point in every locale.
int ki_print(char *text, size_t room, const char *format, ...) KI_PRINTF(3, 4);
/// Prints as vsnprintf does, with a decimal point in every locale, and replaces what a terminal
/// would obey (see kiln_text_clean). All sentences of the library pass through this function.
void ki_print_clean(char *text, size_t room, const char *format, va_list list) KI_PRINTF(3, 0);
/// Does what kiln_text_step does for text of `left` bytes, at least 1, that needs no NUL at its
/// end.
int ki_text_step(const char *text, size_t left, unsigned *code, bool *shown);

// ------------------------------------------------------------------------------------------ memory

/// Allocates `count` times `size` bytes, zeroed and aligned to 64. Returns NULL if the context's
/// limit is reached, the allocator fails or the product overflows. Safe to call from any thread.
void *ki_alloc(kiln_context *context, size_t count, size_t size);
/// Allocates as ki_alloc does, but does not zero the memory.
void *ki_alloc_raw(kiln_context *context, size_t count, size_t size);
/// Allocates as ki_alloc does, for memory as large as a picture: the context's threads zero it
/// together, and the caller may stop them. May be called only on the thread on which the library
/// was called. Sets *memory to the memory, or to NULL on failure. Fails with the message of
/// ki_fail_memory, which names `what`, or with that of ki_fail_cancelled.
kiln_result ki_alloc_zeroed(kiln_context *context, size_t count, size_t size, const char *what,
                            void **memory, kiln_error *error);
/// Frees memory from one of these functions; the memory itself records its context. `memory` may
/// be NULL.
void ki_free(void *memory);
/// Writes the error message "out of memory: WHAT: N more bytes are needed", with the context's
/// memory limit if it has one.
void ki_describe_memory(kiln_context *context, kiln_error *error, const char *what,
                        size_t byte_count);
/// Fails with the message of ki_describe_memory.
static inline kiln_result ki_fail_memory(kiln_context *context, kiln_error *error, const char *what,
                                         size_t byte_count)
{
    ki_describe_memory(context, error, what, byte_count);
    return KILN_ERROR_MEMORY;
}
/// Returns the number of bytes that a block of `count` times `size` bytes takes from the context,
/// or SIZE_MAX if the number overflows.
size_t ki_block_size(size_t count, size_t size);

/// A block of memory that can grow. {0} is an empty buffer.
typedef struct ki_buffer {
    void *memory;
    size_t size; ///< size of `memory` in bytes
} ki_buffer;

/// Makes a buffer at least `count` times `size` bytes large. A buffer that must grow loses its
/// content. Returns false, and leaves an empty buffer, when memory runs out.
bool ki_buffer_reserve(kiln_context *context, ki_buffer *buffer, size_t count, size_t size);
void ki_buffer_free(ki_buffer *buffer);

/// Memory from which one execution of a plan allocates, so that it takes nothing from the context.
/// Between ki_scratch_begin and ki_scratch_end, ki_alloc takes blocks from this memory one after
/// the other, and only the calling thread may allocate. The bytes of a freed block are used again
/// once all blocks taken after it are freed too. Blocks that do not fit are allocated by the
/// context as usual. With capacity 0 the scratch only measures how much memory is wanted.
typedef struct ki_scratch {
    uint8_t *memory;
    /// size of `memory` in bytes, and the largest size that executions have wanted
    size_t capacity, peak;
    struct ki_block *top; ///< the last block taken that is not given back yet
} ki_scratch;

void ki_scratch_begin(kiln_context *context, ki_scratch *scratch);
/// Ends an execution's use of the scratch memory. The caller has freed all blocks taken from it.
void ki_scratch_end(kiln_context *context);
/// Enlarges the scratch's memory to the largest size that executions have ever wanted plus `more`
/// bytes. Returns false if memory runs out. Must not be called between ki_scratch_begin and
/// ki_scratch_end.
bool ki_scratch_reserve(kiln_context *context, ki_scratch *scratch, size_t more);
void ki_scratch_free(ki_scratch *scratch);

/// Sets *product to a times b. Returns false on overflow.
bool ki_mul_size(size_t a, size_t b, size_t *product);

// ----------------------------------------------------------------------------------------- threads

typedef void ki_task(void *data, int index);

/// Runs task(data, i) for i = 0 .. count - 1 on the context's threads. No two tasks may write the
/// same place, so that the result does not depend on their order.
void ki_parallel_for(kiln_context *context, int count, ki_task *task, void *data);

/// Runs tasks as ki_parallel_for does, for tasks that need scratch memory of their own. `worker` is
/// less than ki_context_threads, and no two tasks run with the same worker at the same time.
/// Repeats the last report of progress meanwhile, as ki_go_on does. Returns false if a report asked
/// to stop; some tasks have then not run.
bool ki_parallel_workers(kiln_context *context, int count,
                         void (*task)(void *data, int worker, int index), void *data);

/// Reports progress to the caller of the library: `fraction`, 0 to 1, of the work called `stage`, a
/// string literal, is done. Returns false if the caller wants to stop. May be called only on the
/// thread on which the library was called.
bool ki_progress(kiln_context *context, const char *stage, double fraction);
/// Repeats the last report of progress, so that long work with many small steps can be stopped.
/// Returns false if the caller wants to stop.
bool ki_go_on(kiln_context *context);
/// Number of small steps, such as texels that are converted, after which a loop calls ki_go_on.
enum { KI_ASK_EVERY = 1 << 16 };
/// The question whether to go on, for work that may run on several threads. Only the thread on
/// which the library was called asks the caller; the other threads learn from the context that the
/// caller wants to stop. While that thread waits for the others in ki_parallel_steps or
/// ki_parallel_workers it goes on asking, unless the host's own function runs the tasks.
typedef struct ki_asker {
    kiln_context *context;
    int depth;      // number of progress callbacks within which the work was begun
    unsigned stops; // number of stops that the context had seen at this depth when the work began
} ki_asker;
/// Returns the asker of work that begins now, on any thread that runs it.
ki_asker ki_asker_make(kiln_context *context);
/// Returns false if the caller wants to stop, and asks no more once that is known.
bool ki_may_go_on(const ki_asker *asker);
/// Returns whether the caller has asked to stop since the asker was made, whichever function asked.
bool ki_was_stopped(const ki_asker *asker);
/// The range of fractions, within 0 to 1, that a part of the work covers in the progress reports of
/// a stage.
typedef struct ki_progress_range {
    const char *name;
    double from, to;
} ki_progress_range;
/// Runs tasks as ki_parallel_for does and meanwhile reports progress within `range`. If `range` is
/// NULL, repeats the last report as ki_go_on does. Returns false if a report asked to stop; some
/// tasks have then not run.
bool ki_parallel_steps(kiln_context *context, const ki_progress_range *range, int count,
                       ki_task *task, void *data);
/// Returns KILN_ERROR_CANCELLED, with a message that names the stage in *error.
kiln_result ki_fail_cancelled(kiln_error *error, const char *stage);

// --------------------------------------------------------------------------------------- processor

/// Returns the instruction set for which the variants of vectorised functions are chosen.
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

/// Clamps x to [low, high]. Not-a-number becomes `low`.
static inline double ki_clamp(double x, double low, double high)
{
    return x > low ? x < high ? x : high : low;
}

#endif

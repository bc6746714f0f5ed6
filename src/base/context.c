// The context of the library: where memory comes from. In: the context's definition (allocator,
// memory limit, threads, progress callback). Out: memory blocks. Every allocation is counted
// against the limit by atomic operations, so that any thread may allocate.
#include "base/context.h"
#include "base/base.h"

#include <assert.h>
#include <stdalign.h>
#include <stdio.h>
#include <string.h>

#define KI_STR_(x) #x
#define KI_STR(x) KI_STR_(x)

const char *kiln_version(void)
{
    return KI_STR(KILN_VERSION_MAJOR) "." KI_STR(KILN_VERSION_MINOR) "." KI_STR(KILN_VERSION_PATCH);
}

// A header of 64 bytes before every memory block, by which the block is freed. The blocks taken
// from a plan's scratch memory form a list from the last to the first (`below`).
typedef struct ki_block {
    alignas(64) ki_heap *heap;
    size_t size; // size of the memory block in bytes, with this header
    ki_scratch *scratch;
    struct ki_block *below;
    ki_region *region; // the region that the block lies in, or NULL
    // position of the block in the scratch memory; beyond its end for a block that did not fit
    size_t offset;
    // is_freed: the block is freed, but not all blocks taken from the scratch memory after it.
    // is_inside: the block lies in the scratch memory.
    bool is_freed, is_inside;
} ki_block;

bool ki_mul_size(size_t a, size_t b, size_t *product)
{
    return !__builtin_mul_overflow(a, b, product);
}

static void *system_allocate(void *user, size_t size)
{
    (void)user;
    return ki_os_allocate(size);
}

static void system_release(void *user, void *memory, size_t size)
{
    (void)user;
    ki_os_release(memory, size);
}

static ki_heap *heap_create(const kiln_context_def *def)
{
    ki_heap *heap = def->allocate(def->allocator_user, sizeof *heap);
    if (!heap)
        return NULL;
    memset(heap, 0, sizeof *heap);
    heap->allocate = def->allocate;
    heap->release = def->release;
    heap->user = def->allocator_user;
    heap->limit = def->memory_limit;
    heap->has_regions = def->allocate == system_allocate && ki_regions_help();
    if (heap->has_regions)
        ki_regions_begin(&heap->regions);
    atomic_store(&heap->owners, 1);
    return heap;
}

// Drops one owner of the heap: the context, or a block that is freed. The last owner frees the
// heap.
static void heap_leave(ki_heap *heap)
{
    if (atomic_fetch_sub(&heap->owners, 1) != 1)
        return;
    if (heap->has_regions)
        ki_regions_end(&heap->regions);
    heap->release(heap->user, heap, sizeof *heap);
}

size_t ki_block_size(size_t count, size_t size)
{
    size_t bytes;
    if (!ki_mul_size(count, size, &bytes) || bytes > SIZE_MAX - 2 * sizeof(ki_block))
        return SIZE_MAX;
    return (bytes + sizeof(ki_block) + 63) & ~(size_t)63;
}

// A context that holds less memory than this, in bytes, leaves medium blocks to the system too and
// keeps no region without a block, so that it takes no large page.
enum { FEW = 1 << 20 };

static ki_block *heap_take(ki_heap *heap, size_t bytes)
{
    size_t held = atomic_fetch_add(&heap->held, bytes) + bytes;
    ki_block *block = NULL;
    ki_region *region = NULL;
    if (!heap->limit || (held <= heap->limit && held >= bytes)) {
        if (heap->has_regions && held > FEW && bytes >= KI_REGION_LEAST && bytes <= KI_REGION_MOST)
            block = ki_region_take(&heap->regions, bytes, &region);
        if (!block)
            block = heap->allocate(heap->user, bytes);
    }
    if (!block) {
        atomic_fetch_sub(&heap->held, bytes);
        return NULL;
    }
    atomic_fetch_add(&heap->owners, 1);
    size_t peak = atomic_load(&heap->peak);
    while (held > peak && !atomic_compare_exchange_weak(&heap->peak, &peak, held)) {
    }
    *block = (ki_block){.heap = heap, .size = bytes, .region = region};
    return block;
}

static void heap_give(ki_block *block)
{
    ki_heap *heap = block->heap;
    size_t size = block->size;
    size_t left = atomic_fetch_sub(&heap->held, size) - size;
    ki_region *region = block->region;
    if (region)
        ki_region_give(&heap->regions, region, block, size);
    else
        heap->release(heap->user, block, size);
    if (heap->has_regions && left <= FEW && (region || left + size > FEW))
        ki_regions_trim(&heap->regions);
    heap_leave(heap);
}

static ki_block *scratch_take(ki_heap *heap, ki_scratch *scratch, size_t bytes)
{
    size_t offset = scratch->top ? scratch->top->offset + scratch->top->size : 0;
    bool is_inside = offset <= scratch->capacity && bytes <= scratch->capacity - offset;
    ki_block *block =
        is_inside ? (ki_block *)(void *)(scratch->memory + offset) : heap_take(heap, bytes);
    if (!block)
        return NULL;
    *block = (ki_block){.heap = heap,
                        .size = bytes,
                        .scratch = scratch,
                        .below = scratch->top,
                        .region = is_inside ? NULL : block->region,
                        .offset = offset,
                        .is_inside = is_inside};
    scratch->top = block;
    scratch->peak = offset + bytes > scratch->peak ? offset + bytes : scratch->peak;
    return block;
}

static void scratch_give(ki_block *block)
{
    ki_scratch *scratch = block->scratch;
    block->is_freed = true;
    while (scratch->top && scratch->top->is_freed) {
        ki_block *top = scratch->top;
        scratch->top = top->below;
        if (!top->is_inside)
            heap_give(top);
    }
}

void ki_scratch_begin(kiln_context *context, ki_scratch *scratch)
{
    context->scratch = scratch;
}

void ki_scratch_end(kiln_context *context)
{
    assert(!context->scratch->top);
    context->scratch = NULL;
}

bool ki_scratch_reserve(kiln_context *context, ki_scratch *scratch, size_t more)
{
    if (more > SIZE_MAX / 2 || scratch->peak > SIZE_MAX / 2)
        return false;
    ki_free(scratch->memory);
    scratch->capacity = scratch->peak + more;
    scratch->memory = ki_alloc_raw(context, scratch->capacity, 1);
    if (!scratch->memory)
        scratch->capacity = 0;
    return scratch->memory != NULL;
}

void ki_scratch_free(ki_scratch *scratch)
{
    ki_free(scratch->memory);
    *scratch = (ki_scratch){0};
}

void *ki_alloc_raw(kiln_context *context, size_t count, size_t size)
{
    size_t bytes = ki_block_size(count, size);
    if (bytes == SIZE_MAX)
        return NULL;
    ki_scratch *scratch = ki_is_caller(context) ? context->scratch : NULL;
    ki_block *block =
        scratch ? scratch_take(context->heap, scratch, bytes) : heap_take(context->heap, bytes);
    return block ? block + 1 : NULL;
}

void *ki_alloc(kiln_context *context, size_t count, size_t size)
{
    void *memory = ki_alloc_raw(context, count, size);
    if (memory)
        memset(memory, 0, count * size);
    return memory;
}

void ki_free(void *memory)
{
    if (!memory)
        return;
    ki_block *block = (ki_block *)memory - 1;
    if (block->scratch)
        scratch_give(block);
    else
        heap_give(block);
}

bool ki_buffer_reserve(kiln_context *context, ki_buffer *buffer, size_t count, size_t size)
{
    size_t bytes;
    bool fits = ki_mul_size(count, size, &bytes);
    if (fits && bytes <= buffer->size)
        return true;
    ki_buffer_free(buffer);
    buffer->memory = fits ? ki_alloc_raw(context, bytes, 1) : NULL;
    buffer->size = buffer->memory ? bytes : 0;
    return buffer->memory != NULL;
}

void ki_buffer_free(ki_buffer *buffer)
{
    ki_free(buffer->memory);
    *buffer = (ki_buffer){0};
}

void ki_describe_memory(kiln_context *context, kiln_error *error, const char *what,
                        size_t byte_count)
{
    if (context->heap->limit)
        ki_describe(
            error, KILN_ERROR_MEMORY,
            "out of memory: %s: %zu more bytes are needed, the context holds %zu of at most %zu",
            what, byte_count, atomic_load(&context->heap->held), context->heap->limit);
    else
        ki_describe(error, KILN_ERROR_MEMORY, "out of memory: %s: %zu more bytes are needed", what,
                    byte_count);
}

kiln_result kiln_context_create(const kiln_context_def *def, kiln_context **context,
                                kiln_error *error)
{
    kiln_context_def d = def ? *def : (kiln_context_def){0};
    *context = NULL;
    if (!d.allocate != !d.release)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "allocate and release must be given together");
    if (d.thread_count < 0 || d.thread_count > KI_MAX_THREADS)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "thread_count is %d, it must be 0 to %d",
                       d.thread_count, KI_MAX_THREADS);
    enum kiln_cpu best = ki_cpu_best();
    if ((int)d.cpu < 0 || d.cpu > KILN_CPU_AVX512)
        return ki_fail(error, KILN_ERROR_ARGUMENT, "cpu is %d, it must be 0 to %d", (int)d.cpu,
                       (int)KILN_CPU_AVX512);
    if (!d.allocate) {
        d.allocate = system_allocate;
        d.release = system_release;
    }
    if (d.cpu == KILN_CPU_BEST || d.cpu > best)
        d.cpu = best;
    if (d.thread_count == 0)
        d.thread_count = ki_min(ki_os_core_count(), KI_MAX_THREADS);

    kiln_context *c = d.allocate(d.allocator_user, sizeof *c);
    ki_heap *heap = c ? heap_create(&d) : NULL;
    if (!heap) {
        if (c)
            d.release(d.allocator_user, c, sizeof *c);
        return ki_fail(error, KILN_ERROR_MEMORY, "out of memory: a context needs %zu bytes",
                       sizeof *c + sizeof *heap);
    }
    memset(c, 0, sizeof *c);
    c->def = d;
    c->heap = heap;
    c->threads_wanted = d.thread_count;
    if (!d.parallel_for)
        c->def.thread_count = ki_threads_start(c);
    *context = c;
    return KILN_OK;
}

void kiln_context_destroy(kiln_context *context)
{
    if (!context)
        return;
    if (!context->def.parallel_for)
        ki_threads_stop(context);
    ki_heap *heap = context->heap;
    context->def.release(context->def.allocator_user, context, sizeof *context);
    heap_leave(heap);
}

void kiln_context_threads(const kiln_context *context, int *running, int *wanted)
{
    if (running)
        *running = context->def.thread_count;
    if (wanted)
        *wanted = context->threads_wanted;
}

void kiln_context_memory(const kiln_context *context, size_t *current, size_t *peak)
{
    if (current)
        *current = atomic_load(&context->heap->held);
    if (peak)
        *peak = atomic_load(&context->heap->peak);
}

const char *kiln_context_cpu(const kiln_context *context)
{
    return ki_cpu_name(context->def.cpu);
}

enum kiln_cpu ki_context_cpu(const kiln_context *context)
{
    return context->def.cpu;
}

int ki_context_threads(const kiln_context *context)
{
    return context->def.thread_count;
}

// The memory of a batch's contexts. In: requests for blocks. Out: blocks aligned to 64 bytes, of
// which all contexts together never hold more than the batch's limit. Method: blocks of 64 kB or
// more have one of eight sizes in each power of two; a block that is released waits in the list of
// its size until a block of this size is wanted, or until memory runs short.
#include "batch.h"

#include <stdlib.h>
#include <string.h>

enum { ALIGNMENT = 64, SMALLEST = 1 << 16, CLASSES = 512 };

// What stands before the bytes that a caller receives.
typedef struct batch_block {
    struct batch_block *next;
    void *memory; // what malloc returned
    size_t size;  // of the whole block, with this header and what aligns it
    int class;    // of its size, or -1 for small blocks
} batch_block;

enum { HEADER = 64 };

// Rounds a size up to one of eight sizes in its power of two, and returns the number of that size.
static int class_of(size_t *size)
{
    int shift = 0;
    while (*size >> (shift + 4))
        shift++;
    size_t step = (size_t)1 << shift;
    *size = (*size + step - 1) / step * step;
    if (*size >> (shift + 4)) // rounded up to the next power of two
        shift++;
    return 8 * shift + (int)((*size >> shift) & 7);
}

static bool reserve(batch *all, size_t size)
{
    size_t held = atomic_fetch_add(&all->held, size) + size;
    if (held <= all->limit)
        return true;
    atomic_fetch_sub(&all->held, size);
    return false;
}

static void free_block(batch *all, batch_block *block)
{
    atomic_fetch_sub(&all->held, block->size);
    free(block->memory);
}

static batch_block *make_block(batch_heap *heap, size_t size, int class)
{
    size_t whole = size + HEADER + ALIGNMENT;
    if (!reserve(heap->batch, whole)) {
        batch_heap_trim(heap);
        if (!reserve(heap->batch, whole))
            return NULL;
    }
    char *memory = malloc(whole);
    if (!memory) {
        atomic_fetch_sub(&heap->batch->held, whole);
        return NULL;
    }
    char *at = memory + HEADER;
    at += (ALIGNMENT - (uintptr_t)at % ALIGNMENT) % ALIGNMENT;
    batch_block *block = (batch_block *)(void *)(at - HEADER);
    *block = (batch_block){.memory = memory, .size = whole, .class = class};
    return block;
}

static batch_block *take_free(batch_heap *heap, int class)
{
    os_lock(&heap->mutex);
    batch_block *block = heap->free[class];
    if (block)
        heap->free[class] = block->next;
    os_unlock(&heap->mutex);
    return block;
}

static void count(batch_heap *heap, size_t added, size_t removed)
{
    os_lock(&heap->mutex);
    heap->held += added;
    heap->held -= removed;
    heap->peak = heap->held > heap->peak ? heap->held : heap->peak;
    os_unlock(&heap->mutex);
}

void *batch_allocate(void *user, size_t size)
{
    batch_heap *heap = user;
    int class = -1;
    if (size > SIZE_MAX / 4)
        return NULL;
    if (size >= SMALLEST)
        class = class_of(&size);
    batch_block *block = class >= 0 ? take_free(heap, class) : NULL;
    if (!block)
        block = make_block(heap, size, class);
    if (!block)
        return NULL;
    count(heap, block->size, 0);
    return (char *)block + HEADER;
}

void batch_release(void *user, void *memory, size_t size)
{
    batch_heap *heap = user;
    batch_block *block = (batch_block *)(void *)((char *)memory - HEADER);
    (void)size;
    count(heap, 0, block->size);
    if (block->class < 0) {
        free_block(heap->batch, block);
        return;
    }
    os_lock(&heap->mutex);
    block->next = heap->free[block->class];
    heap->free[block->class] = block;
    os_unlock(&heap->mutex);
}

void batch_heap_begin(batch_heap *heap, batch *all)
{
    *heap = (batch_heap){.batch = all};
    os_mutex_begin(&heap->mutex);
}

void batch_heap_trim(batch_heap *heap)
{
    os_lock(&heap->mutex);
    for (int i = 0; i < CLASSES; i++)
        for (batch_block *block; (block = heap->free[i]) != NULL;) {
            heap->free[i] = block->next;
            free_block(heap->batch, block);
        }
    os_unlock(&heap->mutex);
}

void batch_heap_end(batch_heap *heap)
{
    batch_heap_trim(heap);
    os_mutex_end(&heap->mutex);
}

void batch_heap_mark(batch_heap *heap)
{
    os_lock(&heap->mutex);
    heap->peak = heap->held;
    os_unlock(&heap->mutex);
}

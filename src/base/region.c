// Regions of memory for blocks of medium size. In: sizes of blocks. Out: blocks, and what they
// leave free for later blocks. Method: each region has a bit for each of its units of 4 KiB, which
// is set while a block is there, and a block takes the first sufficiently long run of free units of
// the oldest region that has one. Blocks thus gather in few pages.
#include "base/region.h"

#include <string.h>

enum { BITS = 64, WORDS = KI_REGION_UNITS / BITS };

// The head of a region lies in the first units of its memory.
struct ki_region {
    ki_region *next, *previous;
    // upper bound of the length of the longest run of free units, and the number of free units
    int room, free;
    uint64_t taken[WORDS];
};

enum { HEAD = (sizeof(ki_region) + KI_REGION_UNIT - 1) / KI_REGION_UNIT };

bool ki_regions_help(void)
{
#if defined(__wasm__) || defined(KI_OS_CHECKS_BLOCKS)
    return false;
#else
    return true;
#endif
}

void ki_regions_begin(ki_regions *regions)
{
    *regions = (ki_regions){0};
    ki_os_mutex_begin(&regions->mutex);
}

void ki_regions_end(ki_regions *regions)
{
    for (ki_region *r = regions->first, *next; r; r = next) {
        next = r->next;
        ki_os_release(r, KI_REGION_BYTES);
    }
    ki_os_mutex_end(&regions->mutex);
}

// Marks units as taken or free, which they were not before.
static void turn(ki_region *r, int first, int count)
{
    for (int end = first + count, here; first < end; first = here) {
        here = (first / BITS + 1) * BITS < end ? (first / BITS + 1) * BITS : end;
        r->taken[first / BITS] ^= ~(uint64_t)0 >> (BITS - (here - first)) << first % BITS;
    }
}

// Returns the first unit of a run of `count` free units. Without one, returns -1 and sets the
// region's room to the length of the longest run.
static int find_run(ki_region *r, int count)
{
    int run = 0, longest = 0;
    for (int i = HEAD; i < KI_REGION_UNITS;) {
        uint64_t word = r->taken[i / BITS];
        if (i % BITS == 0 && (!word || !~word)) {
            run = word ? 0 : run + BITS;
            i += BITS;
        } else {
            run = word >> i % BITS & 1 ? 0 : run + 1;
            i++;
        }
        if (run >= count)
            return i - run;
        longest = run > longest ? run : longest;
    }
    r->room = longest;
    return -1;
}

static void link_after(ki_regions *regions, ki_region *before, ki_region *r)
{
    r->previous = before;
    r->next = before ? before->next : regions->first;
    *(before ? &before->next : &regions->first) = r;
    *(r->next ? &r->next->previous : &regions->last) = r;
}

static void unlink_region(ki_regions *regions, ki_region *r)
{
    *(r->previous ? &r->previous->next : &regions->first) = r->next;
    *(r->next ? &r->next->previous : &regions->last) = r->previous;
}

// Returns whether the region has a run of `count` free units, and sets *first to its first unit.
static bool has_run(ki_region *r, int count, int *first)
{
    *first = r->room < count ? -1 : find_run(r, count);
    return *first >= 0;
}

// Adds a region after the last one and returns it, or NULL if there is no memory.
static ki_region *add_region(ki_regions *regions)
{
    ki_region *r = ki_os_allocate(KI_REGION_BYTES);
    if (!r)
        return NULL;
    *r = (ki_region){.room = KI_REGION_UNITS - HEAD, .free = KI_REGION_UNITS - HEAD};
    turn(r, 0, HEAD);
    link_after(regions, regions->last, r);
    regions->count++;
    return r;
}

static int unit_count(size_t size)
{
    return (int)((size + KI_REGION_UNIT - 1) / KI_REGION_UNIT);
}

void *ki_region_take(ki_regions *regions, size_t size, ki_region **region)
{
    int count = unit_count(size), first = -1;
    ki_os_lock(&regions->mutex);
    ki_region *r = regions->first;
    for (int left = KI_REGION_SEARCH; r && !has_run(r, count, &first); left--)
        r = left > 1 ? r->next : r == regions->last ? NULL : regions->last;
    if (!r) {
        r = add_region(regions);
        first = HEAD;
    }
    if (r) {
        turn(r, first, count);
        r->free -= count;
        regions->empty = regions->empty == r ? NULL : regions->empty;
    }
    ki_os_unlock(&regions->mutex);
    *region = r;
    return r ? (char *)r + (ptrdiff_t)first * KI_REGION_UNIT : NULL;
}

void ki_region_give(ki_regions *regions, ki_region *region, void *memory, size_t size)
{
    ki_region *gone = NULL;
    int count = unit_count(size);
    ki_os_lock(&regions->mutex);
    turn(region, (int)(((char *)memory - (char *)region) / KI_REGION_UNIT), count);
    region->free += count;
    region->room = region->free;
    bool is_empty = region->free == KI_REGION_UNITS - HEAD;
    if (is_empty && regions->empty) {
        unlink_region(regions, region);
        regions->count--;
        gone = region;
    } else if (is_empty) {
        regions->empty = region;
    }
    if (!gone && regions->count > KI_REGION_SEARCH) {
        unlink_region(regions, region);
        link_after(regions, NULL, region);
    }
    ki_os_unlock(&regions->mutex);
    ki_os_release(gone, KI_REGION_BYTES);
}

void ki_regions_trim(ki_regions *regions)
{
    ki_os_lock(&regions->mutex);
    ki_region *gone = regions->empty;
    if (gone) {
        unlink_region(regions, gone);
        regions->count--;
        regions->empty = NULL;
    }
    ki_os_unlock(&regions->mutex);
    ki_os_release(gone, KI_REGION_BYTES);
}

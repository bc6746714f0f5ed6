// Memory for blocks of medium size. Systems stop a process at the first use of every page, usually
// of 4 KiB, and C libraries give blocks of some hundred KiB back at once, so that the next block
// stops the process again. Regions of 8 MiB, for which large pages are asked, are shared by many
// blocks and are kept while blocks are in them.
#ifndef KI_REGION_H
#define KI_REGION_H

#include "base/os.h"

enum {
    KI_REGION_BYTES = 8 << 20,
    KI_REGION_UNIT = 4096, ///< bytes of a unit; a block takes whole units
    KI_REGION_UNITS = KI_REGION_BYTES / KI_REGION_UNIT,
    /// Range of sizes in bytes for which regions are worth their price: smaller blocks would waste
    /// much of a unit, larger ones get large pages of their own. Four of the largest fit into a
    /// region beside its head.
    KI_REGION_LEAST = 8 << 10,
    KI_REGION_MOST = KI_REGION_BYTES / 4 - KI_REGION_UNIT,
    /// Number of regions that are looked through for a block before the last one, so that the
    /// search takes no longer in a context with many.
    KI_REGION_SEARCH = 128,
};

typedef struct ki_region ki_region;

/// A set of regions. Any thread may take and give blocks.
typedef struct ki_regions {
    ki_os_mutex mutex;
    /// The regions in the order in which they were made. If there are more than KI_REGION_SEARCH, a
    /// region becomes the first when a block of it is given back.
    ki_region *first, *last;
    ki_region *empty; ///< the one region without a block that is kept for the next block, or NULL
    int count;        ///< number of regions
} ki_regions;

/// Returns whether contexts should use regions. They should not in WebAssembly, where no memory is
/// ever given back to the system, nor in programs that are compiled with a sanitizer, which checks
/// the blocks of malloc alone.
bool ki_regions_help(void);
/// Makes an empty set. ki_regions_end must be called at its end.
void ki_regions_begin(ki_regions *regions);
/// Gives the regions back to the system. No block may be in them.
void ki_regions_end(ki_regions *regions);
/// Takes a block of `size` bytes, from KI_REGION_LEAST to KI_REGION_MOST, aligned to 64, and sets
/// *region to the region that it lies in. Returns NULL if there is no memory.
void *ki_region_take(ki_regions *regions, size_t size, ki_region **region);
/// Gives back a block of `size` bytes that lies in `region`.
void ki_region_give(ki_regions *regions, ki_region *region, void *memory, size_t size);
/// Gives the region that is kept for the next block back to the system.
void ki_regions_trim(ki_regions *regions);

#endif

// Regions of memory, shared by blocks of medium size: blocks lie apart from each other, memory that
// is given back is used again, and regions without blocks go back to the system.
#include "base/base.h"
#include "base/region.h"

#include "kit/kit.h"
#include "kit/random.h"

enum { LIVE = 200, STEPS = 20000 };

typedef struct block {
    unsigned char *memory;
    size_t size;
    ki_region *region;
    unsigned char mark;
} block;

// Takes a block and writes its mark to the first and the last byte and to some between them.
static block take(ki_regions *regions, size_t size, unsigned char mark)
{
    block b = {.size = size, .mark = mark};
    b.memory = ki_region_take(regions, size, &b.region);
    assert_non_null(b.memory);
    assert_int_equal((uintptr_t)b.memory % 64, 0);
    assert_true(b.memory > (unsigned char *)b.region);
    assert_true(b.memory + size <= (unsigned char *)b.region + KI_REGION_BYTES);
    for (size_t i = 0; i < size; i += 1000)
        b.memory[i] = mark;
    b.memory[size - 1] = mark;
    return b;
}

static bool is_whole(const block *b)
{
    bool good = b->memory[b->size - 1] == b->mark;
    for (size_t i = 0; i < b->size; i += 1000)
        good &= b->memory[i] == b->mark;
    return good;
}

static void give(ki_regions *regions, block *b)
{
    assert_true(is_whole(b));
    ki_region_give(regions, b->region, b->memory, b->size);
    *b = (block){0};
}

// Takes and gives blocks of random sizes in a random order, small ones more often than large ones.
static void shuffle(ki_regions *regions, uint64_t seed, int steps)
{
    static const size_t sizes[] = {
        KI_REGION_LEAST, KI_REGION_LEAST + 1, 3 * KI_REGION_UNIT, 50000, 200000,
        1 << 20,         KI_REGION_MOST - 1,  KI_REGION_MOST};
    block live[LIVE] = {{0}};
    for (int i = 0; i < steps; i++) {
        uint64_t random = random_bits(&seed), few = random % 64;
        block *b = &live[(random >> 8) % LIVE];
        if (b->memory)
            give(regions, b);
        else
            *b = take(regions, sizes[few < 8 ? few : few % 5], (unsigned char)(random >> 32));
    }
    for (int i = 0; i < LIVE; i++)
        if (live[i].memory)
            give(regions, &live[i]);
}

static void blocks_keep_what_is_written(void **state)
{
    (void)state;
    ki_regions regions;
    ki_regions_begin(&regions);
    shuffle(&regions, 1, STEPS);
    // only the region that is kept for the next block is left
    assert_non_null(regions.empty);
    assert_ptr_equal(regions.first, regions.empty);
    ki_regions_end(&regions);
}

static void free_memory_is_used_again(void **state)
{
    (void)state;
    enum { COUNT = 40 };
    ki_regions regions;
    block blocks[COUNT];
    ki_regions_begin(&regions);
    for (int i = 0; i < COUNT; i++)
        blocks[i] = take(&regions, 1 << 20, (unsigned char)i);
    // 7 blocks of 256 units lie in each region of 2048 units, of which its head takes the first
    assert_ptr_equal(blocks[6].region, blocks[0].region);
    assert_ptr_not_equal(blocks[7].region, blocks[0].region);
    // A block that is given back leaves the first place where a block of this size fits.
    for (int i = 3; i < COUNT; i += 9) {
        const unsigned char *place = blocks[i].memory;
        give(&regions, &blocks[i]);
        blocks[i] = take(&regions, (1 << 20) - 4000, (unsigned char)i);
        assert_ptr_equal(blocks[i].memory, place);
    }
    // two neighbours together make room for a larger block
    const unsigned char *place = blocks[8].memory;
    give(&regions, &blocks[8]);
    give(&regions, &blocks[9]);
    block large = take(&regions, KI_REGION_MOST, 200);
    assert_ptr_equal(large.memory, place);
    give(&regions, &large);
    for (int i = 0; i < COUNT; i++)
        if (blocks[i].memory)
            give(&regions, &blocks[i]);
    assert_ptr_equal(regions.first, regions.empty);
    ki_regions_end(&regions);
}

static void four_of_the_largest_fit(void **state)
{
    (void)state;
    ki_regions regions;
    block blocks[5];
    ki_regions_begin(&regions);
    for (int i = 0; i < 5; i++)
        blocks[i] = take(&regions, KI_REGION_MOST, (unsigned char)i);
    assert_ptr_equal(blocks[3].region, blocks[0].region);
    assert_ptr_not_equal(blocks[4].region, blocks[0].region);
    for (int i = 0; i < 5; i++)
        give(&regions, &blocks[i]);
    // one region is kept for the next block until it is asked back
    assert_int_equal(regions.count, 1);
    ki_regions_trim(&regions);
    assert_int_equal(regions.count, 0);
    assert_null(regions.first);
    assert_null(regions.last);
    ki_regions_end(&regions);
}

// In a context with many regions a block is looked for in some of them only. A region in which
// memory becomes free is among these.
static void many_regions_are_not_searched(void **state)
{
    (void)state;
    enum { COUNT = 7 * (KI_REGION_SEARCH + 20) }; // seven blocks of 1 MiB fit into a region
    static block blocks[COUNT];
    ki_regions regions;
    ki_regions_begin(&regions);
    for (int i = 0; i < COUNT; i++) {
        blocks[i].memory = ki_region_take(&regions, 1 << 20, &blocks[i].region);
        assert_non_null(blocks[i].memory);
    }
    assert_int_equal(regions.count, KI_REGION_SEARCH + 20);
    for (int i = 3; i < COUNT; i += 50) {
        unsigned char *place = blocks[i].memory;
        ki_region_give(&regions, blocks[i].region, place, 1 << 20);
        blocks[i].memory = ki_region_take(&regions, 1 << 20, &blocks[i].region);
        assert_ptr_equal(blocks[i].memory, place);
    }
    assert_int_equal(regions.count, KI_REGION_SEARCH + 20);
    for (int i = 0; i < COUNT; i++)
        ki_region_give(&regions, blocks[i].region, blocks[i].memory, 1 << 20);
    assert_ptr_equal(regions.first, regions.last);
    assert_ptr_equal(regions.first, regions.empty);
    ki_regions_end(&regions);
}

static void shuffle_task(void *data, int index)
{
    shuffle(data, (uint64_t)index, STEPS / 20);
}

static void threads_share_regions(void **state)
{
    (void)state;
    kiln_error error;
    kiln_context *context;
    ki_regions regions;
    ki_regions_begin(&regions);
    CHECK_OK(kiln_context_create(&(kiln_context_def){.thread_count = 4}, &context, &error));
    assert_true(ki_parallel_steps(context, NULL, 16, shuffle_task, &regions));
    kiln_context_destroy(context);
    assert_ptr_equal(regions.first, regions.empty);
    ki_regions_end(&regions);
}

static void objects_outlive_their_context(void **state)
{
    (void)state;
    kiln_error error;
    kiln_context *context;
    size_t held, before;
    CHECK_OK(kiln_context_create(NULL, &context, &error));
    unsigned char *blocks[8];
    for (int i = 0; i < 8; i++) {
        kiln_context_memory(context, &before, NULL);
        blocks[i] = ki_alloc(context, 300000, 1);
        assert_non_null(blocks[i]);
        memset(blocks[i], i, 300000);
        kiln_context_memory(context, &held, NULL);
        assert_int_equal(held - before, ki_block_size(300000, 1)); // wherever the block lies
    }
    ki_free(blocks[5]);
    blocks[5] = ki_alloc(context, 300000, 1);
    for (int i = 0; i < 300000; i++)
        assert_int_equal(blocks[5][i], 0);
    kiln_context_destroy(context);
    for (int i = 0; i < 8; i++) {
        assert_int_equal(blocks[i][299999], i == 5 ? 0 : i);
        ki_free(blocks[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_keep_what_is_written),
        cmocka_unit_test(free_memory_is_used_again),
        cmocka_unit_test(four_of_the_largest_fit),
        cmocka_unit_test(many_regions_are_not_searched),
        cmocka_unit_test(threads_share_regions),
        cmocka_unit_test(objects_outlive_their_context),
    };
    return cmocka_run_group_tests_name("regions", tests, NULL, NULL);
}

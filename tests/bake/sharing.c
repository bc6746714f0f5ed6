// One plan on several threads at a time: a prefilter is constant, so that threads with a context
// and a workspace each may execute it together, exact and tuned levels, and write what one thread
// writes.
#include "kit/kit.h"

#include "bake/prefilter.h"

enum { THREADS = 4, SIZE = 32, EXECUTIONS = 2 };

// A mirror, a level that is interpolated on a grid, and a level that is evaluated at its texels.
static const float exact_roughness[] = {0, 0.6f, 0.9f};
static const kiln_prefilter_def exact = {
    .size = 64, .level_count = 3, .roughness = exact_roughness, .rotation = 20};
static const kiln_prefilter_def tuned = {.size = 4, .rotation = 20};

typedef struct shared {
    const ki_prefilter *prefilter;
    kiln_map levels[THREADS]; // the levels that each thread has written last
} shared;

static kiln_map make_levels(kiln_context *context, const ki_prefilter *prefilter)
{
    kiln_map map;
    kiln_error error;
    CHECK_OK(kiln_map_create(context, prefilter->def.shape, prefilter->def.size,
                             prefilter->def.level_count, &map, &error));
    return map;
}

// Executes the prefilter for the source of that seed, again and again in one workspace.
static kiln_map execute(kiln_context *context, const ki_prefilter *prefilter, int seed)
{
    kiln_error error;
    ki_prefilter_workspace workspace;
    kiln_map levels = make_levels(context, prefilter);
    kiln_map source = scene_panorama(context, SIZE, (uint32_t)seed);
    CHECK_OK(ki_prefilter_workspace_create(context, prefilter, &workspace, &error));
    for (int i = 0; i < EXECUTIONS; i++)
        CHECK_OK(
            ki_prefilter_execute(prefilter, &workspace, &source, &source, false, &levels, &error));
    ki_prefilter_workspace_free(&workspace);
    kiln_map_free(&source);
    return levels;
}

static void execute_on_thread(void *data, int index)
{
    shared *s = data;
    kiln_context *context = make_context_for(1, KILN_CPU_BEST);
    s->levels[index] = execute(context, s->prefilter, index + 1);
    kiln_context_destroy(context);
}

static double read_linearly(double r, int level_count, int size)
{
    (void)size;
    return r * (level_count - 1);
}

static void check_sharing(const kiln_prefilter_def *layout, const ki_reading *reading)
{
    kiln_error error;
    ki_prefilter *prefilter;
    kiln_context *context = make_context_for(THREADS, KILN_CPU_BEST);
    CHECK_OK(ki_prefilter_create(context, SIZE, NULL, layout, reading, &prefilter, &error));
    shared s = {.prefilter = prefilter};
    ki_parallel_for(context, THREADS, execute_on_thread, &s);
    for (int i = 0; i < THREADS; i++) {
        kiln_map wanted = execute(context, prefilter, i + 1);
        for (int k = 0; k < wanted.level_count; k++)
            assert_memory_equal(s.levels[i].level[k], wanted.level[k],
                                3 * kiln_map_texels(&wanted, k) * sizeof(float));
        kiln_map_free(&wanted);
        kiln_map_free(&s.levels[i]);
    }
    ki_prefilter_destroy(prefilter);
    kiln_context_destroy(context);
}

static void threads_share_exact_levels(void **state)
{
    (void)state;
    check_sharing(&exact, NULL);
}

static void threads_share_tuned_levels(void **state)
{
    (void)state;
    check_sharing(&tuned, &(ki_reading){.level = read_linearly});
}

// Different sources differ in every level, else the comparison above would see no mixed-up buffers.
static void sources_differ(void **state)
{
    (void)state;
    kiln_error error;
    ki_prefilter *prefilter;
    kiln_context *context = make_context_for(1, KILN_CPU_BEST);
    CHECK_OK(ki_prefilter_create(context, SIZE, NULL, &exact, NULL, &prefilter, &error));
    kiln_map a = execute(context, prefilter, 1), b = execute(context, prefilter, 2);
    for (int k = 0; k < a.level_count; k++)
        assert_true(largest_difference(&a, &b, k, 0) > 1e-3);
    kiln_map_free(&a);
    kiln_map_free(&b);
    ki_prefilter_destroy(prefilter);
    kiln_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_share_exact_levels),
        cmocka_unit_test(threads_share_tuned_levels),
        cmocka_unit_test(sources_differ),
    };
    return cmocka_run_group_tests_name("sharing", tests, NULL, NULL);
}

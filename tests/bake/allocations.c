// A plan executes without an allocation: of panoramas and cubes, exact and tuned levels, on one
// thread and on several.
#include "kit/kit.h"

static kiln_error error;

// The fill of a source: a sun and noise, black, white, light of the highest frequency, or many
// suns.
static void fill(kiln_map *map, int kind)
{
    size_t texels = kiln_map_texels(map, 0);
    uint64_t seed = 5;
    for (size_t i = 0; i < texels; i++)
        for (size_t c = 0; c < 3; c++) {
            double noise = random_number(&seed);
            float value[] = {(float)noise, 0, 1, (float)(i & 1), 1e-6f};
            map->level[0][3 * i + c] = value[kind];
        }
    for (size_t i = 0; kind == 0 && i < 3; i++)
        map->level[0][texels + i] = 1e5f;
    for (size_t i = 0; kind == 4 && i < texels; i += texels / 5)
        map->level[0][3 * i] = 1;
}

static void execute_all(kiln_context *context, failing *f, kiln_shape shape, int size,
                        const kiln_bake_def *def)
{
    kiln_plan *plan;
    kiln_environment made;
    kiln_map source = make_map(context, shape, size, 1);
    CHECK_OK(kiln_plan_create(context, shape, size, def, &plan, &error));
    CHECK_OK(kiln_plan_environment(plan, &made, &error));
    long before = f->calls;
    for (int i = 0; i < 5; i++) {
        fill(&source, i);
        CHECK_OK(kiln_plan_execute(plan, &source, &made, &error));
        if (f->calls != before)
            fail_msg("fill %d of shape %d, size %d%s: %ld allocations", i, (int)shape, size,
                     def->engine ? ", tuned" : "", f->calls - before);
        kiln_environment wanted; // the plan's scratch changes nothing
        CHECK_OK(kiln_bake(context, &source, def, &wanted, &error));
        check_same_levels(&wanted.levels, &made.levels);
        assert_memory_equal(&wanted.sh, &made.sh, sizeof made.sh);
        kiln_environment_free(&wanted);
        before = f->calls;
    }
    kiln_environment_free(&made);
    kiln_plan_destroy(plan);
    kiln_map_free(&source);
}

static void plans_execute_without_allocations(void **state)
{
    (void)state;
    static const int threads[] = {1, 3};
    kiln_bake_def exact = {.levels = {.size = 16, .level_count = 3}, .irradiance_size = 4};
    kiln_bake_def changed = {.levels = {.size = 8, .level_count = 2, .rotation = 30},
                             .mirror = true,
                             .exposure = 1,
                             .sh_bands = 5};
    kiln_bake_def tuned = {.levels = {.size = 16},
                           .engine = kiln_engine_find("three"),
                           .tune = KILN_TUNE_SHARP,
                           .irradiance_size = 8};
    for (int i = 0; i < 2; i++) {
        failing f;
        kiln_context *context = failing_context_of(&f, threads[i]);
        execute_all(context, &f, KILN_SHAPE_PANORAMA, 32, &exact);
        execute_all(context, &f, KILN_SHAPE_CUBE, 16, &exact);
        execute_all(context, &f, KILN_SHAPE_OCTAHEDRON, 16, &exact);
        execute_all(context, &f, KILN_SHAPE_PANORAMA, 32, &changed);
        execute_all(context, &f, KILN_SHAPE_CUBE, 16, &changed);
        execute_all(context, &f, KILN_SHAPE_PANORAMA, 16, &tuned);
        execute_all(context, &f, KILN_SHAPE_CUBE, 8, &tuned);
        kiln_context_destroy(context);
        assert_int_equal(f.held, 0);
    }
}

// More suns than a plan expects cost one allocation once, and give what kiln_bake gives.
static void many_suns_allocate_once(void **state)
{
    (void)state;
    failing f;
    kiln_context *context = failing_context(&f);
    kiln_plan *plan;
    kiln_environment made, wanted;
    kiln_bake_def bake = {.levels = {.size = 8}, .irradiance_size = 2};
    kiln_map source = make_panorama(context, 256);
    for (size_t i = 0; i < 200; i++)
        source.level[0][3 * (i * 551 + 20000)] = 1000; // of 131072 texels
    CHECK_OK(kiln_plan_create(context, KILN_SHAPE_PANORAMA, 256, &bake, &plan, &error));
    CHECK_OK(kiln_plan_environment(plan, &made, &error));
    long before = f.calls;
    CHECK_OK(kiln_plan_execute(plan, &source, &made, &error));
    assert_true(f.calls > before);
    before = f.calls;
    CHECK_OK(kiln_plan_execute(plan, &source, &made, &error));
    assert_int_equal(f.calls, before);
    CHECK_OK(kiln_bake(context, &source, &bake, &wanted, &error));
    check_same_levels(&wanted.levels, &made.levels);
    kiln_environment_free(&wanted);
    kiln_environment_free(&made);
    kiln_plan_destroy(plan);
    kiln_map_free(&source);
    kiln_context_destroy(context);
    assert_int_equal(f.held, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plans_execute_without_allocations),
        cmocka_unit_test(many_suns_allocate_once),
    };
    return cmocka_run_group_tests_name("allocations", tests, NULL, NULL);
}

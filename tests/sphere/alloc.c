// Every call with its n-th allocation refused: an error, nothing kept, nothing broken.
#include "kit/kit.h"

static kiln_result bake(kiln_context *context, const kiln_map *in, kiln_error *error)
{
    static const float roughness[] = {0, 0.4f, 0.8f};
    kiln_map out, cube;
    kiln_spectrum *spectrum = NULL;
    kiln_sh sh;
    kiln_prefilter_def def = {.size = 8, .level_count = 3, .roughness = roughness};
    kiln_result result = kiln_prefilter(context, in, &def, &out, error);
    if (result != KILN_OK) {
        assert_null(out.level[0]);
        return result;
    }
    result = kiln_prefilter(context, &out, &def, &cube, error); // through a panorama
    if (result == KILN_OK)
        result = kiln_spectrum_analyze(context, in, 20, &spectrum, error);
    if (result == KILN_OK)
        result = kiln_spectrum_sh(spectrum, 3, true, 0, 0, &sh, error);
    kiln_spectrum_destroy(spectrum);
    kiln_map_free(&cube);
    kiln_map_free(&out);
    return result;
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    failing f;
    kiln_context *context = failing_context(&f);
    kiln_error error;
    kiln_map in = scene_panorama(context, 16, 1);
    size_t before, after;
    kiln_context_memory(context, &before, NULL);
    int n = 0;
    f.and_later = true;
    for (kiln_result result = KILN_ERROR_MEMORY; result != KILN_OK; n++) {
        f.fail_at = f.calls + n + 1;
        memset(&error, 0, sizeof error);
        result = bake(context, &in, &error);
        assert_true(result == KILN_OK || result == KILN_ERROR_MEMORY);
        assert_true(result == KILN_OK || strstr(error.message, "out of memory"));
        kiln_context_memory(context, &after, NULL);
        assert_int_equal(after, before);
        assert_true(n < 5000);
    }
    printf("%d allocations, each refused once\n", n - 1);
    assert_true(n > 50);
    f.fail_at = 0;
    kiln_map_free(&in);
    kiln_context_destroy(context);
}

static void the_memory_limit_holds(void **state)
{
    (void)state;
    kiln_context_def def = {.memory_limit = 1 << 20, .thread_count = 1};
    kiln_context *context;
    kiln_error error;
    kiln_map in, out;
    CHECK_OK(kiln_context_create(&def, &context, &error));
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_PANORAMA, 64, 1, &in, &error));
    assert_int_equal(kiln_prefilter(context, &in, NULL, &out, &error), KILN_ERROR_MEMORY);
    CHECK_SAYS(error.message, "1048576");
    size_t peak;
    kiln_context_memory(context, NULL, &peak);
    assert_true(peak <= 1 << 20);
    kiln_map_free(&in);
    kiln_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_allocation_may_fail),
        cmocka_unit_test(the_memory_limit_holds),
    };
    return cmocka_run_group_tests_name("sphere alloc", tests, NULL, NULL);
}

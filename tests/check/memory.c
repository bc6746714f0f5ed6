// Checks whose n-th allocation fails: they fail with a message, free what they hold, and zero what
// they report.
#include <kiln/check.h>

#include "kit/kit.h"

static kiln_map panorama, cube;
static kiln_image table;
static kiln_sh sh;

typedef kiln_result check(kiln_context *context, bool *empty, kiln_error *error);

static kiln_result levels(kiln_context *context, bool *empty, kiln_error *error)
{
    kiln_check_levels_report report;
    kiln_map difference;
    kiln_result result =
        kiln_check_levels(context, &panorama, &cube, NULL, &report, &difference, error);
    *empty = !report.level_count && !difference.level_count;
    kiln_map_free(&difference);
    return result;
}

static kiln_result shown(kiln_context *context, bool *empty, kiln_error *error)
{
    kiln_check_shown_report report;
    kiln_result result =
        kiln_check_shown(context, &panorama, &cube, kiln_engine_find("three"), &report, error);
    *empty = !report.direction_count;
    return result;
}

static kiln_result harmonics(kiln_context *context, bool *empty, kiln_error *error)
{
    kiln_check_sh_report report;
    kiln_result result = kiln_check_sh(context, &panorama, &sh, NULL, &report, error);
    *empty = !report.bands;
    return result;
}

static kiln_result tables(kiln_context *context, bool *empty, kiln_error *error)
{
    kiln_check_table_report report;
    kiln_result result = kiln_check_table(context, &table, false, &report, error);
    *empty = !report.channels;
    return result;
}

// Lets each allocation fail in turn, or every `step`-th.
static void every_allocation(check *run, long step)
{
    failing f = {0};
    kiln_context *context = failing_context(&f);
    kiln_error error = {0};
    bool empty = false;
    long before = f.calls;
    assert_int_equal(run(context, &empty, &error), KILN_OK);
    long count = f.calls - before;
    assert_true(count > 0);
    for (long n = 1; n <= count; n += step) {
        f.fail_at = f.calls + n;
        error.message[0] = 0;
        kiln_result result = run(context, &empty, &error);
        if (result != KILN_OK) { // caches may need fewer allocations later on
            assert_int_equal(result, KILN_ERROR_MEMORY);
            CHECK_SAYS(error.message, "memory");
            assert_true(empty);
        }
        assert_int_equal(f.held, f.idle);
    }
    f.fail_at = 0;
    kiln_context_destroy(context);
}

static void failures_leave_nothing(void **state)
{
    (void)state;
    kiln_context *context = make_context(1);
    kiln_error error;
    kiln_table made;
    panorama = scene_panorama(context, 16, 3);
    CHECK_OK(kiln_prefilter(context, &panorama, &(kiln_prefilter_def){.size = 8, .level_count = 3},
                            &cube, &error));
    CHECK_OK(kiln_map_sh(context, &panorama, 3, 0, &sh, &error));
    CHECK_OK(kiln_table_create(context,
                               &(kiln_table_def){.kind = KILN_TABLE_DFG, .width = 16, .height = 16},
                               &made, &error));
    table = made.image;
    every_allocation(levels, 17);
    every_allocation(shown, 5);
    every_allocation(harmonics, 1);
    every_allocation(tables, 1);
    kiln_table_free(&made);
    kiln_map_free(&cube);
    kiln_map_free(&panorama);
    kiln_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(failures_leave_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

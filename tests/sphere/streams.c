// The same bits by every way in: rows fed to a stream, and a plan executed again and again.
#include "kit/kit.h"

static void a_stream_gives_the_same_bits(void **state)
{
    (void)state;
    kiln_context *context = make_context_for(2, KILN_CPU_BEST);
    kiln_error error;
    kiln_map in = scene_panorama(context, 100, 23), a, b;
    kiln_lobe lobe = kiln_lobe_ggx(0.2);
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 32, 1, &a, &error));
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_CUBE, 32, 1, &b, &error));
    kiln_spectrum *spectrum;
    CHECK_OK(kiln_spectrum_analyze(context, &in, 150, &spectrum, &error));
    CHECK_OK(kiln_spectrum_filter(context, spectrum, &lobe, 0, &a, 0, &error));
    kiln_spectrum_destroy(spectrum);
    for (int step = 1; step < 100; step += 32) {
        kiln_stream *stream;
        CHECK_OK(kiln_stream_begin(context, 100, 150, &stream, &error));
        for (int y = 0; y < 100; y += step)
            CHECK_OK(kiln_stream_rows(stream, in.level[0] + (size_t)y * 600,
                                      step < 100 - y ? step : 100 - y, &error));
        CHECK_OK(kiln_stream_finish(stream, &spectrum, &error));
        CHECK_OK(kiln_spectrum_filter(context, spectrum, &lobe, 0, &b, 0, &error));
        kiln_spectrum_destroy(spectrum);
        assert_true(hash_map(&a) == hash_map(&b));
    }
    // Rows missing or too many are refused.
    kiln_stream *stream;
    CHECK_OK(kiln_stream_begin(context, 100, 20, &stream, &error));
    CHECK_OK(kiln_stream_rows(stream, in.level[0], 60, &error));
    assert_int_equal(kiln_stream_rows(stream, in.level[0], 41, &error), KILN_ERROR_ARGUMENT);
    assert_int_equal(kiln_stream_finish(stream, &spectrum, &error), KILN_ERROR_ARGUMENT);
    assert_null(spectrum);
    kiln_map_free(&a);
    kiln_map_free(&b);
    kiln_map_free(&in);
    kiln_context_destroy(context);
}

static void a_plan_repeats_itself(void **state)
{
    (void)state;
    kiln_context *context = make_context_for(2, KILN_CPU_BEST);
    kiln_error error;
    kiln_map one = scene_panorama(context, 64, 1), two = scene_panorama(context, 64, 2), wanted;
    kiln_environment out;
    kiln_bake_def def = {.levels = {.size = 32}};
    kiln_plan *plan;
    CHECK_OK(kiln_plan_create(context, KILN_SHAPE_PANORAMA, 64, &def, &plan, &error));
    CHECK_OK(kiln_plan_environment(plan, &out, &error));
    const kiln_map *inputs[] = {&one, &two, &one};
    for (int i = 0; i < 3; i++) {
        CHECK_OK(kiln_plan_execute(plan, inputs[i], &out, &error));
        CHECK_OK(kiln_prefilter(context, inputs[i], &def.levels, &wanted, &error));
        assert_true(hash_map(&out.levels) == hash_map(&wanted));
        kiln_map_free(&wanted);
    }
    kiln_map wrong;
    CHECK_OK(kiln_map_create(context, KILN_SHAPE_PANORAMA, 65, 1, &wrong, &error));
    assert_int_equal(kiln_plan_execute(plan, &wrong, &out, &error), KILN_ERROR_ARGUMENT);
    kiln_map_free(&wrong);
    kiln_environment_free(&out);
    kiln_map_free(&one);
    kiln_map_free(&two);
    kiln_plan_destroy(plan);
    kiln_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stream_gives_the_same_bits),
        cmocka_unit_test(a_plan_repeats_itself),
    };
    return cmocka_run_group_tests_name("sphere streams", tests, NULL, NULL);
}

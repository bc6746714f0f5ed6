// The same bits for every number of threads, every instruction set, every way in.
#include "kit/kit.h"

typedef struct outcome {
    uint64_t maps, sh;
} outcome;

static outcome bake(int threads, enum kiln_cpu cpu)
{
    kiln_context *context = make_context_for(threads, cpu);
    kiln_error error;
    outcome result = {0, 0};
    // A tall spectrum, a width that is no power of two, a split lobe, every kernel.
    static const int sizes[] = {40, 128, 98};
    for (int i = 0; i < 3; i++) {
        static const float tiny[] = {0.02f, 0.3f, 0.9f};
        kiln_map in = scene_panorama(context, sizes[i], 17u + (uint32_t)i), out;
        kiln_prefilter_def def = {.size = i == 2 ? 8 : 64, .rotation = i * 20.0};
        if (i == 2) {
            def.level_count = 3;
            def.roughness = tiny;
        }
        CHECK_OK(kiln_prefilter(context, &in, &def, &out, &error));
        result.maps = result.maps * 31 + hash_map(&out);
        kiln_map_free(&out);
        kiln_spectrum *spectrum;
        kiln_sh sh;
        CHECK_OK(kiln_spectrum_analyze(context, &in, 0, &spectrum, &error));
        CHECK_OK(kiln_spectrum_sh(spectrum, 5, false, 0, 10, &sh, &error));
        for (int k = 0; k < 25; k++) {
            uint64_t bits;
            memcpy(&bits, &sh.c[k][0], sizeof bits);
            result.sh = result.sh * 1099511628211u + bits;
        }
        kiln_spectrum_destroy(spectrum);
        kiln_map_free(&in);
    }
    kiln_context_destroy(context);
    return result;
}

static void one_hash_for_1_to_32_threads(void **state)
{
    (void)state;
    static const int counts[] = {2, 3, 4, 7, 16, 32};
    outcome wanted = bake(1, KILN_CPU_BEST);
    assert_true(wanted.maps != 0 && wanted.sh != 0);
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        outcome got = bake(counts[i], KILN_CPU_BEST);
        assert_true(got.maps == wanted.maps && got.sh == wanted.sh);
    }
}

static void one_hash_for_every_instruction_set(void **state)
{
    (void)state;
    outcome wanted = bake(2, KILN_CPU_SCALAR);
    int tried = 0;
    for (int cpu = KILN_CPU_SSE2; cpu <= KILN_CPU_AVX512; cpu++) {
        kiln_context *context = make_context_for(1, (enum kiln_cpu)cpu);
        static const char *const names[] = {"best", "scalar", "sse2", "avx2", "avx512"};
        bool here = !strcmp(kiln_context_cpu(context), names[cpu]);
        kiln_context_destroy(context);
        if (!here) {
            printf("this processor has no %s\n", names[cpu]);
            continue;
        }
        outcome got = bake(2, (enum kiln_cpu)cpu);
        assert_true(got.maps == wanted.maps && got.sh == wanted.sh);
        tried++;
    }
    printf("%d instruction sets agree with scalar\n", tried);
}

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
        cmocka_unit_test(one_hash_for_1_to_32_threads),
        cmocka_unit_test(one_hash_for_every_instruction_set),
        cmocka_unit_test(a_stream_gives_the_same_bits),
        cmocka_unit_test(a_plan_repeats_itself),
    };
    return cmocka_run_group_tests_name("sphere bits", tests, NULL, NULL);
}

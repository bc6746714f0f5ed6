// The same bits for every number of threads and every instruction set.
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_hash_for_1_to_32_threads),
        cmocka_unit_test(one_hash_for_every_instruction_set),
    };
    return cmocka_run_group_tests_name("sphere bits", tests, NULL, NULL);
}

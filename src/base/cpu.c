// What the processor can do, filled weakest first.
#include "base/base.h"
#include "base/context.h"

enum kiln_cpu ki_cpu_best(void)
{
    enum kiln_cpu best = KILN_CPU_SCALAR;
#if defined(KILN_HAVE_X86)
    __builtin_cpu_init();
    best = KILN_CPU_SSE2;
    if (__builtin_cpu_supports("avx2"))
        best = KILN_CPU_AVX2;
    if (best == KILN_CPU_AVX2 && __builtin_cpu_supports("avx512f") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw"))
        best = KILN_CPU_AVX512;
#elif defined(KILN_HAVE_SIMD128)
    best = KILN_CPU_SSE2;
#endif
    return best;
}

const char *ki_cpu_name(enum kiln_cpu cpu)
{
#if defined(KILN_HAVE_SIMD128)
    static const char *const names[] = {"best", "scalar", "simd128", "simd128", "simd128"};
#else
    static const char *const names[] = {"best", "scalar", "sse2", "avx2", "avx512"};
#endif
    return names[cpu];
}

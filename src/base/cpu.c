// Finds the best instruction set of the processor, and names instruction sets.
#include "base/base.h"
#include "base/context.h"

enum kiln_cpu ki_cpu_best(void)
{
    enum kiln_cpu best = KILN_CPU_SCALAR;
#if defined(KILN_HAVE_SIMD128)
    best = KILN_CPU_SSE2;
#endif
#if defined(KILN_HAVE_AVX)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2"))
        best = KILN_CPU_AVX2;
    if (best == KILN_CPU_AVX2 && __builtin_cpu_supports("avx512f") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw"))
        best = KILN_CPU_AVX512;
#endif
    return best;
}

#if defined(__wasm__)
#define SIMD128 "simd128"
#elif defined(__aarch64__)
#define SIMD128 "neon"
#else
#define SIMD128 "sse2"
#endif

const char *ki_cpu_name(enum kiln_cpu cpu)
{
    static const char *const names[] = {"best", "scalar", SIMD128, "avx2", "avx512"};
    return names[cpu];
}

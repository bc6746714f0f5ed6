// Which kernels: the weakest first, the last that fits wins.
#include "sphere/kernels.h"

#include "sphere/kernels_tables.h"

const ki_kernels *ki_sphere_kernels(const kiln_context *context)
{
    const ki_kernels *kernels = &ki_kernels_scalar;
#if defined(KILN_HAVE_X86)
    enum kiln_cpu cpu = ki_context_cpu(context);
    if (cpu >= KILN_CPU_SSE2)
        kernels = &ki_kernels_sse2;
    if (cpu >= KILN_CPU_AVX2)
        kernels = &ki_kernels_avx2;
    if (cpu >= KILN_CPU_AVX512)
        kernels = &ki_kernels_avx512;
#elif defined(KILN_HAVE_SIMD128)
    if (ki_context_cpu(context) >= KILN_CPU_SSE2)
        kernels = &ki_kernels_simd128;
#else
    (void)context;
#endif
    return kernels;
}

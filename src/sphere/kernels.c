// Chooses the kernels for the instruction set of a context.
#include "sphere/kernels.h"

#include "base/vector.h"
#include "sphere/kernels_tables.h"

const ki_kernels *ki_sphere_kernels(const kiln_context *context)
{
    return KI_FASTEST(context, &ki_kernels);
}

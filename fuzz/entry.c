// What libFuzzer calls: the target whose name is KILN_FUZZ_TARGET.
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const fuzz_target *target;
    target = target ? target : fuzz_find(KILN_FUZZ_TARGET);
    fuzz_run(target, data, size);
    return 0;
}

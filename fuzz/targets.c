#include "fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TARGET(name)                                                                               \
    {                                                                                              \
#name, fuzz_##name                                                                         \
    }

const fuzz_target fuzz_targets[] = {
    TARGET(exr),     TARGET(exr_chunk),  TARGET(hdr),   TARGET(png),        TARGET(png_rows),
    TARGET(deflate), TARGET(icc),        TARGET(jpeg),  TARGET(gain_map),   TARGET(ktx1),
    TARGET(ktx2),    TARGET(metadata),   TARGET(dds),   TARGET(env),        TARGET(glb),
    TARGET(json),    TARGET(harmonics),  TARGET(table), TARGET(table_text), TARGET(engine_text),
    TARGET(number),  TARGET(shown_text), TARGET(faces), TARGET(input),      {NULL, NULL}};

const fuzz_target *fuzz_find(const char *name)
{
    for (const fuzz_target *target = fuzz_targets; target->name; target++)
        if (!strcmp(target->name, name))
            return target;
    fprintf(stderr, "%s: there is no such fuzz target\n", name);
    exit(2);
}

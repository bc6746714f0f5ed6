#include "describe.h"

#include "codec/codec.h"

#include "context.h"

kiln_result describe(const void *bytes, size_t size, const char *name, kiln_file_info *info)
{
    uint8_t *exact = malloc(size ? size : 1);
    memcpy(exact, bytes, size);
    error.message[0] = 0;
    kiln_result result = ki_decode(context, exact, size, name, NULL, info, &error);
    free(exact);
    if (result != KILN_OK && !strstr(error.message, name))
        fail_msg("the sentence does not name the file %s: %s", name, error.message);
    return result;
}

// Any bytes, packed whole and in parts, come back as they were; any bytes as packed data do no
// harm.
#include "fuzz.h"

#include "codec/deflate.h"

#include <stdlib.h>
#include <string.h>

// The input is laid out several times, so that there are matches and more than one block.
static size_t repeat(const uint8_t *data, size_t size, uint8_t **plain)
{
    size_t times = 1 + data[0] % 64, total = times * size;
    *plain = malloc(total);
    fuzz_must(*plain != NULL);
    for (size_t i = 0; i < total; i++)
        (*plain)[i] = (uint8_t)(data[i % size] + (data[0] & 64 ? i / size : 0));
    return total;
}

static void there_and_back(ki_deflater *deflater, const uint8_t *plain, size_t size, size_t part)
{
    size_t room = ki_deflate_bound(part) * (size / part + 1), length = 0;
    uint8_t *packed = malloc(room), *back = malloc(size);
    fuzz_must(packed && back);
    for (size_t at = 0; at < size; at += part) {
        size_t count = size - at < part ? size - at : part;
        int place = (at ? 0 : KI_DEFLATE_FIRST) | (at + count == size ? KI_DEFLATE_LAST : 0);
        length += ki_deflate_part(deflater, plain + at, at, count, place, packed + length,
                                  ki_deflate_bound(count));
    }
    fuzz_must(ki_inflate_own(packed, length, back, size));
    fuzz_must(!memcmp(back, plain, size));
    if (part >= size) {
        fuzz_must(ki_deflate(deflater, plain, size, packed, length) == length);
        fuzz_must(ki_deflate(deflater, plain, size, packed, length - 1) == 0);
    }
    free(packed);
    free(back);
}

void fuzz_deflate(const uint8_t *data, size_t size)
{
    static uint8_t out[1 << 16];
    ki_inflate_own(data, size, out, sizeof out);
    ki_inflate_beginning(data, size, out, 1000);
    if (size < 2)
        return;
    kiln_context *context;
    if (kiln_context_create(&(kiln_context_def){.thread_count = 1}, &context, NULL) != KILN_OK)
        return;
    ki_deflater *deflater = ki_deflater_create(context);
    fuzz_must(deflater != NULL);
    uint8_t *plain;
    size_t total = repeat(data, size, &plain);
    there_and_back(deflater, plain, total, total);
    there_and_back(deflater, plain, total, 1 + total / (1 + data[1] % 8));
    free(plain);
    ki_deflater_free(deflater);
    kiln_context_destroy(context);
}

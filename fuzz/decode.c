// Any bytes into a decoder: it must return, within its memory, and leak nothing. The targets for
// one format put its first bytes in place, so that they get to it at once.
#include "codec/codec.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static size_t magic(uint8_t *bytes)
{
    static const struct {
        const char *format, *bytes;
        size_t size;
    } known[] = {{"exr", "\x76\x2f\x31\x01", 4},
                 {"hdr", "#?", 2},
                 {"png", "\x89PNG\r\n\x1a\n", 8},
                 {"ktx2", "\xabKTX 20\xbb\r\n\x1a\n", 12},
                 {"dds", "DDS ", 4}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (!strcmp(known[i].format, KILN_FUZZ_FORMAT)) {
            memcpy(bytes, known[i].bytes, known[i].size);
            return known[i].size;
        }
    return 0;
}

// The numbers that come out are finite and not negative.
static void check_values(const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!(values[i] >= 0 && values[i] <= 3.4028235e38F))
            abort();
}

// A table's may be negative.
static void check_finite(const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!(fabsf(values[i]) <= 3.4028235e38F))
            abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint8_t start[16];
    size_t start_size = magic(start);
    if (size < start_size)
        return 0;
    // A copy of exactly this size, so that a read past its end is seen.
    uint8_t *bytes = malloc(size ? size : 1);
    if (!bytes)
        return 0;
    if (size)
        memcpy(bytes, data, size);
    memcpy(bytes, start, start_size);

    const kiln_context_def def = {.memory_limit = (size_t)256 << 20, .thread_count = 1};
    kiln_context *context;
    if (kiln_context_create(&def, &context, NULL) != KILN_OK)
        abort();
    kiln_error error = {0};
    kiln_file_info info;
    ki_decoded decoded;
    kiln_result described = ki_decode(context, bytes, size, "fuzz", NULL, &info, &error);
    kiln_result result = ki_decode(context, bytes, size, "fuzz", &decoded, &info, &error);
    if (result == KILN_OK) {
        if (described != KILN_OK)
            abort();
        const kiln_image *image = &decoded.image;
        if (decoded.is_table)
            check_finite(image->pixels,
                         (size_t)image->width * (size_t)image->height * (size_t)image->channels);
        else if (!decoded.is_map)
            check_values(image->pixels, 3 * (size_t)image->width * (size_t)image->height);
        for (int k = 0; decoded.is_map && k < decoded.map.level_count; k++)
            check_values(decoded.map.level[k], 3 * kiln_map_texels(&decoded.map, k));
    } else if (!strstr(error.message, "fuzz") && result != KILN_ERROR_MEMORY) {
        abort(); // a sentence names the file
    }
    ki_decoded_free(&decoded);
    size_t held;
    kiln_context_memory(context, &held, NULL);
    if (held)
        abort();
    kiln_context_destroy(context);
    free(bytes);
    return 0;
}

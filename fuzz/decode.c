// Any bytes into a decoder: it must return, within its memory, and leak nothing. The targets for
// one format put its first bytes in place, so that they get to it at once.
#include "codec/codec.h"
#include "codec/deflate.h"
#include "image/mend.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void check_finite(const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!(fabsf(values[i]) <= 3.4028235e38F))
            abort();
}

// A table holds finite numbers, and so does a picture or a cube after mending, unless none of its
// texels was a number.
static void check_texels(kiln_context *context, ki_decoded *decoded)
{
    kiln_error error = {0};
    kiln_load_report report = {0};
    kiln_image *image = &decoded->image;
    kiln_map *map = &decoded->map;
    kiln_result result = KILN_OK;
    if (decoded->is_map)
        result = ki_map_mend(context, "fuzz", KILN_NEGATIVE_KEEP, map, &report, &error);
    else if (!decoded->is_table)
        result = ki_image_mend(context, "fuzz", image, &report, &error);
    if (result != KILN_OK && result != KILN_ERROR_FORMAT && result != KILN_ERROR_MEMORY)
        abort();
    for (int k = 0; result == KILN_OK && decoded->is_map && k < map->level_count; k++)
        check_finite(map->level[k], 3 * kiln_map_texels(map, k));
    if (result == KILN_OK && !decoded->is_map)
        check_finite(image->pixels,
                     (size_t)image->width * (size_t)image->height * (size_t)image->channels);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t room, unsigned seed);
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t room);

static uint32_t load_high_first(const uint8_t *bytes)
{
    uint32_t value;
    memcpy(&value, bytes, sizeof value);
    return __builtin_bswap32(value);
}

// Mostly gives a PNG's chunks their right sums, which random changes would never meet.
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t room, unsigned seed)
{
    static ki_crc32_table table;
    if (!table.sums[0][1])
        ki_crc32_fill(&table);
    size = LLVMFuzzerMutate(data, size, room);
    for (size_t at = 8; !strcmp(KILN_FUZZ_FORMAT, "png") && seed % 8 && at + 12 <= size;) {
        size_t count = load_high_first(data + at);
        if (count > size - at - 12)
            break;
        uint32_t sum = __builtin_bswap32(ki_crc32(&table, 0, data + at + 4, count + 4));
        memcpy(data + at + 8 + count, &sum, sizeof sum);
        at += 12 + count;
    }
    return size;
}

static size_t magic(uint8_t *bytes)
{
    static const struct {
        const char *format, *bytes;
        size_t size;
    } known[] = {{"exr", "\x76\x2f\x31\x01", 4},
                 {"hdr", "#?", 2},
                 {"png", "\x89PNG\r\n\x1a\n", 8},
                 {"jpeg", "\xff\xd8\xff", 3},
                 {"ktx2", "\xabKTX 20\xbb\r\n\x1a\n", 12},
                 {"dds", "DDS ", 4},
                 {"ktx1", "\xabKTX 11\xbb\r\n\x1a\n", 12},
                 {"env", "\x86\x16\x87\x96\xf6\xd6\x96\x36", 8},
                 {"glb", "glTF", 4}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (!strcmp(known[i].format, KILN_FUZZ_FORMAT)) {
            memcpy(bytes, known[i].bytes, known[i].size);
            return known[i].size;
        }
    return 0;
}

static void check_text(const char *text, size_t room)
{
    if (!memchr(text, 0, room))
        abort();
}

// What is said of a file ends, and its numbers are in range.
static void check_info(const kiln_file_info *info)
{
    check_text(info->format, sizeof info->format);
    check_text(info->encoding, sizeof info->encoding);
    check_text(info->layout, sizeof info->layout);
    check_text(info->engine, sizeof info->engine);
    check_text(info->writer, sizeof info->writer);
    check_text(info->orientation, sizeof info->orientation);
    check_text(info->table, sizeof info->table);
    for (int i = 0; i < info->layer_count && i < KILN_MAX_LAYERS; i++) {
        check_text(info->layer[i].part, sizeof info->layer[i].part);
        check_text(info->layer[i].name, sizeof info->layer[i].name);
        check_text(info->layer[i].channels, sizeof info->layer[i].channels);
    }
    if (info->level_count < 0 || info->level_count > KILN_MAX_LEVELS || info->sh_bands < 0 ||
        info->sh_bands > KILN_MAX_BANDS || !info->format[0] || !info->layout[0])
        abort();
    for (int k = 0; k < KILN_MAX_LEVELS; k++)
        if (info->roughness[k] != -1 && !(info->roughness[k] >= 0 && info->roughness[k] <= 1))
            abort();
    check_finite(info->sh[0], sizeof info->sh / sizeof(float));
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
    if (described == KILN_OK)
        check_info(&info);
    kiln_result result = ki_decode(context, bytes, size, "fuzz", &decoded, &info, &error);
    if (result == KILN_OK) {
        if (described != KILN_OK)
            abort();
        check_texels(context, &decoded);
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

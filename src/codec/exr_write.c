// Writing of EXR files. In: floats of one to four channels and the file's options. Out: a file of
// scan lines, half or float, compressed by ZIP in chunks of 16 lines.
#include "codec/codec.h"
#include "codec/deflate.h"
#include "image/pack.h"

#include <string.h>

enum { LINES = 16, ZIP = 3 };

static void text(ki_writer *w, const char *string)
{
    ki_write(w, string, strlen(string) + 1);
}

static void attribute(ki_writer *w, const char *name, const char *type, uint32_t size)
{
    text(w, name);
    text(w, type);
    ki_write_u32(w, size);
}

static void write_float(ki_writer *w, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    ki_write_u32(w, bits);
}

static void window(ki_writer *w, const char *name, int width, int height)
{
    attribute(w, name, "box2i", 16);
    ki_write_u32(w, 0);
    ki_write_u32(w, 0);
    ki_write_u32(w, (uint32_t)width - 1);
    ki_write_u32(w, (uint32_t)height - 1);
}

// Names of the channels in the file, which are in alphabetical order, and the index of each channel
// in a pixel.
static const char *const names[4][4] = {{"Y"}, {"G", "R"}, {"B", "G", "R"}, {"A", "B", "G", "R"}};
static const int places[4][4] = {{0}, {1, 0}, {2, 1, 0}, {3, 2, 1, 0}};

static void header(ki_writer *w, int width, int height, int channels, const ki_exr_options *options)
{
    ki_write_u32(w, 20000630); // magic number of EXR
    ki_write_u32(w, 2);        // version 2; one part, of scan lines
    uint32_t size = 1;
    for (int c = 0; c < channels; c++)
        size += (uint32_t)strlen(names[channels - 1][c]) + 17;
    attribute(w, "channels", "chlist", size);
    for (int c = 0; c < channels; c++) {
        text(w, names[channels - 1][c]);
        ki_write_u32(w, options->half ? 1 : 2);
        ki_write_u32(w, 0); // not "perceptually linear"
        ki_write_u32(w, 1); // no subsampling
        ki_write_u32(w, 1);
    }
    ki_write_u8(w, 0);
    attribute(w, "compression", "compression", 1);
    ki_write_u8(w, ZIP);
    window(w, "dataWindow", width, height);
    window(w, "displayWindow", width, height);
    if (options->panorama) {
        attribute(w, "envmap", "envmap", 1);
        ki_write_u8(w, 0);
    }
    if (options->engine) {
        attribute(w, "kilnEngine", "string", (uint32_t)strlen(options->engine));
        ki_write_text(w, "%s", options->engine);
    }
    if (options->roughness >= 0) {
        attribute(w, "kilnRoughness", "float", 4);
        write_float(w, options->roughness);
    }
    if (options->octahedron) {
        attribute(w, "kilnShape", "string", 10);
        ki_write_text(w, "octahedron");
    }
    if (options->table) {
        attribute(w, "kilnTable", "string", (uint32_t)strlen(options->table));
        ki_write_text(w, "%s", options->table);
    }
    attribute(w, "lineOrder", "lineOrder", 1);
    ki_write_u8(w, 0);
    attribute(w, "pixelAspectRatio", "float", 4);
    write_float(w, 1);
    attribute(w, "screenWindowCenter", "v2f", 8);
    write_float(w, 0);
    write_float(w, 0);
    attribute(w, "screenWindowWidth", "float", 4);
    write_float(w, 1);
    const char *version = kiln_version();
    attribute(w, "software", "string", (uint32_t)strlen(version) + 5);
    ki_write_text(w, "kiln %s", version);
}

// Reorders lines of pixels as the file stores them: in each line, channel by channel.
static void gather(const float *pixels, int width, int lines, int channels, bool half, float *plane,
                   uint8_t *raw)
{
    for (int y = 0; y < lines; y++) {
        const float *line = pixels + (size_t)y * (size_t)width * (size_t)channels;
        for (int c = 0; c < channels; c++) {
            const float *from = line + places[channels - 1][c];
            for (int x = 0; x < width; x++)
                plane[x] = from[(size_t)x * (size_t)channels];
            size_t bytes = (size_t)width * (half ? 2 : 4);
            if (half)
                ki_halfs_from_floats(plane, (size_t)width, (uint16_t *)(void *)raw);
            else
                memcpy(raw, plane, bytes);
            raw += bytes;
        }
    }
}

// Stores the even bytes first, then the odd bytes, and replaces each byte after the first by its
// difference from the byte before.
static void predict(const uint8_t *raw, size_t size, uint8_t *restrict bytes)
{
    size_t half = (size + 1) / 2;
    for (size_t i = 0; i < size / 2; i++) {
        bytes[i] = raw[2 * i];
        bytes[half + i] = raw[2 * i + 1];
    }
    if (size % 2)
        bytes[half - 1] = raw[size - 1];
    for (size_t i = size - 1; i > 0; i--)
        bytes[i] = (uint8_t)(bytes[i] - bytes[i - 1] + 128);
}

kiln_result ki_exr_encode(const float *pixels, int width, int height, int channels,
                          const ki_exr_options *options, ki_writer *writer, kiln_error *error)
{
    size_t line = (size_t)width * (size_t)channels * (options->half ? 2 : 4);
    size_t most = line * LINES, chunks = ((size_t)height + LINES - 1) / LINES;
    size_t file_start = writer->size;
    kiln_result result = KILN_OK;
    ki_deflater *deflater = ki_deflater_create(writer->context);
    uint8_t *raw = ki_alloc_raw(writer->context, most, 3);
    float *plane = ki_alloc_raw(writer->context, (size_t)width, sizeof(float));
    if (!deflater || !raw || !plane)
        goto done;
    header(writer, width, height, channels, options);
    ki_write_u8(writer, 0);
    size_t table = writer->size;
    if (ki_write_room(writer, 8 * chunks))
        memset(writer->bytes + table, 0, 8 * chunks);
    for (size_t i = 0; i < chunks && !writer->failed; i++) {
        if (!ki_go_on(writer->context)) {
            result = ki_fail_cancelled(error, "writing");
            break;
        }
        int y = (int)(i * LINES), lines = ki_min(LINES, height - y);
        size_t size = line * (size_t)lines;
        gather(pixels + (size_t)y * (size_t)width * (size_t)channels, width, lines, channels,
               options->half, plane, raw);
        predict(raw, size, raw + most);
        // The room is less than `size`, because a chunk that does not become smaller is stored
        // uncompressed.
        size_t packed = ki_deflate(deflater, raw + most, size, raw + 2 * most, size - 1);
        ki_patch_u64(writer, table + 8 * i, writer->size - file_start);
        ki_write_u32(writer, (uint32_t)y);
        ki_write_u32(writer, (uint32_t)(packed ? packed : size));
        ki_write(writer, packed ? raw + 2 * most : raw, packed ? packed : size);
    }
done:
    if (!deflater || !raw || !plane || writer->failed)
        result = ki_fail_memory(writer->context, error, "an EXR file", 3 * most + writer->size);
    ki_deflater_free(deflater);
    ki_free(raw);
    ki_free(plane);
    return result;
}

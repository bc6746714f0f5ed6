// Writing of EXR files. In: floats of one to four channels and the file's options. Out: a file of
// scan lines, half or float, compressed by ZIP in chunks of 16 lines. The context's threads
// compress several chunks at once. A chunk is compressed without regard to the others, and the
// chunks are written in their order, which makes the file the same for any number of threads.
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

// For 1 to 4 channels: the names of the channels, in the alphabetical order that the file requires,
// and the index of each of these channels in a pixel.
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
        ki_write_u32(w, 0); // the channel is marked as not "perceptually linear"
        ki_write_u32(w, 1); // the channel is not subsampled: 1 in x, and 1 in y
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
    ki_write_u8(w, 0); // a NUL instead of an attribute's name ends the header
}

// Reorders the pixels of a chunk's lines as the file stores them: in each line, all values of one
// channel, then all values of the next. `plane` has room for one channel of a line.
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

// Prepares a chunk's bytes for deflate, as EXR's method ZIP does: stores the even bytes first, then
// the odd bytes, and replaces each byte after the first by its difference from the byte before,
// plus 128.
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

// Memory in which one chunk is compressed, and the chunk as the file stores it.
typedef struct lane {
    ki_deflater *deflater;
    float *plane;                  // room for one channel of a line
    uint8_t *raw, *sorted, *other; // the chunk's bytes by gather(), by predict(), and compressed
    // the `size` bytes that the file stores: compressed, or uncompressed where that is shorter
    const uint8_t *bytes;
    size_t size;
} lane;

// The state of writing. Chunks are compressed in batches: as many at once as there are lanes.
typedef struct packer {
    const float *pixels;
    int width, height, channels;
    bool half;
    size_t line, most; // number of bytes of a line of pixels, and of a chunk of LINES lines
    size_t chunks;
    lane *lanes;
    int count;    // number of lanes: chunks that are compressed at once
    size_t first; // index of the chunk in the first lane
} packer;

static void free_lanes(packer *p)
{
    for (int i = 0; p->lanes && i < p->count; i++) {
        ki_deflater_free(p->lanes[i].deflater);
        ki_free(p->lanes[i].plane);
        ki_free(p->lanes[i].raw);
    }
    ki_free(p->lanes);
    p->lanes = NULL;
}

static bool make_lanes(kiln_context *context, packer *p, int count)
{
    p->count = count;
    p->lanes = ki_alloc(context, (size_t)count, sizeof *p->lanes);
    bool complete = p->lanes;
    for (int i = 0; complete && i < count; i++) {
        lane *l = &p->lanes[i];
        l->deflater = ki_deflater_create(context);
        l->plane = ki_alloc_raw(context, (size_t)p->width, sizeof(float));
        l->raw = ki_alloc_raw(context, p->most, 3);
        complete = l->deflater && l->plane && l->raw;
        l->sorted = complete ? l->raw + p->most : NULL;
        l->other = complete ? l->raw + 2 * p->most : NULL;
    }
    if (!complete)
        free_lanes(p);
    return complete;
}

// Returns the number of lanes, each with memory for one chunk, to try first: two for each thread,
// so that a thread whose chunk is done early takes a second chunk.
static int most_lanes(kiln_context *context, size_t chunks)
{
    int threads = ki_context_threads(context), count = threads > 1 ? 2 * threads : 1;
    return chunks < (size_t)count ? (int)chunks : count;
}

static void pack_chunk(void *data, int index)
{
    const packer *p = data;
    lane *l = &p->lanes[index];
    int y = (int)(p->first + (size_t)index) * LINES, lines = ki_min(LINES, p->height - y);
    size_t size = p->line * (size_t)lines;
    gather(p->pixels + (size_t)y * (size_t)p->width * (size_t)p->channels, p->width, lines,
           p->channels, p->half, l->plane, l->raw);
    predict(l->raw, size, l->sorted);
    // The room for the compressed chunk is one byte less than `size`, because a chunk that
    // compression does not make smaller is stored uncompressed.
    size_t packed = ki_deflate(l->deflater, l->sorted, size, l->other, size - 1);
    l->bytes = packed ? l->other : l->raw;
    l->size = packed ? packed : size;
}

// Writes the table of the chunks' positions, and then the chunks in their order.
static kiln_result write_chunks(packer *p, size_t file_start, ki_writer *w)
{
    size_t table = w->size;
    if (ki_write_room(w, 8 * p->chunks))
        memset(w->bytes + table, 0, 8 * p->chunks);
    for (p->first = 0; p->first < p->chunks && !w->failed; p->first += (size_t)p->count) {
        if (!ki_go_on(w->context))
            return KILN_ERROR_CANCELLED;
        size_t left = p->chunks - p->first;
        int count = left < (size_t)p->count ? (int)left : p->count;
        ki_parallel_for(w->context, count, pack_chunk, p);
        for (int i = 0; i < count; i++) {
            size_t chunk = p->first + (size_t)i;
            ki_patch_u64(w, table + 8 * chunk, w->size - file_start);
            ki_write_u32(w, (uint32_t)chunk * LINES);
            ki_write_u32(w, (uint32_t)p->lanes[i].size);
            ki_write(w, p->lanes[i].bytes, p->lanes[i].size);
        }
    }
    return w->failed ? KILN_ERROR_MEMORY : KILN_OK;
}

// Appends an EXR file, whose chunks are compressed `lanes` at a time, or nothing on failure. Writes
// no error message.
static kiln_result write_by(packer *p, int lanes, const ki_exr_options *options, ki_writer *w)
{
    size_t start = w->size;
    kiln_result result = KILN_ERROR_MEMORY;
    if (make_lanes(w->context, p, lanes)) {
        header(w, p->width, p->height, p->channels, options);
        result = write_chunks(p, start, w);
    }
    free_lanes(p);
    if (result != KILN_OK)
        w->size = start;
    return result;
}

kiln_result ki_exr_encode(const float *pixels, int width, int height, int channels,
                          const ki_exr_options *options, ki_writer *writer, kiln_error *error)
{
    size_t line = (size_t)width * (size_t)channels * (options->half ? 2 : 4);
    packer p = {.pixels = pixels,
                .width = width,
                .height = height,
                .channels = channels,
                .half = options->half,
                .line = line,
                .most = line * LINES,
                .chunks = ((size_t)height + LINES - 1) / LINES};
    int lanes = most_lanes(writer->context, p.chunks);
    if (writer->failed)
        lanes = 0; // an earlier write has failed, so that nothing is written
    kiln_result result = lanes ? write_by(&p, lanes, options, writer) : KILN_ERROR_MEMORY;
    // If memory is too short for the file and `lanes` chunks at once, the file is begun again with
    // fewer lanes.
    for (; result == KILN_ERROR_MEMORY && lanes > 1;
         result = write_by(&p, lanes, options, writer)) {
        lanes /= 2;
        writer->failed = false;
    }
    if (result == KILN_ERROR_CANCELLED)
        return ki_fail_cancelled(error, "writing");
    if (result == KILN_ERROR_MEMORY)
        return ki_fail_memory(writer->context, error, "an EXR file", 3 * p.most + writer->size);
    return KILN_OK;
}

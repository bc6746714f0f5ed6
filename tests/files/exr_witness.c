#include "exr_witness.h"

#include "exr_make.h"
#include "image/pack.h"
#include "kit/check.h"

#include <openexr.h>

typedef struct memory {
    const uint8_t *bytes;
    size_t size;
} memory;

static int64_t read_memory(exr_const_context_t file, void *data, void *buffer, uint64_t size,
                           uint64_t offset, exr_stream_error_func_ptr_t fail)
{
    (void)file;
    (void)fail;
    const memory *m = data;
    if (offset >= m->size)
        return 0;
    uint64_t left = m->size - offset, count = left < size ? left : size;
    memcpy(buffer, m->bytes + offset, (size_t)count);
    return (int64_t)count;
}

static int64_t memory_size(exr_const_context_t file, void *data)
{
    (void)file;
    return (int64_t)((const memory *)data)->size;
}

static void say_nothing(exr_const_context_t file, exr_result_t code, const char *message)
{
    (void)file;
    (void)code;
    (void)message;
}

// A chunk whose first pixel is (x, y) of the data window, and the picture it goes to.
typedef struct target {
    exr_const_context_t file;
    int part, width, height;
    float *pixels;
} target;

// Where the samples of a channel go: a plane of floats, or of integers for a channel of these; NULL
// for a channel other than R, G and B.
static float *ask_for_plane(exr_coding_channel_info_t *channel, const exr_chunk_info_t *info)
{
    if (channel->channel_name[1] || !strchr("RGB", channel->channel_name[0]))
        return NULL;
    float *plane = calloc((size_t)info->width * (size_t)info->height, sizeof(float));
    assert_non_null(plane);
    channel->decode_to_ptr = (uint8_t *)plane;
    channel->user_bytes_per_element = 4;
    channel->user_data_type =
        channel->data_type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
    channel->user_pixel_stride = 4;
    channel->user_line_stride = 4 * info->width;
    return plane;
}

// Writes the plane's values into the picture at (x, y).
static void take_plane(const target *t, const exr_coding_channel_info_t *channel,
                       const exr_chunk_info_t *info, const float *plane, int x, int y)
{
    ptrdiff_t place = strchr("RGB", channel->channel_name[0]) - "RGB";
    for (int i = 0; i < info->width * info->height; i++) {
        float value = plane[i];
        uint32_t integer;
        memcpy(&integer, &value, sizeof integer);
        if (channel->data_type == EXR_PIXEL_UINT)
            value = (float)integer;
        t->pixels[3 * ((y + i / info->width) * t->width + x + i % info->width) + place] = value;
    }
}

// Prepares to decode a chunk as if it began at a line that OpenEXRCore counts from without error,
// and with the size that its channels then have.
static bool begin(const target *t, const exr_chunk_info_t *at, exr_decode_pipeline_t *pipeline)
{
    exr_chunk_info_t info = *at;
    info.start_y = exr_make_safe_line(at->start_y);
    if (exr_decoding_initialize(t->file, t->part, &info, pipeline) != EXR_ERR_SUCCESS)
        return false;
    pipeline->chunk.unpacked_size = 0;
    for (int c = 0; c < pipeline->channel_count; c++) {
        const exr_coding_channel_info_t *channel = &pipeline->channels[c];
        pipeline->chunk.unpacked_size += (uint64_t)channel->width * (uint64_t)channel->height *
                                         (uint64_t)channel->bytes_per_element;
    }
    return true;
}

static bool read_chunk(const target *t, const exr_chunk_info_t *info, int x, int y)
{
    enum { MOST = 8 }; // channels of a file of the tests
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    float *planes[MOST] = {NULL};
    bool good = begin(t, info, &pipeline) && pipeline.channel_count <= MOST;
    for (int c = 0; good && c < pipeline.channel_count; c++)
        planes[c] = ask_for_plane(&pipeline.channels[c], info);
    good = good &&
           exr_decoding_choose_default_routines(t->file, t->part, &pipeline) == EXR_ERR_SUCCESS &&
           exr_decoding_run(t->file, t->part, &pipeline) == EXR_ERR_SUCCESS;
    for (int c = 0; good && c < pipeline.channel_count; c++)
        if (planes[c])
            take_plane(t, &pipeline.channels[c], info, planes[c], x, y);
    exr_decoding_destroy(t->file, &pipeline);
    for (int c = 0; c < MOST; c++)
        free(planes[c]);
    return good;
}

static bool read_tiles(const target *t)
{
    int32_t width, height;
    exr_chunk_info_t info;
    if (exr_get_tile_sizes(t->file, t->part, 0, 0, &width, &height) != EXR_ERR_SUCCESS)
        return false;
    for (int y = 0; y < t->height; y += height)
        for (int x = 0; x < t->width; x += width)
            if (exr_read_tile_chunk_info(t->file, t->part, x / width, y / height, 0, 0, &info) !=
                    EXR_ERR_SUCCESS ||
                !read_chunk(t, &info, x, y))
                return false;
    return true;
}

static bool read_lines(const target *t, int top)
{
    int32_t lines;
    exr_chunk_info_t info;
    if (exr_get_scanlines_per_chunk(t->file, t->part, &lines) != EXR_ERR_SUCCESS)
        return false;
    for (int y = 0; y < t->height; y += lines)
        if (exr_read_scanline_chunk_info(t->file, t->part, top + y, &info) != EXR_ERR_SUCCESS ||
            !read_chunk(t, &info, 0, y))
            return false;
    return true;
}

bool exr_witness_read(const uint8_t *bytes, size_t size, int *width, int *height, float **pixels)
{
    memory m = {bytes, size};
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = say_nothing;
    init.user_data = &m;
    init.read_fn = read_memory;
    init.size_fn = memory_size;
    init.flags =
        EXR_CONTEXT_FLAG_SILENT_HEADER_PARSE | EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    exr_context_t file;
    *pixels = NULL;
    if (exr_start_read(&file, "memory", &init) != EXR_ERR_SUCCESS)
        return false;
    int part_count = 0;
    exr_attr_box2i_t data;
    exr_storage_t storage;
    bool good = exr_get_count(file, &part_count) == EXR_ERR_SUCCESS;
    target t = {.file = file, .part = part_count - 1};
    good = good && exr_get_data_window(file, t.part, &data) == EXR_ERR_SUCCESS &&
           exr_get_storage(file, t.part, &storage) == EXR_ERR_SUCCESS;
    if (good) {
        *width = t.width = data.max.x - data.min.x + 1;
        *height = t.height = data.max.y - data.min.y + 1;
        *pixels = t.pixels = calloc((size_t)t.width * (size_t)t.height * 3, sizeof(float));
        assert_non_null(t.pixels);
        good = storage == EXR_STORAGE_TILED ? read_tiles(&t) : read_lines(&t, data.min.y);
    }
    exr_finish(&file);
    return good;
}

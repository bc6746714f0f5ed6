#include "exr_make.h"

#include "image/pack.h"
#include "kit/check.h"

typedef struct stream {
    uint8_t *bytes;
    size_t size, room;
} stream;

static int64_t write_stream(exr_const_context_t context, void *data, const void *bytes,
                            uint64_t size, uint64_t offset, exr_stream_error_func_ptr_t error)
{
    (void)context;
    (void)error;
    stream *s = data;
    if (offset + size > s->room) {
        s->room = 2 * (size_t)(offset + size);
        s->bytes = realloc(s->bytes, s->room);
        assert_non_null(s->bytes);
    }
    if (offset + size > s->size)
        s->size = offset + size;
    memcpy(s->bytes + offset, bytes, size);
    return (int64_t)size;
}

static void must(exr_result_t result)
{
    if (result != EXR_ERR_SUCCESS)
        fail_msg("OpenEXRCore: %s", exr_get_default_error_message(result));
}

// One sample as it is stored in a channel of `type`.
static void store_sample(uint8_t *to, float value, int type)
{
    uint16_t half = ki_half_from_float(value);
    if (isinf(value)) // ki_half_from_float clamps infinities
        half = value > 0 ? 0x7c00 : 0xfc00;
    if (isnan(value))
        half = 0x7e00;
    uint32_t integer = value > 0 ? (uint32_t)value : 0;
    if (type == EXR_PIXEL_HALF)
        memcpy(to, &half, sizeof half);
    else if (type == EXR_PIXEL_FLOAT)
        memcpy(to, &value, sizeof value);
    else
        memcpy(to, &integer, sizeof integer);
}

// The samples of one channel in the box of `info` at x0, y0: line after line, in newly allocated
// memory, which the channel is then encoded from.
static uint8_t *fill_plane(exr_coding_channel_info_t *channel, const exr_make *make,
                           const exr_chunk_info_t *info, int x0, int y0)
{
    size_t bytes = (size_t)channel->bytes_per_element;
    uint8_t *plane = calloc((size_t)info->width * (size_t)info->height, bytes);
    assert_non_null(plane);
    uint8_t *at = plane;
    int lines = 0;
    for (int y = y0; y < y0 + info->height; y++) {
        if (y % channel->y_samples)
            continue;
        lines++;
        for (int x = x0; x < x0 + info->width; x++) {
            if (x % channel->x_samples)
                continue;
            bool lower = make->level > 0; // a level that readers leave out
            float value = make->value(lower ? 0 : x, lower ? 0 : y, channel->channel_name);
            store_sample(at, value, channel->data_type);
            at += bytes;
        }
    }
    // The encoder's buffers have as many lines as the library has counted.
    assert_int_equal(channel->height, lines);
    channel->encode_from_ptr = plane;
    channel->user_bytes_per_element = (int16_t)bytes;
    channel->user_data_type = channel->data_type;
    channel->user_pixel_stride = (int32_t)bytes;
    channel->user_line_stride = (int32_t)bytes * channel->width;
    return plane;
}

// Puts a chunk into the file that was compressed as if it began elsewhere.
static exr_result_t write_packed(exr_context_t file, int part, const exr_make *make,
                                 const exr_encode_pipeline_t *packed, int x0, int y0)
{
    const void *bytes = packed->compressed_buffer;
    uint64_t size = packed->compressed_bytes;
    if (!make->tile_width)
        return exr_write_scanline_chunk(file, part, y0, bytes, size);
    return exr_write_tile_chunk(file, part, (x0 - make->x) / make->tile_width,
                                (y0 - make->y) / make->tile_height, make->level, make->level, bytes,
                                size);
}

int exr_make_safe_line(int y)
{
    enum { PERIOD = 1 << 10 }; // a multiple of every sampling that the tests use
    return y < 0 ? y + PERIOD * ((-y + PERIOD - 1) / PERIOD) : y;
}

// One chunk from the samples of each channel, planar, as the type they are stored in. It is packed
// as if it began at exr_make_safe_line(y0).
static void write_chunk(exr_context_t file, int part, const exr_make *make,
                        const exr_chunk_info_t *at, int x0, int y0)
{
    exr_chunk_info_t info = *at;
    info.start_y = exr_make_safe_line(info.start_y);
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    must(exr_encoding_initialize(file, part, &info, &pipeline));
    uint8_t *planes[8] = {NULL};
    for (int c = 0; c < pipeline.channel_count; c++)
        planes[c] = fill_plane(&pipeline.channels[c], make, &info, x0, y0);
    must(exr_encoding_choose_default_routines(file, part, &pipeline));
    pipeline.yield_until_ready_fn = NULL; // which looks for the chunk where the file has none
    pipeline.write_fn = NULL;
    must(exr_encoding_run(file, part, &pipeline));
    must(write_packed(file, part, make, &pipeline, x0, y0));
    must(exr_encoding_destroy(file, &pipeline));
    for (int c = 0; c < 8; c++)
        free(planes[c]);
}

static void add_part(exr_context_t file, int part, int count, const exr_make *make)
{
    static const exr_make_channel depth = {"Z", EXR_PIXEL_FLOAT, 0, false};
    bool last = part == count - 1;
    char name[16];
    snprintf(name, sizeof name, "part%d", part);
    int index;
    must(exr_add_part(file, name, make->tile_width ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE,
                      &index));
    exr_attr_box2i_t data = {{{{make->x, make->y}}},
                             {{{make->x + make->width - 1, make->y + make->height - 1}}}};
    exr_attr_box2i_t display = make->display;
    if (!display.max.x && !display.max.y)
        display = data;
    exr_attr_v2f_t center = {{{0, 0}}};
    must(exr_initialize_required_attr(file, part, &display, &data, 1, &center, 1, make->order,
                                      make->compression));
    for (int c = 0; c < (last ? make->channel_count : 1); c++) {
        const exr_make_channel *channel = last ? &make->channels[c] : &depth;
        int sampling = channel->sampling ? channel->sampling : 1;
        must(exr_add_channel(file, part, channel->name, channel->type,
                             channel->linear ? EXR_PERCEPTUALLY_LINEAR
                                             : EXR_PERCEPTUALLY_LOGARITHMIC,
                             sampling, sampling));
    }
    if (make->tile_width)
        must(exr_set_tile_descriptor(
            file, part, (uint32_t)make->tile_width, (uint32_t)make->tile_height,
            make->mip_levels ? EXR_TILE_MIPMAP_LEVELS : EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN));
}

static void write_tiles(exr_context_t file, int part, const exr_make *make, int level)
{
    int32_t width, height;
    must(exr_get_level_sizes(file, part, level, level, &width, &height));
    int across = (width + make->tile_width - 1) / make->tile_width;
    int down = (height + make->tile_height - 1) / make->tile_height;
    exr_make one = *make;
    one.level = level;
    for (int k = 0; k < across * down; k++) {
        int x = k % across, y = k / across;
        exr_chunk_info_t info;
        must(exr_write_tile_chunk_info(file, part, x, y, level, level, &info));
        int at_x = make->x + x * make->tile_width, at_y = make->y + y * make->tile_height;
        write_chunk(file, part, &one, &info, at_x, at_y);
    }
}

static void write_lines(exr_context_t file, int part, const exr_make *make)
{
    int lines = 1;
    must(exr_get_scanlines_per_chunk(file, part, &lines));
    for (int y = make->y; y < make->y + make->height; y += lines) {
        exr_chunk_info_t info;
        must(exr_write_scanline_chunk_info(file, part, y, &info));
        write_chunk(file, part, make, &info, make->x, y);
    }
}

static uint64_t offset_at(const uint8_t *table, size_t index)
{
    uint64_t offset;
    memcpy(&offset, table + 8 * index, sizeof offset);
    return offset;
}

// Puts the chunks, which follow the table of their offsets, into the opposite order: OpenEXRCore
// writes in increasing order only.
static void reverse_chunks(stream *s, size_t count, exr_lineorder_t order)
{
    static const char name[] = "lineOrder\0lineOrder\0\1\0\0";
    for (size_t i = 0; i + sizeof name < s->size; i++)
        if (!memcmp(s->bytes + i, name, sizeof name))
            s->bytes[i + sizeof name] = (uint8_t)order;
    uint8_t *old = malloc(s->size);
    assert_non_null(old);
    memcpy(old, s->bytes, s->size);
    // Chunks were written in the order of the tables; the first one begins where these end.
    size_t table = 0;
    while (offset_at(old + table, 0) != table + 8 * count)
        table++;
    uint64_t to = table + 8 * count;
    for (size_t i = count; i-- > 0;) {
        uint64_t from = offset_at(old + table, i);
        uint64_t end = i + 1 < count ? offset_at(old + table, i + 1) : s->size;
        memcpy(s->bytes + to, old + from, end - from);
        memcpy(s->bytes + table + 8 * i, &to, sizeof to);
        to += end - from;
    }
    free(old);
}

uint8_t *exr_make_file(const exr_make *make, size_t *size)
{
    stream s = {0};
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.user_data = &s;
    init.write_fn = write_stream;
    exr_context_t file;
    must(exr_start_write(&file, "memory", EXR_WRITE_FILE_DIRECTLY, &init));
    int parts = make->part_count ? make->part_count : 1;
    for (int part = 0; part < parts; part++)
        add_part(file, part, parts, make);
    must(exr_write_header(file));
    size_t chunk_count = 0;
    for (int part = 0; part < parts; part++) {
        int levels = 1, chunks;
        must(exr_get_chunk_count(file, part, &chunks));
        chunk_count += (size_t)chunks;
        if (make->tile_width)
            must(exr_get_tile_levels(file, part, &levels, NULL));
        for (int level = 0; level < levels && make->tile_width; level++)
            write_tiles(file, part, make, level);
        if (!make->tile_width)
            write_lines(file, part, make);
    }
    must(exr_finish(&file));
    if (make->order != EXR_LINEORDER_INCREASING_Y)
        reverse_chunks(&s, chunk_count, make->order);
    *size = s.size;
    return s.bytes;
}

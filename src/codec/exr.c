// EXR files. OpenEXRCore reads the header and undoes PIZ, PXR24 and B44 (without it exr_header.c and
// exr_other.c do); the other compressions are undone here, faster, and DWA because that library does
// not know it. Chunks are unpacked in
// parallel, straight into the picture.
//
// The picture is the display window; what the data window does not cover is 0. The first part with
// colour is read, level 0 where there are several, and of its channels R, G and B (without a layer's
// name before those with one), or Y as grey. The attribute "chromaticities" is not applied.
#include "codec/exr.h"
#include "codec/codec.h"
#include "image/pack.h"

#include <stdio.h>
#include <string.h>

typedef struct exr_chunk {
    ki_exr_box box;
    const uint8_t *packed;
    size_t packed_size, size;
    exr_chunk_info_t info;
} exr_chunk;

typedef struct exr_file {
    kiln_context *context;
    const uint8_t *bytes;
    size_t size;
    const char *name;
    exr_context_t core;
    int part;
    bool tiled;
    exr_compression_t compression;
    exr_attr_box2i_t data, display;
    int width, height; // of the display window
    ki_exr_channel channels[KI_EXR_MAX_CHANNELS];
    int channel_count;
    int wanted[3]; // channels that become red, green and blue; -1 for none
    exr_chunk *chunks;
    int chunk_count;
    uint16_t *dwa_table;
    float *pixels;
    uint8_t *results; // kiln_result of each task
    int *damaged;     // the chunk at which a task stopped
    int task_count, first_task;
} exr_file;

// ----------------------------------------------------------------------------------------- samples

static int floor_divide(int a, int b)
{
    return a >= 0 ? a / b : -((-a + b - 1) / b);
}

int ki_exr_samples(int start, int count, int sampling)
{
    if (sampling == 1)
        return count;
    return floor_divide(start + count - 1, sampling) - floor_divide(start - 1, sampling);
}

bool ki_exr_line_has(const ki_exr_channel *channel, int y)
{
    return y % channel->y_sampling == 0;
}

size_t ki_exr_box_size(const ki_exr_box *box)
{
    size_t size = 0;
    for (int c = 0; c < box->channel_count; c++) {
        const ki_exr_channel *channel = &box->channels[c];
        size_t across = (size_t)ki_exr_samples(box->x, box->width, channel->x_sampling);
        size_t down = (size_t)ki_exr_samples(box->y, box->height, channel->y_sampling);
        size_t bytes;
        if (!ki_mul_size(across, down, &bytes) ||
            !ki_mul_size(bytes, (size_t)channel->bytes, &bytes) || size > SIZE_MAX - bytes)
            return 0;
        size += bytes;
    }
    return size;
}

enum { STRETCH = 256 };

// Samples of one channel as floats: not-a-number and negatives become 0, infinities the largest
// finite value of the type.
static void to_floats(const uint8_t *restrict samples, int type, int count, float *restrict values)
{
    if (type == EXR_PIXEL_HALF) {
        uint16_t halfs[STRETCH];
        for (int i = 0; i < count; i++) {
            uint16_t half;
            memcpy(&half, samples + 2 * (size_t)i, 2);
            int32_t h = half > 0x7c00 ? 0 : half;
            halfs[i] = (uint16_t)(h < 0x7bff ? h : 0x7bff);
        }
        ki_floats_from_halfs(halfs, (size_t)count, values);
    } else if (type == EXR_PIXEL_FLOAT) {
        for (int i = 0; i < count; i++) {
            int32_t bits;
            memcpy(&bits, samples + 4 * (size_t)i, 4);
            bits = bits > 0x7f800000 ? 0 : bits;
            bits = bits > 0 ? bits : 0;
            bits = bits < 0x7f7fffff ? bits : 0x7f7fffff;
            memcpy(&values[i], &bits, 4);
        }
    } else {
        for (int i = 0; i < count; i++) {
            uint32_t integer;
            memcpy(&integer, samples + 4 * (size_t)i, 4);
            values[i] = (float)integer;
        }
    }
}

typedef float float4 __attribute__((vector_size(16)));

// Three channels to RGB, four texels at a time.
static void interleave(const float *restrict r, const float *restrict g, const float *restrict b,
                       int count, float *restrict rgb)
{
    int i = 0;
    for (; i + 4 <= count; i += 4) {
        float4 red, green, blue, out[3];
        memcpy(&red, r + i, sizeof red);
        memcpy(&green, g + i, sizeof green);
        memcpy(&blue, b + i, sizeof blue);
        float4 low = __builtin_shufflevector(red, green, 0, 4, 1, 5);
        float4 high = __builtin_shufflevector(red, green, 2, 6, 3, 7);
        float4 one = __builtin_shufflevector(low, blue, 2, 3, 5, -1);
        out[0] = __builtin_shufflevector(low, blue, 0, 1, 4, 2);
        out[1] = __builtin_shufflevector(one, high, 1, 2, 4, 5);
        out[2] = __builtin_shufflevector(blue, high, 2, 6, 7, 3);
        memcpy(rgb + 3 * (size_t)i, out, sizeof out);
    }
    for (; i < count; i++) {
        float *texel = rgb + 3 * (size_t)i;
        texel[0] = r[i];
        texel[1] = g[i];
        texel[2] = b[i];
    }
}

// One line of three channels, NULL where missing, to RGB.
static void put_line(const uint8_t *const samples[3], const ki_exr_channel *const channel[3],
                     int count, float *rgb)
{
    float values[3][STRETCH];
    for (int c = 0; c < 3; c++)
        if (!samples[c])
            memset(values[c], 0, sizeof values[c]);
    for (int x = 0; x < count; x += STRETCH) {
        int n = ki_min(STRETCH, count - x);
        for (int c = 0; c < 3; c++)
            if (samples[c])
                to_floats(samples[c] + (size_t)x * (size_t)channel[c]->bytes, channel[c]->type, n,
                          values[c]);
        interleave(values[0], values[1], values[2], n, rgb + 3 * (size_t)x);
    }
}

static void unpack(const exr_file *f, const ki_exr_box *box, const uint8_t *raw)
{
    int left = ki_max(box->x, f->display.min.x);
    int right = ki_min(box->x + box->width, f->display.min.x + f->width);
    for (int y = box->y; y < box->y + box->height; y++) {
        const uint8_t *start[KI_EXR_MAX_CHANNELS];
        for (int c = 0; c < f->channel_count; c++) {
            const ki_exr_channel *channel = &f->channels[c];
            start[c] = raw;
            if (ki_exr_line_has(channel, y))
                raw += (size_t)ki_exr_samples(box->x, box->width, channel->x_sampling) *
                       (size_t)channel->bytes;
        }
        int row = y - f->display.min.y;
        if (row < 0 || row >= f->height || left >= right)
            continue;
        const uint8_t *samples[3] = {NULL};
        const ki_exr_channel *channel[3] = {NULL};
        for (int k = 0; k < 3; k++) {
            if (f->wanted[k] < 0)
                continue;
            channel[k] = &f->channels[f->wanted[k]];
            samples[k] = start[f->wanted[k]] + (size_t)(left - box->x) * (size_t)channel[k]->bytes;
        }
        put_line(samples, channel, right - left,
                 f->pixels +
                     3 * ((size_t)row * (size_t)f->width + (size_t)(left - f->display.min.x)));
    }
}

// ------------------------------------------------------------------------------------------ chunks

static kiln_result decode_chunk(const exr_file *f, const exr_chunk *chunk, uint8_t *raw,
                                uint8_t *scratch)
{
    bool good = false;
    const uint8_t *packed = chunk->packed;
    size_t packed_size = chunk->packed_size;
    if (packed_size == chunk->size) { // what does not become smaller is stored as it is
        unpack(f, &chunk->box, packed);
        return KILN_OK;
    }
    switch (f->compression) {
    case EXR_COMPRESSION_RLE:
        good = ki_exr_undo_rle(packed, packed_size, raw, chunk->size, scratch);
        break;
    case EXR_COMPRESSION_ZIPS:
    case EXR_COMPRESSION_ZIP:
        good = ki_exr_undo_zip(packed, packed_size, raw, chunk->size, scratch);
        break;
    case EXR_COMPRESSION_DWAA:
    case EXR_COMPRESSION_DWAB: {
        kiln_result result =
            ki_exr_undo_dwa(f->context, &chunk->box, f->dwa_table, packed, packed_size, raw);
        if (result != KILN_OK)
            return result;
        good = true;
        break;
    }
    case EXR_COMPRESSION_PIZ:
    case EXR_COMPRESSION_PXR24:
    case EXR_COMPRESSION_B44:
    case EXR_COMPRESSION_B44A:
        good = ki_exr_undo_other(f->context, f->core, f->part, &chunk->info, &chunk->box,
                                 (int)f->compression, packed, packed_size, raw, chunk->size);
        break;
    case EXR_COMPRESSION_NONE:
    case EXR_COMPRESSION_LAST_TYPE:
        break;
    }
    if (!good)
        return KILN_ERROR_FORMAT;
    unpack(f, &chunk->box, raw);
    return KILN_OK;
}

// A task takes neighbouring chunks, so that it needs its buffers once.
static void decode_chunks(void *data, int index)
{
    exr_file *f = data;
    int task = f->first_task + index;
    int begin = (int)((int64_t)f->chunk_count * task / f->task_count);
    int end = (int)((int64_t)f->chunk_count * (task + 1) / f->task_count);
    size_t most = 0;
    for (int i = begin; i < end; i++)
        most = f->chunks[i].size > most ? f->chunks[i].size : most;
    bool plain = f->compression == EXR_COMPRESSION_NONE;
    bool twice = f->compression == EXR_COMPRESSION_RLE || f->compression == EXR_COMPRESSION_ZIPS ||
                 f->compression == EXR_COMPRESSION_ZIP;
    uint8_t *raw = plain ? NULL : ki_alloc_raw(f->context, most, twice ? 2 : 1);
    kiln_result result = plain || raw ? KILN_OK : KILN_ERROR_MEMORY;
    for (int i = begin; i < end && result == KILN_OK; i++) {
        result = decode_chunk(f, &f->chunks[i], raw, twice ? raw + most : NULL);
        f->damaged[task] = i;
    }
    ki_free(raw);
    f->results[task] = (uint8_t)result;
}

// A chunk's packed bytes cannot become arbitrarily many: bounds of each compression, so that a
// short file cannot ask for a huge picture.
static size_t most_from(exr_compression_t compression, size_t packed_size)
{
    size_t ratio = 1;
    switch (compression) {
    case EXR_COMPRESSION_RLE:
        ratio = 64;
        break;
    case EXR_COMPRESSION_ZIPS:
    case EXR_COMPRESSION_ZIP:
        ratio = 1032;
        break;
    case EXR_COMPRESSION_PIZ:
        ratio = 512;
        break;
    case EXR_COMPRESSION_PXR24:
        ratio = 1032 * 4 / 3;
        break;
    case EXR_COMPRESSION_B44:
    case EXR_COMPRESSION_B44A:
        ratio = 11;
        break;
    case EXR_COMPRESSION_DWAA:
    case EXR_COMPRESSION_DWAB:
        ratio = 1 << 17; // a byte of deflated block means, 516 of them, 256 bytes each
        break;
    case EXR_COMPRESSION_NONE:
    case EXR_COMPRESSION_LAST_TYPE:
        break;
    }
    return packed_size > SIZE_MAX / ratio - 64 ? SIZE_MAX
                                               : packed_size * ratio + (ratio > 1 ? 64 : 0);
}

static kiln_result add_chunk(exr_file *f, const exr_chunk_info_t *info, int x, int y,
                             kiln_error *error)
{
    int index = f->chunk_count++;
    exr_chunk *c = &f->chunks[index];
    c->info = *info;
    c->box = (ki_exr_box){x, y, info->width, info->height, f->channels, f->channel_count};
    c->size = ki_exr_box_size(&c->box);
    c->packed_size = (size_t)info->packed_size;
    if (info->data_offset > f->size || info->packed_size > f->size - info->data_offset)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: chunk %d lies outside the file's %zu bytes",
                       f->name, index, f->size);
    c->packed = f->bytes + info->data_offset;
    if (!c->size || c->packed_size > c->size || c->size > most_from(f->compression, c->packed_size))
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: chunk %d has %zu bytes, which cannot hold its %d x %d pixels", f->name,
                       index, c->packed_size, info->width, info->height);
    return KILN_OK;
}

static kiln_result damaged_table(const exr_file *f, int index, kiln_error *error)
{
    return ki_fail(error, KILN_ERROR_FORMAT, "%s: chunk %d is missing or damaged", f->name, index);
}

// Finds all chunks, and checks them before memory is asked for.
static kiln_result find_chunks(exr_file *f, kiln_error *error)
{
    int32_t entry_count = 0, lines = 0;
    int width = f->data.max.x - f->data.min.x + 1, height = f->data.max.y - f->data.min.y + 1;
    if (exr_get_chunk_count(f->core, f->part, &entry_count) != EXR_ERR_SUCCESS || entry_count < 1 ||
        (size_t)entry_count > f->size / 8)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: a table of %d chunks does not fit into %zu bytes", f->name,
                       (int)entry_count, f->size);
    f->chunks = ki_alloc(f->context, (size_t)entry_count, sizeof *f->chunks);
    if (!f->chunks)
        return ki_fail_memory(f->context, error, f->name, (size_t)entry_count * sizeof *f->chunks);
    exr_chunk_info_t info;
    kiln_result result = KILN_OK;
    if (!f->tiled) {
        if (exr_get_scanlines_per_chunk(f->core, f->part, &lines) != EXR_ERR_SUCCESS || lines < 1 ||
            (height + lines - 1) / lines > entry_count)
            return damaged_table(f, 0, error);
        for (int y = 0; y < height && result == KILN_OK; y += lines) {
            if (exr_read_scanline_chunk_info(f->core, f->part, f->data.min.y + y, &info) !=
                    EXR_ERR_SUCCESS ||
                info.height < 1 || info.height > height - y || info.width != width)
                return damaged_table(f, f->chunk_count, error);
            result = add_chunk(f, &info, f->data.min.x, f->data.min.y + y, error);
        }
        return result;
    }
    int32_t tile_width = 0, tile_height = 0;
    if (exr_get_tile_sizes(f->core, f->part, 0, 0, &tile_width, &tile_height) != EXR_ERR_SUCCESS ||
        tile_width < 1 || tile_height < 1)
        return damaged_table(f, 0, error);
    for (int y = 0; y < height; y += ki_min(tile_height, height - y)) {
        for (int x = 0; x < width; x += ki_min(tile_width, width - x)) {
            if (f->chunk_count == entry_count ||
                exr_read_tile_chunk_info(f->core, f->part, x / tile_width, y / tile_height, 0, 0,
                                         &info) != EXR_ERR_SUCCESS ||
                info.width != ki_min(tile_width, width - x) ||
                info.height != ki_min(tile_height, height - y))
                return damaged_table(f, f->chunk_count, error);
            result = add_chunk(f, &info, f->data.min.x + x, f->data.min.y + y, error);
            if (result != KILN_OK)
                return result;
        }
    }
    return KILN_OK;
}

// ------------------------------------------------------------------------------------------ header

static int64_t read_memory(exr_const_context_t core, void *data, void *buffer, uint64_t size,
                           uint64_t offset, exr_stream_error_func_ptr_t fail)
{
    (void)core;
    (void)fail;
    const exr_file *f = data;
    if (offset >= f->size)
        return 0;
    uint64_t left = f->size - offset, count = left < size ? left : size;
    memcpy(buffer, f->bytes + offset, (size_t)count);
    return (int64_t)count;
}

static int64_t memory_size(exr_const_context_t core, void *data)
{
    (void)core;
    return (int64_t)((const exr_file *)data)->size;
}

static void say_nothing(exr_const_context_t core, exr_result_t code, const char *message)
{
    (void)core;
    (void)code;
    (void)message;
}

static const char *suffix_of(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot ? dot + 1 : name;
}

static int find_channel(const exr_attr_chlist_t *list, const char *layer, size_t layer_length,
                        const char *name)
{
    for (int c = 0; c < list->num_channels; c++) {
        const char *full = list->entries[c].name.str;
        if (!strncmp(full, layer, layer_length) && !strcmp(full + layer_length, name))
            return c;
    }
    return -1;
}

// R, G and B; else Y; else those of the first layer that has one of them.
static bool choose_channels(const exr_attr_chlist_t *list, int wanted[3])
{
    static const char *const colours[3] = {"R", "G", "B"};
    for (int pass = -1; pass < list->num_channels; pass++) {
        const char *layer = pass < 0 ? "" : list->entries[pass].name.str;
        size_t length = pass < 0 ? 0 : (size_t)(suffix_of(layer) - layer);
        if (pass >= 0 && length == 0)
            continue;
        bool any = false;
        for (int k = 0; k < 3; k++) {
            wanted[k] = find_channel(list, layer, length, colours[k]);
            any = any || wanted[k] >= 0;
        }
        if (any)
            return true;
        int grey = find_channel(list, layer, length, "Y");
        wanted[0] = wanted[1] = wanted[2] = grey;
        if (grey >= 0)
            return true;
    }
    return false;
}

static void list_channels(const exr_attr_chlist_t *list, char *text, size_t room)
{
    size_t used = 0;
    text[0] = 0;
    for (int c = 0; c < list->num_channels && used + 40 < room; c++)
        used += (size_t)snprintf(text + used, room - used, "%s%.32s", c ? ", " : "",
                                 list->entries[c].name.str);
}

static kiln_result choose_part(exr_file *f, kiln_error *error)
{
    int count = 0, deep = 0;
    const exr_attr_chlist_t *list = NULL, *first = NULL;
    exr_get_count(f->core, &count);
    for (f->part = 0; f->part < count; f->part++) {
        exr_storage_t storage;
        if (exr_get_storage(f->core, f->part, &storage) != EXR_ERR_SUCCESS ||
            exr_get_channels(f->core, f->part, &list) != EXR_ERR_SUCCESS)
            continue;
        if (storage == EXR_STORAGE_DEEP_SCANLINE || storage == EXR_STORAGE_DEEP_TILED) {
            deep++;
            continue;
        }
        f->tiled = storage == EXR_STORAGE_TILED;
        first = first ? first : list;
        if (choose_channels(list, f->wanted))
            break;
    }
    if (f->part == count && deep && !first)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: holds deep samples, flat pictures are read", f->name);
    if (f->part == count || !list) {
        char names[256] = "none";
        if (first)
            list_channels(first, names, sizeof names);
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: has no channel R, G, B or Y, its channels are %s", f->name, names);
    }
    if (list->num_channels > KI_EXR_MAX_CHANNELS)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED, "%s: has %d channels, the limit is %d",
                       f->name, list->num_channels, KI_EXR_MAX_CHANNELS);
    f->channel_count = list->num_channels;
    for (int c = 0; c < f->channel_count; c++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[c];
        f->channels[c] = (ki_exr_channel){.name = entry->name.str,
                                          .type = (int)entry->pixel_type,
                                          .bytes = entry->pixel_type == EXR_PIXEL_HALF ? 2 : 4,
                                          .x_sampling = entry->x_sampling,
                                          .y_sampling = entry->y_sampling,
                                          .linear = entry->p_linear != 0};
        if (entry->x_sampling < 1 || entry->y_sampling < 1 || entry->x_sampling > KILN_MAX_SIZE ||
            entry->y_sampling > KILN_MAX_SIZE || (int)entry->pixel_type < 0 ||
            entry->pixel_type >= EXR_PIXEL_LAST_TYPE)
            return ki_fail(error, KILN_ERROR_FORMAT,
                           "%s: channel %.32s has type %d and sampling %d x %d", f->name,
                           entry->name.str, (int)entry->pixel_type, (int)entry->x_sampling,
                           (int)entry->y_sampling);
    }
    for (int k = 0; k < 3; k++) {
        const ki_exr_channel *c = f->wanted[k] < 0 ? NULL : &f->channels[f->wanted[k]];
        if (c && (c->x_sampling != 1 || c->y_sampling != 1))
            return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                           "%s: channel %.32s has one sample for %d x %d pixels, only full "
                           "resolution is read",
                           f->name, c->name, c->x_sampling, c->y_sampling);
    }
    const char *one = f->channels[f->wanted[0] < 0 ? 0 : f->wanted[0]].name;
    if (!strcmp(suffix_of(one), "Y") &&
        (find_channel(list, one, (size_t)(suffix_of(one) - one), "RY") >= 0 ||
         find_channel(list, one, (size_t)(suffix_of(one) - one), "BY") >= 0))
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: stores luminance and chroma (Y, RY, BY), channels R, G and B are read",
                       f->name);
    return KILN_OK;
}

static kiln_result check_window(const exr_file *f, const char *what, const exr_attr_box2i_t *w,
                                kiln_error *error)
{
    int64_t width = (int64_t)w->max.x - w->min.x + 1, height = (int64_t)w->max.y - w->min.y + 1;
    if (width < 1 || height < 1 || width > KILN_MAX_SIZE || height > KILN_MAX_SIZE)
        return ki_fail(error, width < 1 || height < 1 ? KILN_ERROR_FORMAT : KILN_ERROR_UNSUPPORTED,
                       "%s: %s is %lld x %lld, the limit is %d", f->name, what, (long long)width,
                       (long long)height, KILN_MAX_SIZE);
    enum { FAR = 1 << 28 };
    if (w->min.x < -FAR || w->min.y < -FAR || w->max.x > FAR || w->max.y > FAR)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: %s begins at (%d, %d)", f->name, what,
                       w->min.x, w->min.y);
    return KILN_OK;
}

static const char *const compression_names[] = {"uncompressed", "rle", "zips", "zip",  "piz",
                                                "pxr24",        "b44", "b44a", "dwaa", "dwab"};

static kiln_result open_file(exr_file *f, kiln_error *error)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = say_nothing;
    init.user_data = f;
    KI_EXR_MEMORY(&init, f->context);
    init.read_fn = read_memory;
    init.size_fn = memory_size;
    init.flags =
        EXR_CONTEXT_FLAG_SILENT_HEADER_PARSE | EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    exr_result_t opened = exr_start_read(&f->core, f->name[0] ? f->name : "exr", &init);
    if (opened == EXR_ERR_OUT_OF_MEMORY)
        return ki_fail(error, KILN_ERROR_MEMORY, "out of memory: %s: reading the header", f->name);
    if (opened != EXR_ERR_SUCCESS)
        return ki_fail(error, KILN_ERROR_FORMAT, "%s: the EXR header is damaged: %s", f->name,
                       exr_get_default_error_message(opened));
    kiln_result result = choose_part(f, error);
    if (result != KILN_OK)
        return result;
    if (exr_get_data_window(f->core, f->part, &f->data) != EXR_ERR_SUCCESS ||
        exr_get_display_window(f->core, f->part, &f->display) != EXR_ERR_SUCCESS ||
        exr_get_compression(f->core, f->part, &f->compression) != EXR_ERR_SUCCESS ||
        (int)f->compression < 0 || f->compression >= EXR_COMPRESSION_LAST_TYPE)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: the EXR header has no windows or no known compression", f->name);
    result = check_window(f, "dataWindow", &f->data, error);
    if (result == KILN_OK)
        result = check_window(f, "displayWindow", &f->display, error);
    f->width = f->display.max.x - f->display.min.x + 1;
    f->height = f->display.max.y - f->display.min.y + 1;
    return result;
}

static void describe(const exr_file *f, kiln_file_info *info)
{
    static const char *const types[] = {"uint", "half", "float"};
    int count = 0, type = EXR_PIXEL_HALF;
    for (int k = 0; k < 3; k++)
        if (f->wanted[k] >= 0) {
            count++;
            type = f->channels[f->wanted[k]].type;
        }
    bool grey = f->wanted[0] >= 0 && f->wanted[0] == f->wanted[1];
    snprintf(info->format, sizeof info->format, "exr");
    snprintf(info->encoding, sizeof info->encoding, "%s %s, %s%s", types[type],
             grey ? "grey" : "rgb", compression_names[f->compression], f->tiled ? ", tiled" : "");
    info->width = f->width;
    info->height = f->height;
    info->channel_count = grey ? 1 : count;
    info->level_count = 1;
    const exr_attribute_t *software = NULL;
    if (exr_get_attribute_by_name(f->core, f->part, "software", &software) == EXR_ERR_SUCCESS &&
        software->type == EXR_ATTR_STRING && !strncmp(software->string->str, "kiln ", 5))
        snprintf(info->writer, sizeof info->writer, "%.63s", software->string->str);
    const exr_attribute_t *shape = NULL;
    if (exr_get_attribute_by_name(f->core, f->part, "kilnShape", &shape) == EXR_ERR_SUCCESS &&
        shape->type == EXR_ATTR_STRING && !strcmp(shape->string->str, "octahedron") &&
        f->width == f->height)
        snprintf(info->layout, sizeof info->layout, "octahedron");
    const exr_attribute_t *table = NULL;
    if (exr_get_attribute_by_name(f->core, f->part, "kilnTable", &table) == EXR_ERR_SUCCESS &&
        table->type == EXR_ATTR_STRING)
        ki_describe_table(info, table->string->str);
    float roughness;
    if (exr_attr_get_float(f->core, f->part, "kilnRoughness", &roughness) == EXR_ERR_SUCCESS &&
        roughness >= 0 && roughness <= 1)
        info->roughness[0] = roughness;
}

static kiln_result decode_all(exr_file *f, kiln_error *error)
{
    enum { TASKS = 64, ROUNDS = 8 };
    f->task_count = ki_min(TASKS, f->chunk_count);
    uint8_t results[TASKS] = {0};
    int damaged[TASKS] = {0};
    f->results = results;
    f->damaged = damaged;
    if (f->compression == EXR_COMPRESSION_DWAA || f->compression == EXR_COMPRESSION_DWAB) {
        f->dwa_table = ki_alloc_raw(f->context, 65536, sizeof *f->dwa_table);
        if (!f->dwa_table)
            return ki_fail_memory(f->context, error, f->name, 65536 * sizeof *f->dwa_table);
        ki_dwa_linear_table(f->context, f->dwa_table);
    }
    // A large picture in rounds, between which one may stop.
    int rounds = (size_t)f->width * (size_t)f->height < (size_t)1 << 23 ? 1 : ROUNDS;
    for (int r = 0; r < rounds; r++) {
        if (!ki_progress(f->context, "reading", (double)r / rounds))
            return ki_fail_cancelled(error, "reading");
        f->first_task = f->task_count * r / rounds;
        int end = f->task_count * (r + 1) / rounds;
        ki_parallel_for(f->context, end - f->first_task, decode_chunks, f);
    }
    for (int t = 0; t < f->task_count; t++) {
        if (results[t] == KILN_ERROR_MEMORY)
            return ki_fail_memory(f->context, error, f->name, 2 * f->chunks[damaged[t]].size);
        if (results[t] != KILN_OK)
            return ki_fail(error, KILN_ERROR_FORMAT,
                           "%s: chunk %d of %d (%s, %zu bytes) is damaged", f->name, damaged[t],
                           f->chunk_count, compression_names[f->compression],
                           f->chunks[damaged[t]].packed_size);
    }
    return KILN_OK;
}

static bool covered(const exr_file *f)
{
    return f->data.min.x <= f->display.min.x && f->data.min.y <= f->display.min.y &&
           f->data.max.x >= f->display.max.x && f->data.max.y >= f->display.max.y;
}

kiln_result ki_exr_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, kiln_image *image, kiln_file_info *info,
                          kiln_error *error)
{
    if (image)
        *image = (kiln_image){0};
    exr_file *f = ki_alloc(context, 1, sizeof *f);
    if (!f)
        return ki_fail_memory(context, error, name, sizeof *f);
    f->context = context;
    f->bytes = bytes;
    f->size = size;
    f->name = name;
    kiln_result result = open_file(f, error);
    if (result == KILN_OK && info)
        describe(f, info);
    if (result != KILN_OK || !image)
        goto done;
    result = find_chunks(f, error);
    if (result != KILN_OK)
        goto done;

    size_t count = 3 * (size_t)f->width * (size_t)f->height;
    f->pixels = covered(f) ? ki_alloc_raw(context, count, sizeof(float))
                           : ki_alloc(context, count, sizeof(float));
    if (!f->pixels) {
        result = ki_fail_memory(context, error, name, count * sizeof(float));
        goto done;
    }
    result = decode_all(f, error);
    if (result == KILN_OK) {
        *image = (kiln_image){f->width, f->height, 3, f->pixels, f->pixels};
        f->pixels = NULL;
    }
done:
    ki_free(f->pixels);
    ki_free(f->chunks);
    ki_free(f->dwa_table);
    if (f->core)
        exr_finish(&f->core);
    ki_free(f);
    return result;
}

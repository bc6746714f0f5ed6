// Reading of EXR files. In: the bytes of a file. Out: a picture of three floats a pixel.
// exr_header.c parses the header, exr_chunk.c finds and decompresses the chunks, exr_pixels.c
// converts the samples, and this file chooses the part and the channels. Chunks are independent and
// are decompressed in parallel.
//
// The picture is the display window; pixels outside the data window are 0. Read are the first part
// with colour, level 0 of a part with several levels, and the channels R, G and B, or Y as grey.
// Channels without a layer's name are preferred to those with one. The attribute "chromaticities"
// is not applied.
#include "codec/exr.h"
#include "codec/codec.h"
#include "codec/engine_text.h"
#include "codec/file_info.h"

#include <stdio.h>
#include <string.h>

enum { TASKS = 64, ROUNDS = 8 };

typedef struct exr_file {
    kiln_context *context;
    const char *name;
    ki_exr_header header;
    const ki_exr_part *part; // the part that is read: a file may hold several pictures
    int part_index;
    ki_exr_picture picture;
    ki_exr_chunk *chunks;
    int chunk_count;
    uint16_t *dwa_table;
    int task_count, first_task;
    uint8_t results[TASKS]; // the kiln_result of each task that decodes chunks
    int damaged[TASKS];     // index of the chunk at which each task failed
} exr_file;

// ------------------------------------------------------------------------------- part and channels

static int find_channel(const ki_exr_part *p, const char *layer, size_t layer_length,
                        const char *name)
{
    for (int c = 0; c < p->channel_count; c++) {
        const char *full = p->channels[c].name;
        if (!strncmp(full, layer, layer_length) && !strcmp(full + layer_length, name))
            return c;
    }
    return -1;
}

// Chooses the channels of one layer that become red, green and blue: R, G and B, or else Y for all
// three. Returns false if the layer has none of these channels.
static bool choose_in_layer(const ki_exr_part *p, const char *layer, size_t length, int source[3])
{
    static const char *const colours[3] = {"R", "G", "B"};
    bool any = false;
    for (int k = 0; k < 3; k++) {
        source[k] = find_channel(p, layer, length, colours[k]);
        any = any || source[k] >= 0;
    }
    if (!any)
        source[0] = source[1] = source[2] = find_channel(p, layer, length, "Y");
    return source[0] >= 0 || any;
}

// Chooses the channels that become red, green and blue: those whose names have no layer, or else
// those of the first layer that has R, G, B or Y.
static bool choose_channels(const ki_exr_part *p, int source[3])
{
    if (choose_in_layer(p, "", 0, source))
        return true;
    for (int c = 0; c < p->channel_count; c++) {
        const char *name = p->channels[c].name;
        size_t length = (size_t)(ki_exr_suffix(name) - name);
        if (length > 0 && choose_in_layer(p, name, length, source))
            return true;
    }
    return false;
}

static void list_channels(const ki_exr_part *p, char *text, size_t room)
{
    size_t used = 0;
    text[0] = 0;
    for (int c = 0; c < p->channel_count && used + 40 < room; c++)
        used += (size_t)snprintf(text + used, room - used, "%s%.32s", c ? ", " : "",
                                 p->channels[c].name);
}

static kiln_result choose_part(exr_file *f, kiln_error *error)
{
    const ki_exr_part *first = NULL; // first part of the file that is not deep
    for (int i = 0; i < f->header.part_count; i++) {
        const ki_exr_part *p = &f->header.parts[i];
        if (p->deep || p->channel_count > KI_EXR_MAX_CHANNELS)
            continue;
        first = first ? first : p;
        if (choose_channels(p, f->picture.source)) {
            f->part = p;
            f->part_index = i;
            return KILN_OK;
        }
    }
    const ki_exr_part *p = &f->header.parts[0];
    if (!first && p->deep)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: holds deep samples, kiln reads flat pictures only", f->name);
    if (!first)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED, "%s: has %d channels, the limit is %d",
                       f->name, p->channel_count, KI_EXR_MAX_CHANNELS);
    char names[256];
    list_channels(first, names, sizeof names);
    return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                   "%s: has no channel R, G, B or Y; its channels are %s", f->name, names);
}

// Fails unless red, green and blue have channels, and these channels are not subsampled.
static kiln_result check_channels(const exr_file *f, kiln_error *error)
{
    const ki_exr_part *p = f->part;
    const char *chosen = NULL;
    for (int k = 0; k < 3; k++) {
        const ki_exr_channel *c =
            f->picture.source[k] < 0 ? NULL : &p->channels[f->picture.source[k]];
        if (c && (c->x_sampling != 1 || c->y_sampling != 1))
            return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                           "%s: channel %.32s has one sample for %d x %d pixels, kiln reads one "
                           "sample for each pixel only",
                           f->name, c->name, c->x_sampling, c->y_sampling);
        chosen = c ? c->name : chosen;
    }
    size_t layer = (size_t)(ki_exr_suffix(chosen) - chosen);
    if (!strcmp(chosen + layer, "Y") &&
        (find_channel(p, chosen, layer, "RY") >= 0 || find_channel(p, chosen, layer, "BY") >= 0))
        return ki_fail(
            error, KILN_ERROR_UNSUPPORTED,
            "%s: stores luminance and chroma (Y, RY, BY), kiln reads channels R, G and B only",
            f->name);
    return KILN_OK;
}

static kiln_result check_window(const exr_file *f, const char *what, const ki_exr_window *w,
                                kiln_error *error)
{
    int64_t width = (int64_t)w->right - w->left + 1, height = (int64_t)w->bottom - w->top + 1;
    if (width < 1 || height < 1 || width > KILN_MAX_SIZE || height > KILN_MAX_SIZE)
        return ki_fail(error, width < 1 || height < 1 ? KILN_ERROR_FORMAT : KILN_ERROR_UNSUPPORTED,
                       "%s: %s is %lld x %lld, the limit is %d", f->name, what, (long long)width,
                       (long long)height, KILN_MAX_SIZE);
    enum { FAR = 1 << 28 };
    if (w->left < -FAR || w->top < -FAR || w->right > FAR || w->bottom > FAR)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: %s begins at (%d, %d), which is too far from the origin", f->name, what,
                       w->left, w->top);
    return KILN_OK;
}

static kiln_result open_file(exr_file *f, const uint8_t *bytes, size_t size, kiln_error *error)
{
    kiln_result result = ki_exr_read_header(f->context, bytes, size, f->name, &f->header, error);
    if (result == KILN_OK)
        result = choose_part(f, error);
    if (result == KILN_OK)
        result = check_channels(f, error);
    if (result != KILN_OK)
        return result;
    const ki_exr_window *display = &f->part->display;
    if (f->part->compression >= KI_EXR_COMPRESSIONS)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: has compression %d, which OpenEXR does not define", f->name,
                       f->part->compression);
    result = check_window(f, "dataWindow", &f->part->data, error);
    if (result == KILN_OK)
        result = check_window(f, "displayWindow", display, error);
    if (result != KILN_OK)
        return result;
    f->picture.left = display->left;
    f->picture.top = display->top;
    f->picture.width = display->right - display->left + 1;
    f->picture.height = display->bottom - display->top + 1;
    return KILN_OK;
}

// ------------------------------------------------------------------------------------- description

// Copies the text of a part's string attribute to `text`, truncated to `room` bytes; "" if the part
// has no such attribute.
static void read_string(const ki_exr_part *p, const char *name, char *text, size_t room)
{
    size_t size = 0;
    const uint8_t *bytes = ki_exr_attribute(p, name, "string", &size);
    size = bytes ? size < room ? size : room - 1 : 0;
    if (size)
        memcpy(text, bytes, size);
    text[size] = 0;
}

// Fills in `info` from kiln's own attributes: the shape, the roughness, the engine or the table.
static void describe_attributes(const exr_file *f, kiln_file_info *info)
{
    char text[sizeof info->table];
    read_string(f->part, "software", text, sizeof info->writer);
    if (!strncmp(text, "kiln ", 5))
        ki_copy_printable(info->writer, sizeof info->writer, text);
    read_string(f->part, "kilnShape", text, sizeof text);
    if (!strcmp(text, "octahedron") && f->picture.width == f->picture.height)
        snprintf(info->layout, sizeof info->layout, "octahedron");
    read_string(f->part, "kilnTable", text, sizeof text);
    ki_copy_printable(info->table, sizeof info->table, text);
    char engine[512];
    read_string(f->part, "kilnEngine", engine, sizeof engine);
    ki_engine_text_read(engine, info);
    size_t size = 0;
    const uint8_t *bytes = ki_exr_attribute(f->part, "kilnRoughness", "float", &size);
    float roughness = -1;
    if (bytes && size == sizeof roughness)
        memcpy(&roughness, bytes, sizeof roughness);
    if (roughness >= 0 && roughness <= 1)
        info->roughness[0] = roughness;
}

static void describe(const exr_file *f, kiln_file_info *info)
{
    static const char *const types[KI_EXR_TYPES] = {"uint", "half", "float"};
    const int *source = f->picture.source;
    int count = 0, type = KI_EXR_HALF;
    for (int k = 0; k < 3; k++)
        if (source[k] >= 0) {
            count++;
            type = f->part->channels[source[k]].type;
        }
    bool grey = source[0] >= 0 && source[0] == source[1];
    snprintf(info->format, sizeof info->format, "exr");
    snprintf(info->encoding, sizeof info->encoding, "%s %s, %s%s", types[type],
             grey ? "grey" : "rgb", ki_exr_compression_name(f->part->compression),
             f->part->tiled ? ", tiled" : "");
    info->width = f->picture.width;
    info->height = f->picture.height;
    info->channel_count = grey ? 1 : count;
    info->level_count = 1;
    describe_attributes(f, info);
}

// ------------------------------------------------------------------------------------------ pixels

// Task of one thread: decodes chunks that follow one another in the file. The task allocates memory
// for the largest of its chunks.
static void decode_chunks(void *data, int index)
{
    exr_file *f = data;
    int task = f->first_task + index;
    int begin = (int)((int64_t)f->chunk_count * task / f->task_count);
    int end = (int)((int64_t)f->chunk_count * (task + 1) / f->task_count);
    size_t most = 0;
    for (int i = begin; i < end; i++)
        most = f->chunks[i].size > most ? f->chunks[i].size : most;
    bool packed = f->part->compression != KI_EXR_NONE;
    uint8_t *raw = packed ? ki_alloc_raw(f->context, most, 2) : NULL;
    const ki_exr_workspace work = {f->context, raw ? raw + most : NULL, f->dwa_table};
    kiln_result result = packed && !raw ? KILN_ERROR_MEMORY : KILN_OK;
    for (int i = begin; i < end && result == KILN_OK; i++) {
        const uint8_t *samples =
            ki_exr_chunk_samples(&work, f->part->compression, &f->chunks[i], raw, &result);
        if (samples)
            ki_exr_put_box(&f->picture, &f->chunks[i].box, samples);
        f->damaged[task] = i;
    }
    ki_free(raw);
    f->results[task] = (uint8_t)result;
}

static kiln_result say_damaged(const exr_file *f, int task, kiln_error *error)
{
    const ki_exr_chunk *chunk = &f->chunks[f->damaged[task]];
    if (f->results[task] == KILN_ERROR_MEMORY)
        return ki_fail_memory(f->context, error, f->name, 2 * chunk->size);
    return ki_fail(error, KILN_ERROR_FORMAT, "%s: chunk %d of %d (%s, %zu bytes) is damaged",
                   f->name, f->damaged[task], f->chunk_count,
                   ki_exr_compression_name(f->part->compression), chunk->packed_size);
}

static kiln_result decode_all(exr_file *f, kiln_error *error)
{
    f->task_count = ki_min(TASKS, f->chunk_count);
    if (f->part->compression == KI_EXR_DWAA || f->part->compression == KI_EXR_DWAB) {
        f->dwa_table = ki_alloc_raw(f->context, 65536, sizeof *f->dwa_table);
        if (!f->dwa_table)
            return ki_fail_memory(f->context, error, f->name, 65536 * sizeof *f->dwa_table);
        ki_exr_dwa_table(f->context, f->dwa_table);
    }
    // A large picture is decoded in rounds, between which the caller may stop the work.
    int rounds =
        (size_t)f->picture.width * (size_t)f->picture.height < (size_t)1 << 23 ? 1 : ROUNDS;
    for (int r = 0; r < rounds; r++) {
        if (!ki_progress(f->context, "reading", (double)r / rounds))
            return ki_fail_cancelled(error, "reading");
        f->first_task = f->task_count * r / rounds;
        int end = f->task_count * (r + 1) / rounds;
        ki_parallel_for(f->context, end - f->first_task, decode_chunks, f);
    }
    for (int t = 0; t < f->task_count; t++)
        if (f->results[t] != KILN_OK)
            return say_damaged(f, t, error);
    return KILN_OK;
}

// Returns the number of pixels of the display window that lie outside the data window.
static size_t count_missing(const ki_exr_window *data, const ki_exr_window *display)
{
    int width = ki_min(data->right, display->right) - ki_max(data->left, display->left) + 1;
    int height = ki_min(data->bottom, display->bottom) - ki_max(data->top, display->top) + 1;
    size_t covered = width > 0 && height > 0 ? (size_t)width * (size_t)height : 0;
    return (size_t)(display->right - display->left + 1) *
               (size_t)(display->bottom - display->top + 1) -
           covered;
}

static kiln_result read_pixels(exr_file *f, kiln_image *image, kiln_load_report *report,
                               kiln_error *error)
{
    ki_exr_picture *p = &f->picture;
    size_t texels = (size_t)p->width * (size_t)p->height, count = 3 * texels;
    size_t missing = count_missing(&f->part->data, &f->part->display);
    if (missing == texels)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: none of the %zu pixels of its display window lies in its data window",
                       f->name, texels);
    kiln_result result = ki_exr_find_chunks(f->context, &f->header, f->part_index, f->name,
                                            &f->chunks, &f->chunk_count, error);
    if (result != KILN_OK)
        return result;
    p->pixels = missing ? ki_alloc(f->context, count, sizeof(float))
                        : ki_alloc_raw(f->context, count, sizeof(float));
    if (!p->pixels)
        return ki_fail_memory(f->context, error, f->name, count * sizeof(float));
    result = decode_all(f, error);
    if (result == KILN_OK) {
        *image = (kiln_image){p->width, p->height, 3, p->pixels, p->pixels};
        p->pixels = NULL;
        if (report)
            report->missing_count = missing;
    }
    return result;
}

kiln_result ki_exr_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, kiln_image *image, kiln_file_info *info,
                          kiln_load_report *report, kiln_error *error)
{
    if (image)
        *image = (kiln_image){0};
    exr_file *f = ki_alloc(context, 1, sizeof *f);
    if (!f)
        return ki_fail_memory(context, error, name, sizeof *f);
    f->context = context;
    f->name = name;
    kiln_result result = open_file(f, bytes, size, error);
    if (result == KILN_OK && info)
        describe(f, info);
    if (result == KILN_OK && image)
        result = read_pixels(f, image, report, error);
    ki_free(f->picture.pixels);
    ki_free(f->chunks);
    ki_free(f->dwa_table);
    ki_exr_header_free(&f->header);
    ki_free(f);
    return result;
}

// Reading of EXR files. In: the bytes of a file. Out: a picture of three floats a pixel, and notes.
// exr_header.c parses the header, exr_layers.c chooses the part and the layer, exr_chunk.c finds
// and decompresses the chunks, and exr_pixels.c converts the samples. exr_chroma.c computes colours
// from luminance and chroma, and exr_color.c and image/color.h convert other primaries to Rec. 709.
// Chunks are independent and are decompressed in parallel.
//
// The picture is the display window; pixels outside the data window are 0. Of a part with several
// levels, level 0 is read.
#include "codec/codec.h"
#include "codec/engine_text.h"
#include "codec/exr_file.h"
#include "codec/file_info.h"
#include "codec/report.h"

#include <stdio.h>
#include <string.h>

enum { TASKS = KI_EXR_TASKS };

// ---------------------------------------------------------------------------------------- channels

// Chooses the layer that becomes the picture. If the caller wants a description alone, a file in
// which no layer can be chosen is described by its first layer.
static kiln_result choose(ki_exr_file *f, const char *wanted, bool describe_only, kiln_error *error)
{
    kiln_result result =
        ki_exr_choose_layer(&f->header, &f->layers, wanted, f->name, &f->layer, error);
    f->chosen = result == KILN_OK;
    if (!f->chosen && (!describe_only || !f->layers.count))
        return result;
    if (!f->chosen)
        f->layer = f->layers.layer[0];
    f->part = &f->header.parts[f->layer.part];
    const int *channel = f->layer.channel;
    int *source = f->picture.source;
    bool chroma = f->layer.kind == KI_EXR_CHROMA, grey = f->layer.kind == KI_EXR_GREY;
    source[0] = channel[chroma ? KI_EXR_RED_CHROMA : grey ? KI_EXR_LUMINANCE : KI_EXR_RED];
    source[1] = channel[chroma || grey ? KI_EXR_LUMINANCE : KI_EXR_GREEN];
    source[2] = channel[chroma ? KI_EXR_BLUE_CHROMA : grey ? KI_EXR_LUMINANCE : KI_EXR_BLUE];
    return KILN_OK;
}

// Returns 2 if chroma has one sample for 2 x 2 pixels of the data window, as OpenEXR writes it,
// else 1.
static int find_sampling(const ki_exr_file *f)
{
    const ki_exr_window *w = &f->part->data;
    const int *source = f->picture.source;
    if (f->layer.kind != KI_EXR_CHROMA)
        return 1;
    const ki_exr_channel *c = &f->part->channels[source[0] >= 0 ? source[0] : source[2]];
    bool even = w->left % 2 == 0 && w->top % 2 == 0;
    return even && c->x_sampling == 2 && c->y_sampling == 2 ? 2 : 1;
}

// Fails unless the samples of the chosen channels lie where the picture is read from.
static kiln_result check_channels(ki_exr_file *f, kiln_error *error)
{
    f->sampling = find_sampling(f);
    for (int k = 0; k < 3; k++) {
        if (f->picture.source[k] < 0)
            continue;
        const ki_exr_channel *c = &f->part->channels[f->picture.source[k]];
        int wanted = k == 1 ? 1 : f->sampling;
        if (c->x_sampling == wanted && c->y_sampling == wanted)
            continue;
        char name[48];
        ki_escape_text(name, sizeof name, c->name, strlen(c->name));
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: channel %s has one sample for %d x %d pixels, kiln reads one sample "
                       "for each pixel only, or one for 2 x 2 pixels in both RY and BY",
                       f->name, name, c->x_sampling, c->y_sampling);
    }
    return KILN_OK;
}

static kiln_result check_window(const ki_exr_file *f, const char *what, const ki_exr_window *w,
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

kiln_result ki_exr_open(ki_exr_file *f, const uint8_t *bytes, size_t size, const char *wanted,
                        bool describe_only, kiln_error *error)
{
    kiln_result result = ki_exr_read_header(f->context, bytes, size, f->name, &f->header, error);
    if (result == KILN_OK)
        result = ki_exr_list_layers(f->context, &f->header, f->name, &f->layers, error);
    if (result == KILN_OK)
        result = choose(f, wanted, describe_only, error);
    if (result == KILN_OK && f->chosen)
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
static void describe_attributes(const ki_exr_file *f, kiln_file_info *info)
{
    char text[sizeof info->table];
    read_string(f->part, "software", text, sizeof info->writer);
    if (!strncmp(text, "kiln ", 5))
        ki_copy_printable(info->writer, sizeof info->writer, text);
    size_t size = 0;
    const uint8_t *bytes = ki_exr_attribute(f->part, "envmap", "envmap", &size);
    // kiln's own panoramas have this attribute too, but have their texels where kiln has them.
    if (bytes && size == 1 && !info->writer[0]) {
        bool panorama = f->picture.width == 2 * (int64_t)f->picture.height;
        if (*bytes == 1 || panorama)
            snprintf(info->layout, sizeof info->layout, "openexr-%s",
                     *bytes == 1 ? "cube" : "panorama");
    }
    read_string(f->part, "kilnShape", text, sizeof text);
    if (!strcmp(text, "octahedron") && f->picture.width == f->picture.height)
        snprintf(info->layout, sizeof info->layout, "octahedron");
    read_string(f->part, "kilnTable", text, sizeof text);
    ki_copy_printable(info->table, sizeof info->table, text);
    char engine[512];
    read_string(f->part, "kilnEngine", engine, sizeof engine);
    ki_engine_text_read(engine, info);
    bytes = ki_exr_attribute(f->part, "kilnRoughness", "float", &size);
    float roughness = -1;
    if (bytes && size == sizeof roughness)
        memcpy(&roughness, bytes, sizeof roughness);
    if (roughness >= 0 && roughness <= 1)
        info->roughness[0] = roughness;
}

void ki_exr_describe(const ki_exr_file *f, kiln_file_info *info)
{
    static const char *const types[KI_EXR_TYPES] = {"uint", "half", "float"};
    static const char *const kinds[] = {[KI_EXR_NO_PICTURE] = "data",
                                        [KI_EXR_COLOR] = "rgb",
                                        [KI_EXR_PARTIAL] = "rgb",
                                        [KI_EXR_CHROMA] = "luminance and chroma",
                                        [KI_EXR_GREY] = "grey"};
    const int *source = f->picture.source;
    int count = 0, type = f->part->channels[0].type;
    for (int k = 0; k < 3; k++)
        if (source[k] >= 0) {
            count++;
            type = f->part->channels[source[k]].type;
        }
    snprintf(info->format, sizeof info->format, "exr");
    snprintf(info->encoding, sizeof info->encoding, "%s %s, %s%s", types[type],
             kinds[f->layer.kind], ki_exr_compression_name(f->part->compression),
             f->part->tiled ? ", tiled" : "");
    info->width = f->picture.width;
    info->height = f->picture.height;
    info->channel_count = f->layer.kind == KI_EXR_GREY ? 1 : count;
    info->level_count = 1;
    describe_attributes(f, info);
    ki_exr_describe_layers(&f->header, &f->layers, f->chosen ? &f->layer : NULL, info);
}

// ------------------------------------------------------------------------------------------ pixels

// Task of one thread: decodes chunks that follow one another in the file. The task allocates memory
// for the largest of its chunks.
static void decode_chunks(void *data, int task)
{
    ki_exr_file *f = data;
    int begin = (int)((int64_t)f->chunk_count * task / f->task_count);
    int end = (int)((int64_t)f->chunk_count * (task + 1) / f->task_count);
    size_t most = 0;
    for (int i = begin; i < end; i++)
        most = f->chunks[i].size > most ? f->chunks[i].size : most;
    bool packed = f->part->compression != KI_EXR_NONE;
    uint8_t *raw = packed ? ki_alloc_raw(f->context, most, 2) : NULL;
    ki_exr_workspace work = {f->context, f->asker, raw ? raw + most : NULL, f->dwa_table, 0};
    kiln_result result = packed && !raw ? KILN_ERROR_MEMORY : KILN_OK;
    for (int i = begin; i < end && result == KILN_OK; i++) {
        f->failed_at[task] = i;
        if (ki_was_stopped(&work.asker)) {
            result = KILN_ERROR_CANCELLED;
            break;
        }
        const uint8_t *samples =
            ki_exr_chunk_samples(&work, f->part->compression, &f->chunks[i], raw, &result);
        if (samples)
            result = ki_exr_put_box(&work, &f->picture, &f->chunks[i].box, samples);
    }
    ki_free(raw);
    f->results[task] = (uint8_t)result;
}

kiln_result ki_exr_fail_chunk(const ki_exr_file *f, int index, kiln_result result,
                              kiln_error *error)
{
    const ki_exr_chunk *chunk = &f->chunks[index];
    if (result == KILN_ERROR_MEMORY)
        return ki_fail_memory(f->context, error, f->name, 2 * chunk->size);
    if (result == KILN_ERROR_CANCELLED)
        return ki_fail_cancelled(error, "reading");
    return ki_fail(error, KILN_ERROR_FORMAT, "%s: chunk %d of %d (%s, %zu bytes) is damaged",
                   f->name, index, f->chunk_count, ki_exr_compression_name(f->part->compression),
                   chunk->packed_size);
}

kiln_result ki_exr_prepare(ki_exr_file *f, kiln_error *error)
{
    if (f->part->compression != KI_EXR_DWAA && f->part->compression != KI_EXR_DWAB)
        return KILN_OK;
    f->dwa_table = ki_alloc_raw(f->context, 65536, sizeof *f->dwa_table);
    if (!f->dwa_table)
        return ki_fail_memory(f->context, error, f->name, 65536 * sizeof *f->dwa_table);
    ki_exr_dwa_table(f->context, f->dwa_table);
    return KILN_OK;
}

static kiln_result decode_all(ki_exr_file *f, kiln_error *error)
{
    f->task_count = ki_min(TASKS, f->chunk_count);
    f->asker = ki_asker_make(f->context);
    static const ki_progress_range all = {"reading", 0, 1};
    kiln_result result = ki_exr_prepare(f, error);
    if (result != KILN_OK)
        return result;
    if (!ki_progress(f->context, "reading", 0) ||
        !ki_parallel_steps(f->context, &all, f->task_count, decode_chunks, f))
        return ki_fail_cancelled(error, "reading");
    for (int t = 0; t < f->task_count; t++)
        if (f->results[t] != KILN_OK)
            return ki_exr_fail_chunk(f, f->failed_at[t], f->results[t], error);
    return KILN_OK;
}

static size_t area(const ki_exr_window *w)
{
    return (size_t)(w->right - w->left + 1) * (size_t)(w->bottom - w->top + 1);
}

size_t ki_exr_common(const ki_exr_file *f)
{
    const ki_exr_window *data = &f->part->data, *display = &f->part->display;
    const ki_exr_window common = {
        ki_max(data->left, display->left), ki_max(data->top, display->top),
        ki_min(data->right, display->right), ki_min(data->bottom, display->bottom)};
    return common.left <= common.right && common.top <= common.bottom ? area(&common) : 0;
}

// The file's size bounds the data window, and this rule the display window, so that a short file
// cannot ask for a large picture.
kiln_result ki_exr_check_common(const ki_exr_file *f, size_t common, kiln_error *error)
{
    enum { SMALL = 1 << 20, MOST_EMPTY = 64 };
    size_t pixels = area(&f->part->display);
    if (!common)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: none of the %zu pixels of its display window lies in its data window",
                       f->name, pixels);
    if (pixels > SMALL && pixels / MOST_EMPTY > common)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                       "%s: only %zu of the %zu pixels of its display window lie in its data "
                       "window, it must be at least 1 of %d; write the file with a display window "
                       "that fits the data",
                       f->name, common, pixels, MOST_EMPTY);
    return KILN_OK;
}

static kiln_result allocate(const ki_exr_file *f, size_t pixels, float **memory, kiln_error *error)
{
    void *room = NULL;
    kiln_result result =
        ki_alloc_zeroed(f->context, pixels, 3 * sizeof(float), f->name, &room, error);
    *memory = room;
    return result;
}

// Copies what the picture of the data window has in common with the display window into a picture
// of the display window.
static kiln_result copy_common(kiln_context *context, const ki_exr_picture *data,
                               const ki_exr_picture *display, kiln_error *error)
{
    int left = ki_max(data->left, display->left), top = ki_max(data->top, display->top);
    int right = ki_min(data->left + data->width, display->left + display->width);
    int bottom = ki_min(data->top + data->height, display->top + display->height);
    for (int y = top; y < bottom; y++) {
        if (!ki_go_on(context))
            return ki_fail_cancelled(error, "reading");
        size_t from = (size_t)(y - data->top) * (size_t)data->width + (size_t)(left - data->left);
        size_t to =
            (size_t)(y - display->top) * (size_t)display->width + (size_t)(left - display->left);
        memcpy(display->pixels + 3 * to, data->pixels + 3 * from,
               3 * (size_t)(right - left) * sizeof(float));
    }
    return KILN_OK;
}

// Reads luminance and chroma over the data window, whose border the interpolation of chroma needs,
// and replaces them by colours over the display window.
static kiln_result read_chroma(ki_exr_file *f, kiln_error *error)
{
    const ki_exr_picture display = f->picture;
    const ki_exr_window *w = &f->part->data;
    ki_exr_picture *p = &f->picture;
    float *rgb = NULL;
    p->left = w->left;
    p->top = w->top;
    p->width = w->right - w->left + 1;
    p->height = w->bottom - w->top + 1;
    kiln_result result = allocate(f, area(w), &p->pixels, error);
    if (result == KILN_OK)
        result = decode_all(f, error);
    if (result == KILN_OK)
        result = allocate(f, area(w), &rgb, error);
    if (result == KILN_OK)
        result =
            ki_exr_reconstruct(f->context, p, f->sampling, f->color.weights, f->name, rgb, error);
    ki_free(p->pixels);
    p->pixels = rgb;
    if (result != KILN_OK || !memcmp(w, &f->part->display, sizeof *w))
        return result;
    const ki_exr_picture colours = *p;
    f->picture = display;
    result = allocate(f, area(&f->part->display), &f->picture.pixels, error);
    if (result == KILN_OK)
        result = copy_common(f->context, &colours, &f->picture, error);
    ki_free(colours.pixels);
    return result;
}

static kiln_result read_colors(ki_exr_file *f, size_t common, kiln_error *error)
{
    size_t pixels = area(&f->part->display);
    kiln_result result = KILN_OK;
    if (common != pixels) {
        result = allocate(f, pixels, &f->picture.pixels, error);
    } else {
        f->picture.pixels = ki_alloc_raw(f->context, pixels, 3 * sizeof(float));
        if (!f->picture.pixels)
            result = ki_fail_memory(f->context, error, f->name, 3 * pixels * sizeof(float));
    }
    return result == KILN_OK ? decode_all(f, error) : result;
}

void ki_exr_note_all(const ki_exr_file *f, kiln_load_report *report)
{
    size_t common = ki_exr_common(f);
    size_t outside = area(&f->part->data) - common;
    ki_exr_note_layer(&f->header, &f->layers, &f->layer, report);
    if (outside)
        ki_note(report, KILN_NOTE_CHOICE, false,
                "%zu pixels of the data window lie outside the display window and were left out",
                outside);
    ki_exr_note_aspect(f->part, report);
    ki_exr_note_color(&f->color, f->layer.kind, report);
}

bool ki_exr_converts(const ki_exr_file *f)
{
    return f->layer.kind != KI_EXR_GREY && f->color.converts;
}

static kiln_result read_pixels(ki_exr_file *f, kiln_image *image, kiln_load_report *report,
                               kiln_error *error)
{
    ki_exr_picture *p = &f->picture;
    size_t common = ki_exr_common(f);
    kiln_result result = ki_exr_check_common(f, common, error);
    if (result == KILN_OK)
        result = ki_exr_find_chunks(f->context, &f->header, f->layer.part, f->name, &f->chunks,
                                    &f->chunk_count, error);
    if (result == KILN_OK)
        result =
            f->layer.kind == KI_EXR_CHROMA ? read_chroma(f, error) : read_colors(f, common, error);
    if (result != KILN_OK)
        return result;
    *image = (kiln_image){p->width, p->height, 3, p->pixels, p->pixels};
    p->pixels = NULL;
    if (ki_exr_converts(f) && !ki_image_transform(f->context, &f->color.matrix, image)) {
        kiln_image_free(image);
        return ki_fail_cancelled(error, "reading");
    }
    if (report)
        report->missing_count = area(&f->part->display) - common;
    return KILN_OK;
}

void ki_exr_close(ki_exr_file *f)
{
    ki_free(f->picture.pixels);
    ki_free(f->chunks);
    ki_free(f->dwa_table);
    ki_free(f->layers.layer);
    ki_exr_header_free(&f->header);
    ki_free(f);
}

kiln_result ki_exr_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, const char *layer, kiln_image *image,
                          kiln_file_info *info, kiln_load_report *report, kiln_error *error)
{
    if (image)
        *image = (kiln_image){0};
    ki_exr_file *f = ki_alloc(context, 1, sizeof *f);
    if (!f)
        return ki_fail_memory(context, error, name, sizeof *f);
    f->context = context;
    f->name = name;
    kiln_result result = ki_exr_open(f, bytes, size, layer, !image, error);
    if (result == KILN_OK && f->chosen)
        result = ki_exr_read_color(f->part, name, &f->color, error);
    if (result == KILN_OK && f->chosen)
        ki_exr_note_all(f, report);
    if (result == KILN_OK && info)
        ki_exr_describe(f, info);
    if (result == KILN_OK && image)
        result = read_pixels(f, image, report, error);
    ki_exr_close(f);
    return result;
}

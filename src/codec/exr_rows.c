// Rows of an EXR file. In: an open file whose picture is a panorama, with red, green and blue or
// grey. Out: any rows of the picture. Method: the headers and the tables of chunk offsets are read
// first; each call reads and decompresses the chunks, or the tiles of a row of tiles, that its rows
// overlap, in whatever order the file stores them.
#include "codec/engine_text.h"
#include "codec/exr_file.h"
#include "codec/file_info.h"
#include "codec/layout.h"
#include "codec/row_file.h"

#include <string.h>

typedef struct exr_rows {
    ki_row_input *input;
    ki_exr_file *file;
    uint8_t *head; // the bytes of the file from its beginning, as far as they are held
    int across;    // number of chunks that lie side by side
    int chunk_height;
    bool is_cropped; // some pixels of the picture lie outside the data window and are black
} exr_rows;

// ---------------------------------------------------------------------------------- decoding

// Reads the packed bytes of a chunk, which may be the whole picture, in parts. Returns false on
// failure and if the caller wants to stop.
static bool read_packed(const exr_rows *r, const ki_exr_workspace *work, const ki_exr_chunk *chunk,
                        uint8_t *packed)
{
    enum { STEP = 16 << 20 };
    for (size_t at = 0; at < chunk->packed_size; at += STEP) {
        size_t left = chunk->packed_size - at, part = left < STEP ? left : STEP;
        if ((at && !ki_may_go_on(&work->asker)) ||
            !ki_file_read_at(&r->input->file, chunk->at + at, packed + at, part))
            return false;
    }
    return true;
}

// Reads, decompresses and writes one chunk to the rows of `picture`.
static kiln_result put_chunk(const exr_rows *r, ki_exr_workspace *work, int index,
                             const ki_exr_picture *picture, kiln_error *error)
{
    const ki_exr_file *f = r->file;
    const ki_exr_chunk *chunk = &f->chunks[index];
    ki_row_pool *pool = &r->input->pool;
    size_t bytes;
    bool fits = ki_mul_size(chunk->size, 2, &bytes) && bytes <= SIZE_MAX - chunk->packed_size;
    ki_buffer buffer = ki_row_pool_take(pool, fits ? bytes + chunk->packed_size : SIZE_MAX);
    if (!buffer.memory)
        return ki_exr_fail_chunk(f, index, KILN_ERROR_MEMORY, error);
    uint8_t *raw = buffer.memory, *packed = raw + 2 * chunk->size;
    kiln_result result = KILN_OK;
    if (!read_packed(r, work, chunk, packed)) {
        if (ki_was_stopped(&work->asker))
            result = ki_fail_cancelled(error, "reading");
        else
            result = ki_fail(error, KILN_ERROR_IO, "%s: cannot be read at byte %llu", f->name,
                             (unsigned long long)chunk->at);
    } else {
        ki_exr_chunk held = *chunk;
        held.packed = packed;
        work->scratch = raw + chunk->size;
        const uint8_t *samples =
            ki_exr_chunk_samples(work, f->part->compression, &held, raw, &result);
        if (samples)
            result = ki_exr_put_box(work, picture, &chunk->box, samples);
        if (result != KILN_OK)
            result = ki_exr_fail_chunk(f, index, result, error);
    }
    ki_row_pool_give(pool, buffer);
    return result;
}

static kiln_result decode(const void *state, int first, int count, float *rgb, kiln_error *error)
{
    const exr_rows *r = state;
    const ki_exr_window *data = &r->file->part->data;
    ki_exr_picture picture = r->file->picture;
    picture.top += first;
    picture.height = count;
    picture.pixels = rgb;
    if (r->is_cropped)
        memset(rgb, 0, 3 * (size_t)picture.width * (size_t)count * sizeof *rgb);
    int64_t top = (int64_t)picture.top - data->top, bottom = top + count;
    int64_t rows = (int64_t)data->bottom - data->top + 1;
    int from = top > 0 ? (int)(top / r->chunk_height) : 0;
    int to = bottom <= 0
                 ? 0
                 : (int)(((bottom < rows ? bottom : rows) + r->chunk_height - 1) / r->chunk_height);
    kiln_result result = KILN_OK;
    ki_exr_workspace work = {r->file->context, r->file->asker, NULL, r->file->dwa_table, 0};
    for (int i = from * r->across; i < to * r->across && result == KILN_OK; i++)
        result = put_chunk(r, &work, i, &picture, error);
    return result;
}

// ----------------------------------------------------------------------------------- opening

static void close_rows(void *state)
{
    exr_rows *r = state;
    if (r->file)
        ki_exr_close(r->file);
    ki_free(r->head);
    ki_free(r);
}

// Returns whether the picture that was chosen is a panorama that can be decoded by rows. Chroma
// needs the rows around each row, and OpenEXR's environment maps have their texels between those of
// a panorama.
static bool is_suitable(const exr_rows *r, kiln_file_info *info)
{
    const ki_exr_file *f = r->file;
    ki_exr_kind kind = f->layer.kind;
    if (!f->chosen || kind == KI_EXR_CHROMA || f->picture.width != 2 * (int64_t)f->picture.height)
        return false;
    ki_file_info_clear(info, (size_t)r->input->file.size);
    ki_exr_describe(f, info);
    bool stated = info->layout[0] && r->input->any_layout;
    return !stated && !ki_is_atlas(info) && f->picture.height <= KILN_MAX_SIZE / 2;
}

// Reads the first `size` bytes of the file and finds the picture's chunks from them. Returns
// KILN_ERROR_FORMAT if the bytes are too few or the file is damaged.
static kiln_result read_head(exr_rows *r, size_t size, kiln_error *error)
{
    kiln_context *context = r->input->context;
    if (r->file)
        ki_exr_close(r->file);
    ki_free(r->head);
    r->head = ki_alloc_raw(context, size, 1);
    r->file = ki_alloc(context, 1, sizeof *r->file);
    if (!r->head || !r->file)
        return ki_fail_memory(context, error, r->input->name, size);
    ki_exr_file *f = r->file;
    f->context = context;
    f->name = r->input->name;
    f->asker = ki_asker_make(context);
    if (!ki_file_read_at(&r->input->file, 0, r->head, size))
        return KILN_ERROR_FORMAT;
    kiln_result result = ki_exr_open(f, r->head, size, r->input->layer, false, error);
    f->header.size = r->input->file.size;
    f->header.file = &r->input->file;
    if (result == KILN_OK)
        result = ki_exr_find_chunks(context, &f->header, f->layer.part, f->name, &f->chunks,
                                    &f->chunk_count, error);
    return result;
}

// Completes a reader whose chunks were found. Returns false if the picture cannot be decoded by
// rows.
static bool prepare(exr_rows *r, ki_row_decoder *decoder, kiln_load_report *report,
                    kiln_file_info *info, kiln_error *error)
{
    ki_exr_file *f = r->file;
    size_t common = ki_exr_common(f);
    size_t pixels = (size_t)f->picture.width * (size_t)f->picture.height;
    if (!is_suitable(r, info) || ki_exr_check_common(f, common, error) != KILN_OK ||
        ki_exr_read_color(f->part, f->name, &f->color, error) != KILN_OK ||
        ki_exr_prepare(f, error) != KILN_OK)
        return false;
    r->is_cropped = common < pixels;
    r->chunk_height = ki_exr_chunk_height(f->part);
    int down = (int)(((int64_t)f->part->data.bottom - f->part->data.top + r->chunk_height) /
                     r->chunk_height);
    r->across = f->chunk_count / down;
    ki_exr_note_all(f, report);
    report->missing_count = pixels - common;
    *decoder = (ki_row_decoder){
        .state = r,
        .decode = decode,
        .close = close_rows,
        .size = f->picture.height,
        .block = r->chunk_height,
        .phase = (int)(((int64_t)f->part->data.top - f->picture.top) % r->chunk_height),
        .converts = ki_exr_converts(f),
        .matrix = f->color.matrix};
    return true;
}

kiln_result ki_exr_rows_open(ki_row_input *input, ki_row_decoder *decoder, kiln_load_report *report,
                             kiln_error *error)
{
    enum { LEAST = 1 << 16, MOST = 1 << 24 };
    exr_rows *r = ki_alloc(input->context, 1, sizeof *r);
    kiln_file_info *info = ki_alloc(input->context, 1, sizeof *info);
    kiln_result result = KILN_ERROR_FORMAT;
    if (!r || !info) {
        ki_free(r);
        ki_free(info);
        return ki_fail_memory(input->context, error, input->name, sizeof *info);
    }
    r->input = input;
    for (size_t size = LEAST; size <= MOST && result == KILN_ERROR_FORMAT; size *= 16) {
        bool all = input->file.size <= size;
        result = read_head(r, all ? (size_t)input->file.size : size, error);
        if (all)
            break;
    }
    bool good = result == KILN_OK && prepare(r, decoder, report, info, error);
    ki_free(info);
    if (!good)
        close_rows(r);
    return result == KILN_ERROR_MEMORY || result == KILN_ERROR_CANCELLED ? result : KILN_OK;
}

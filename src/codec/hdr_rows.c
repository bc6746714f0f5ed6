// Rows of a Radiance HDR file. In: an open file whose picture is a panorama with its lines from
// left to right or right to left. Out: any rows of the picture. Method: one pass over the file, a
// few megabytes at a time, finds where each line begins; each call then reads the bytes of its
// lines.
#include "codec/hdr.h"
#include "codec/row_file.h"

#include <string.h>

typedef struct hdr_rows {
    ki_row_input *input;
    ki_hdr_file file;
    ki_buffer window; // the bytes that are held while lines are found
} hdr_rows;

// Returns the number of bytes of the longest line, unless a line holds runs of no texels.
static size_t longest_line(const ki_hdr_file *f)
{
    return 16 + 8 * (size_t)f->head.line_length;
}

static bool advance(ki_hdr_file *f, uint64_t start)
{
    hdr_rows *r = f->user;
    uint64_t left = f->size - start, end = f->first + f->held;
    if (start >= f->first && end >= start && (end - start >= longest_line(f) || end == f->size))
        return true;
    f->first = start;
    f->held = left < r->window.size ? (size_t)left : r->window.size;
    return ki_file_read_at(&r->input->file, start, r->window.memory, f->held);
}

static kiln_result decode(const void *state, int first, int count, float *rgb, kiln_error *error)
{
    const hdr_rows *r = state;
    ki_hdr_file f = r->file;
    const ki_hdr_header *h = &f.head;
    int line = h->flip_order ? h->line_count - first - count : first;
    size_t texels = 4 * (size_t)h->line_length;
    f.first = f.line_start[line];
    f.held = (size_t)(f.line_start[line + count] - f.first);
    ki_buffer buffer = ki_row_pool_take(&r->input->pool, texels + f.held);
    if (!buffer.memory)
        return ki_fail_memory(f.context, error, f.name, texels + f.held);
    uint8_t *bytes = (uint8_t *)buffer.memory + texels;
    kiln_result result = KILN_OK;
    f.bytes = bytes;
    if (!ki_file_read_at(&r->input->file, f.first, bytes, f.held))
        result = ki_fail(error, KILN_ERROR_IO, "%s: cannot be read at byte %llu", f.name,
                         (unsigned long long)f.first);
    for (int i = 0; i < count && result == KILN_OK; i++) {
        int row = h->flip_order ? count - 1 - i : i;
        ki_hdr_decode_line(&f, line + i, buffer.memory, rgb + 3 * (size_t)row * (size_t)h->width,
                           3);
    }
    ki_row_pool_give(&r->input->pool, buffer);
    return result;
}

static void close_rows(void *state)
{
    hdr_rows *r = state;
    ki_free(r->file.line_start);
    ki_buffer_free(&r->window);
    ki_free(r);
}

// Reads the header and finds the lines. Returns KILN_ERROR_FORMAT if the file is damaged or its
// picture is no panorama whose lines are rows.
static kiln_result read_head(hdr_rows *r, kiln_load_report *report, kiln_error *error)
{
    ki_hdr_file *f = &r->file;
    if (!ki_buffer_reserve(f->context, &r->window, 4 << 20, 1))
        return ki_fail_memory(f->context, error, f->name, 4 << 20);
    f->bytes = r->window.memory;
    if (!advance(f, 0))
        return KILN_ERROR_FORMAT;
    ki_reader reader = ki_reader_make(f->bytes, f->held);
    kiln_result result =
        ki_hdr_read_header(f->context, &reader, f->name, &f->head, NULL, report, error);
    const ki_hdr_header *h = &f->head;
    if (result != KILN_OK)
        return result;
    if (h->columns || h->width != 2 * (int64_t)h->height || h->height > KILN_MAX_SIZE / 2)
        return KILN_ERROR_FORMAT;
    uint64_t start = (uint64_t)(reader.at - f->bytes);
    f->line_start = ki_alloc_raw(f->context, (size_t)h->line_count + 1, sizeof *f->line_start);
    if (!f->line_start)
        return ki_fail_memory(f->context, error, f->name,
                              (size_t)h->line_count * sizeof *f->line_start);
    result = ki_hdr_find_lines(f, start, report, error);
    ki_hdr_fill_scales(f);
    return result;
}

kiln_result ki_hdr_rows_open(ki_row_input *input, ki_row_decoder *decoder, kiln_load_report *report,
                             kiln_error *error)
{
    hdr_rows *r = ki_alloc(input->context, 1, sizeof *r);
    if (!r)
        return ki_fail_memory(input->context, error, input->name, sizeof *r);
    r->input = input;
    r->file = (ki_hdr_file){.context = input->context,
                            .name = input->name,
                            .size = input->file.size,
                            .advance = advance,
                            .user = r};
    kiln_result result = read_head(r, report, error);
    ki_buffer_free(&r->window);
    if (result == KILN_OK)
        *decoder = (ki_row_decoder){.state = r,
                                    .decode = decode,
                                    .close = close_rows,
                                    .size = r->file.head.height,
                                    .block = 1,
                                    .converts = r->file.head.converts,
                                    .matrix = r->file.head.to_rec709};
    else
        close_rows(r);
    return result == KILN_ERROR_MEMORY || result == KILN_ERROR_CANCELLED ? result : KILN_OK;
}

// Reading of Radiance HDR files (RGBE and XYZE). In: the bytes of a file, flat or run-length
// encoded in the old or the new way, in any of the eight orientations. Out: RGB floats in Rec. 709,
// rows from top to bottom. Lines are found first and then decoded on all threads.
//
// A value is mantissa / 256 * 2^(exponent - 128), divided by the products of the header's lines
// EXPOSURE and COLORCORR, which gives the original radiance, and converted to Rec. 709 if the
// header names other primaries or CIE XYZ.
#include "codec/hdr.h"

#include "codec/codec.h"
#include "codec/report.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// ------------------------------------------------------------------------------------------ lines

static bool has_new_runs(const ki_hdr_file *f, const uint8_t *at, size_t left)
{
    int length = f->head.line_length;
    bool allowed = f->coding == KI_HDR_BY_START
                       ? length >= KI_HDR_RUNS_LEAST && length <= KI_HDR_RUNS_MOST
                       : f->coding == KI_HDR_NEW_RUNS;
    return allowed && left >= 4 && at[0] == 2 && at[1] == 2 && (at[2] << 8 | at[3]) == length;
}

// Decodes a line with run-lengths of the new kind, or only finds its end if `texels` is NULL. The
// line's `line_length` texels become four bytes each. Returns the number of bytes read, 0 if the
// data are damaged.
static size_t read_new_runs(const ki_hdr_file *f, const uint8_t *at, size_t left, uint8_t *texels)
{
    size_t in = 4;
    for (int c = 0; c < 4; c++) {
        for (int x = 0; x < f->head.line_length;) {
            if (left - in < 2)
                return 0;
            int code = at[in++];
            int count = code > 128 ? code - 128 : code;
            if (count == 0 || count > f->head.line_length - x ||
                (code <= 128 && left - in < (size_t)count))
                return 0;
            for (int i = 0; texels && i < count; i++)
                texels[4 * (x + i) + c] = at[in + (size_t)(code > 128 ? 0 : i)];
            in += code > 128 ? 1 : (size_t)count;
            x += count;
        }
    }
    return in;
}

// Decodes a line with run-lengths of the old kind, four bytes for each texel. A texel (1, 1, 1, n)
// repeats the previous texel n times. If several such texels follow one another, the second counts
// n * 256 times, the third n * 65536 times, and so on.
static size_t read_old_runs(const ki_hdr_file *f, const uint8_t *at, size_t left, uint8_t *texels)
{
    size_t in = 0;
    int shift = 0;
    for (int x = 0; x < f->head.line_length;) {
        if (left - in < 4)
            return 0;
        const uint8_t *t = at + in;
        in += 4;
        if (t[0] != 1 || t[1] != 1 || t[2] != 1) {
            if (texels)
                memcpy(texels + 4 * (size_t)x, t, 4);
            x++;
            shift = 0;
            continue;
        }
        int64_t count = shift < 24 ? (int64_t)t[3] << shift : INT32_MAX;
        if (x == 0 || count > f->head.line_length - x)
            return 0;
        for (int i = 0; texels && i < count; i++)
            memcpy(texels + 4 * (size_t)(x + i), texels + 4 * (size_t)(x - 1), 4);
        x += (int)count;
        shift += 8;
    }
    return in;
}

static size_t read_flat(const ki_hdr_file *f, const uint8_t *at, size_t left, uint8_t *texels)
{
    size_t size = 4 * (size_t)f->head.line_length;
    if (left < size)
        return 0;
    if (texels)
        memcpy(texels, at, size);
    return size;
}

// Decodes the line that begins at byte `start` of the file, or only finds its end if `texels` is
// NULL. Returns the number of bytes read, 0 if the data are damaged or the held bytes end before.
static size_t read_line(const ki_hdr_file *f, uint64_t start, uint8_t *texels)
{
    if (start < f->first || start - f->first > f->held)
        return 0;
    const uint8_t *at = f->bytes + (size_t)(start - f->first);
    size_t left = f->held - (size_t)(start - f->first);
    if (has_new_runs(f, at, left))
        return read_new_runs(f, at, left, texels);
    return f->coding == KI_HDR_FLAT       ? read_flat(f, at, left, texels)
           : f->coding == KI_HDR_BY_START ? read_old_runs(f, at, left, texels)
                                          : 0;
}

// Finds where each line begins if the lines are encoded by `coding`, and sets *end to where the
// last line ends. `start` is where line 0 begins.
static kiln_result find_lines(ki_hdr_file *f, ki_hdr_coding coding, uint64_t start, uint64_t *end,
                              kiln_error *error)
{
    f->coding = coding;
    for (int y = 0; y < f->head.line_count; y++) {
        if (y % 64 == 0 && !ki_go_on(f->context))
            return ki_fail_cancelled(error, "reading");
        f->line_start[y] = start;
        if (f->advance && !f->advance(f, start))
            return KILN_ERROR_IO;
        size_t taken = read_line(f, start, NULL);
        if (!taken)
            return ki_fail(error, KILN_ERROR_FORMAT, "%s: line %d of %d is damaged, at byte %llu",
                           f->name, y, f->head.line_count, (unsigned long long)start);
        start += taken;
    }
    f->line_start[f->head.line_count] = *end = start;
    return KILN_OK;
}

// Radiance's rules are tried first. If the lines then do not end where the file ends, the file may
// be flat with texels that look like run-lengths, or have run-lengths of the new kind in lines of a
// length that does not allow them. One of these encodings is accepted if the lines then end where
// the file ends.
kiln_result ki_hdr_find_lines(ki_hdr_file *f, uint64_t start, kiln_load_report *report,
                              kiln_error *error)
{
    uint64_t end = 0;
    size_t flat = 4 * (size_t)f->head.width * (size_t)f->head.height;
    kiln_result result = find_lines(f, KI_HDR_BY_START, start, &end, error);
    if (result == KILN_ERROR_CANCELLED || (result == KILN_OK && end == f->size))
        return result;
    if (f->size - start == flat) {
        ki_note(report, KILN_NOTE_CHOICE, false,
                "texels that look like run-lengths were read as texels, because the file has the "
                "%zu bytes of a flat picture",
                flat);
        return find_lines(f, KI_HDR_FLAT, start, &end, error);
    }
    result = find_lines(f, KI_HDR_NEW_RUNS, start, &end, error);
    if (result == KILN_ERROR_CANCELLED)
        return result;
    if (result == KILN_OK && end == f->size) {
        ki_note(report, KILN_NOTE_CHOICE, false,
                "lines of %d texels were read as run-lengths, which lines of %d to %d texels have",
                f->head.line_length, KI_HDR_RUNS_LEAST, KI_HDR_RUNS_MOST);
        return KILN_OK;
    }
    return find_lines(f, KI_HDR_BY_START, start, &end, error);
}

// ----------------------------------------------------------------------------------------- texels

void ki_hdr_decode_line(const ki_hdr_file *f, int index, uint8_t *texels, float *to, ptrdiff_t step)
{
    const ki_hdr_header *h = &f->head;
    memset(texels, 0, 4 * (size_t)h->line_length);
    read_line(f, f->line_start[index], texels);
    if (h->flip_line) {
        to += step * (h->line_length - 1);
        step = -step;
    }
    for (int x = 0; x < h->line_length; x++, to += step) {
        const uint8_t *t = texels + 4 * (size_t)x;
        for (int c = 0; c < 3; c++) {
            float value = (float)t[c] * f->scale[c][t[3]];
            to[c] = value < FLT_MAX ? value : FLT_MAX;
        }
    }
}

// Decodes a line to its place in the picture.
static void put_line(const ki_hdr_file *f, int index, uint8_t *texels)
{
    const ki_hdr_header *h = &f->head;
    ptrdiff_t order = h->flip_order ? h->line_count - 1 - index : index;
    ptrdiff_t step = h->columns ? 3 * (ptrdiff_t)h->width : 3;
    ki_hdr_decode_line(f, index, texels,
                       f->pixels + 3 * order * (h->columns ? 1 : (ptrdiff_t)h->width), step);
}

// Task of one thread: decodes a share of the lines. The task has its own memory for the texels of a
// line, because a line of 32767 texels would not fit on the stack of a WebAssembly thread.
static void decode_lines(void *data, int task)
{
    const ki_hdr_file *f = data;
    uint8_t *texels = f->texels + 4 * (size_t)f->head.line_length * (size_t)task;
    int end = (int)((int64_t)f->head.line_count * (task + 1) / f->task_count);
    for (int i = (int)((int64_t)f->head.line_count * task / f->task_count); i < end; i++)
        put_line(f, i, texels);
}

void ki_hdr_fill_scales(ki_hdr_file *f)
{
    for (int c = 0; c < 3; c++)
        for (int e = 1; e < 256; e++) {
            double scale = ldexp(1, e - 136) / f->head.divisor[c];
            f->scale[c][e] = scale < (double)FLT_MAX ? (float)scale : FLT_MAX;
        }
}

static kiln_result decode_all(ki_hdr_file *f, kiln_image *image, kiln_error *error)
{
    enum { TASKS = 64 };
    const ki_hdr_header *h = &f->head;
    size_t count = 3 * (size_t)h->width * (size_t)h->height;
    f->task_count = ki_min(TASKS, h->line_count);
    f->texels = ki_alloc_raw(f->context, (size_t)f->task_count, 4 * (size_t)h->line_length);
    f->pixels = ki_alloc_raw(f->context, count, sizeof(float));
    if (!f->texels || !f->pixels)
        return ki_fail_memory(f->context, error, f->name, count * sizeof(float));
    ki_hdr_fill_scales(f);
    if (!ki_parallel_steps(f->context, NULL, f->task_count, decode_lines, f))
        return ki_fail_cancelled(error, "reading");
    *image = (kiln_image){h->width, h->height, 3, f->pixels, f->pixels};
    f->pixels = NULL;
    if (!h->converts || ki_image_transform(f->context, &h->to_rec709, image))
        return KILN_OK;
    kiln_image_free(image);
    return ki_fail_cancelled(error, "reading");
}

static void describe(const ki_hdr_file *f, size_t start, kiln_file_info *info)
{
    const ki_hdr_header *h = &f->head;
    bool runs = has_new_runs(f, f->bytes + start, f->held - start);
    bool flat = f->size - start == 4 * (size_t)h->width * (size_t)h->height;
    snprintf(info->format, sizeof info->format, "hdr");
    snprintf(info->encoding, sizeof info->encoding, "%s, %s", h->xyz ? "xyze" : "rgbe",
             runs   ? "rle"
             : flat ? "uncompressed"
                    : "old rle");
    info->width = h->width;
    info->height = h->height;
    info->channel_count = 3;
    info->level_count = 1;
}

kiln_result ki_hdr_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, kiln_image *image, kiln_file_info *info,
                          kiln_load_report *report, kiln_error *error)
{
    if (image)
        *image = (kiln_image){0};
    ki_hdr_file f = {.context = context, .name = name, .bytes = bytes, .held = size, .size = size};
    ki_reader r = ki_reader_make(bytes, size);
    kiln_result result = ki_hdr_read_header(context, &r, name, &f.head, info, report, error);
    if (result != KILN_OK)
        return result;
    size_t start = (size_t)(r.at - bytes);
    f.line_start = ki_alloc_raw(context, (size_t)f.head.line_count + 1, sizeof *f.line_start);
    if (!f.line_start)
        return ki_fail_memory(context, error, name,
                              (size_t)f.head.line_count * sizeof *f.line_start);
    result = ki_hdr_find_lines(&f, start, report, error);
    if (info)
        describe(&f, start, info);
    if (result == KILN_OK && image)
        result = decode_all(&f, image, error);
    else if (result == KILN_ERROR_FORMAT && !image)
        // damaged texels do not matter to a caller that asks only for the header's description
        result = KILN_OK;
    ki_free(f.line_start);
    ki_free(f.texels);
    ki_free(f.pixels);
    return result;
}

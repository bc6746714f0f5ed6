// Writing of PNG files. In: floats of one to four channels. Out: a file of 8 or 16 bits, not
// interlaced. Each row gets the filter with the smallest sum of differences, as the specification
// proposes. Rows are compressed in parts of about a quarter of a megabyte, each an IDAT chunk.
#include "codec/codec.h"
#include "codec/components.h"
#include "codec/deflate.h"
#include "codec/png.h"
#include "image/pack.h"

#include <string.h>

enum { PART = 1 << 18, HISTORY = 1 << 15 };

typedef struct png_writer {
    ki_writer *out;
    ki_crc32_table crc;
    ki_deflater *deflater;
    size_t row, step;  // number of bytes of a row and of a pixel
    uint8_t *above;    // the unfiltered row above `current`; zeros for the first row
    uint8_t *current;  // the unfiltered row that is filtered next
    uint8_t *filtered; // the current row after each of the five filters, one after the other
    // Filtered rows: `history` bytes that were already compressed, then `waiting` bytes that are
    // not.
    uint8_t *rows;
    size_t history, waiting;
    int place; // KI_DEFLATE_FIRST until the first part is compressed, then 0
} png_writer;

// ------------------------------------------------------------------------------------------ chunks

static void write_u32_high_first(ki_writer *w, uint32_t value)
{
    ki_write_u32(w, __builtin_bswap32(value));
}

// Begins a chunk and returns the position of its data; end_chunk writes its size and CRC.
static size_t begin_chunk(ki_writer *w, const char *type)
{
    ki_write_u32(w, 0);
    ki_write(w, type, 4);
    return w->size;
}

static void end_chunk(png_writer *p, size_t start)
{
    ki_writer *w = p->out;
    if (w->failed)
        return;
    size_t size = w->size - start;
    ki_patch_u32(w, start - 8, __builtin_bswap32((uint32_t)size));
    write_u32_high_first(w, ki_crc32(&p->crc, 0, w->bytes + start - 4, size + 4));
}

static void write_head(png_writer *p, int width, int height, int channels, ki_png_coding coding)
{
    static const uint8_t colors[4] = {0, KI_PNG_ALPHA, KI_PNG_COLOR, KI_PNG_COLOR | KI_PNG_ALPHA};
    ki_write(p->out, "\x89PNG\r\n\x1a\n", 8);
    size_t start = begin_chunk(p->out, "IHDR");
    write_u32_high_first(p->out, (uint32_t)width);
    write_u32_high_first(p->out, (uint32_t)height);
    ki_write_u8(p->out, coding == KI_PNG_PLAIN16 ? 16 : 8);
    ki_write_u8(p->out, colors[channels - 1]);
    // the fields compression, filters and interlacing are 0: deflate, the five filters, and none
    ki_write(p->out, "\0\0", 3);
    end_chunk(p, start);
    if (coding == KI_PNG_SRGB8) {
        start = begin_chunk(p->out, "sRGB");
        ki_write_u8(p->out, 1); // the rendering intent is "relative colorimetric"
        end_chunk(p, start);
    }
}

// Compresses the waiting rows as one part, and keeps the last bytes, to which the next part may
// refer.
static void write_part(png_writer *p, bool last)
{
    uint8_t *rows = p->rows + p->history;
    size_t bound = ki_deflate_bound(p->waiting), start = begin_chunk(p->out, "IDAT");
    uint8_t *room = ki_write_room(p->out, bound);
    if (!room) { // the writer has failed, so the waiting rows are dropped
        p->waiting = 0;
        return;
    }
    size_t size = ki_deflate_part(p->deflater, rows, p->history, p->waiting,
                                  p->place | (last ? KI_DEFLATE_LAST : 0), room, bound);
    p->out->size -= bound - size;
    end_chunk(p, start);
    p->place = 0;
    size_t known = p->history + p->waiting;
    p->history = known < HISTORY ? known : HISTORY;
    memmove(p->rows, p->rows + known - p->history, p->history);
    p->waiting = 0;
}

// ----------------------------------------------------------------------------------------- filters

static void filter_row(const png_writer *p, ki_png_filter filter, uint8_t *restrict to)
{
    const uint8_t *row = p->current, *above = p->above;
    size_t step = p->step;
    for (size_t i = 0; i < p->row && i < step; i++) {
        int up = filter < KI_PNG_UP ? 0 : filter == KI_PNG_AVERAGE ? above[i] / 2 : above[i];
        to[i] = (uint8_t)(row[i] - up);
    }
    size_t i = step;
    switch (filter) {
    case KI_PNG_SUB:
        for (; i < p->row; i++)
            to[i] = (uint8_t)(row[i] - row[i - step]);
        break;
    case KI_PNG_UP:
        for (; i < p->row; i++)
            to[i] = (uint8_t)(row[i] - above[i]);
        break;
    case KI_PNG_AVERAGE:
        for (; i < p->row; i++)
            to[i] = (uint8_t)(row[i] - (row[i - step] + above[i]) / 2);
        break;
    case KI_PNG_PAETH:
        for (; i < p->row; i++)
            to[i] = (uint8_t)(row[i] - ki_png_paeth(row[i - step], above[i], above[i - step]));
        break;
    default:
        for (; i < p->row; i++)
            to[i] = row[i];
        break;
    }
}

// Sums the absolute values of a filtered row's bytes, read as numbers from -128 to 127. The filter
// with the smallest sum is taken to compress best.
static uint32_t sum_of(const uint8_t *bytes, size_t size)
{
    uint32_t sum = 0;
    for (size_t i = 0; i < size; i++)
        sum += bytes[i] < 128 ? bytes[i] : 256U - bytes[i];
    return sum;
}

// Adds the row in `current`, filtered by its best filter, to the waiting rows. `current` becomes
// the row above the next row.
static void add_row(png_writer *p)
{
    int best = 0;
    uint32_t least = UINT32_MAX;
    for (int f = 0; f < KI_PNG_FILTERS; f++) {
        uint8_t *to = p->filtered + (size_t)f * p->row;
        filter_row(p, (ki_png_filter)f, to);
        uint32_t sum = sum_of(to, p->row);
        best = sum < least ? f : best;
        least = sum < least ? sum : least;
    }
    uint8_t *to = p->rows + p->history + p->waiting;
    *to = (uint8_t)best;
    memcpy(to + 1, p->filtered + (size_t)best * p->row, p->row);
    p->waiting += p->row + 1;
    uint8_t *above = p->above;
    p->above = p->current;
    p->current = above;
}

// ----------------------------------------------------------------------------------------- samples

// Sets the rounding thresholds of 8-bit sRGB: a linear value of at least thresholds[k] is nearer to
// k + 1 than to k.
static void make_thresholds(float thresholds[255])
{
    for (int i = 0; i < 255; i++)
        thresholds[i] = ki_linear_from_srgb(((float)i + 0.5f) / 255);
}

static uint8_t to_byte(float value, const float *thresholds)
{
    if (!(value > 0))
        return 0;
    if (value >= 1)
        return 255;
    if (!thresholds)
        return (uint8_t)(value * 255 + 0.5f);
    int low = 0, high = 255; // bounds of the number of thresholds that the value reaches
    while (low < high) {
        int middle = (low + high) / 2;
        if (value >= thresholds[middle])
            low = middle + 1;
        else
            high = middle;
    }
    return (uint8_t)low;
}

// Converts one row of `count` values to the bytes of a PNG row. 16-bit values are stored with the
// high byte first.
static void to_row(const float *values, size_t count, ki_png_coding coding, const float *thresholds,
                   uint8_t *row)
{
    for (size_t i = 0; i < count; i++) {
        if (coding != KI_PNG_PLAIN16) {
            row[i] = to_byte(values[i], coding == KI_PNG_SRGB8 ? thresholds : NULL);
            continue;
        }
        uint8_t low_first[2];
        ki_components_pack(KILN_TABLE_FORMAT_U16, values + i, 1, 1, 1, low_first);
        row[2 * i] = low_first[1];
        row[2 * i + 1] = low_first[0];
    }
}

static kiln_result write_rows(png_writer *p, const float *pixels, int height, size_t count,
                              ki_png_coding coding, kiln_error *error)
{
    float thresholds[255];
    make_thresholds(thresholds);
    for (int y = 0; y < height; y++) {
        if (y % 16 == 0 && !ki_go_on(p->out->context))
            return ki_fail_cancelled(error, "writing");
        if (p->waiting && p->waiting + p->row + 1 > PART)
            write_part(p, false);
        to_row(pixels + (size_t)y * count, count, coding, thresholds, p->current);
        add_row(p);
    }
    write_part(p, true);
    return KILN_OK;
}

kiln_result ki_png_encode(const float *pixels, int width, int height, int channels,
                          ki_png_coding coding, ki_writer *writer, kiln_error *error)
{
    size_t count = (size_t)width * (size_t)channels, bytes = coding == KI_PNG_PLAIN16 ? 2 : 1;
    png_writer p = {.out = writer,
                    .row = count * bytes,
                    .step = (size_t)channels * bytes,
                    .place = KI_DEFLATE_FIRST};
    ki_crc32_fill(&p.crc);
    p.deflater = ki_deflater_create(writer->context);
    size_t part = p.row + 1 > PART ? p.row + 1 : PART;
    uint8_t *memory = ki_alloc(writer->context, p.row, 2 + KI_PNG_FILTERS);
    p.rows = ki_alloc_raw(writer->context, HISTORY + part, 1);
    kiln_result result = KILN_OK;
    if (p.deflater && memory && p.rows) {
        p.above = memory;
        p.current = memory + p.row;
        p.filtered = memory + 2 * p.row;
        write_head(&p, width, height, channels, coding);
        result = write_rows(&p, pixels, height, count, coding, error);
        end_chunk(&p, begin_chunk(writer, "IEND"));
    }
    if (!p.deflater || !memory || !p.rows || writer->failed)
        result = ki_fail_memory(writer->context, error, "a PNG", p.row * (2 + KI_PNG_FILTERS));
    ki_deflater_free(p.deflater);
    ki_free(memory);
    ki_free(p.rows);
    return result;
}

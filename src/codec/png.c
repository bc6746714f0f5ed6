// Reading of PNG files. In: the bytes of a file. Out: a picture of three linear floats a pixel.
// Every colour type, depth and filter is read, interlaced or not, by the specification (W3C,
// "Portable Network Graphics", third edition). png_color.c finds what the samples mean. Alpha and
// tRNS are ignored.
//
// kiln has its own PNG code so that kiln can be built without libpng and writes the same bytes on
// every system. The tests compare the code with libpng, oiiotool and a browser.
//
// The IDAT chunks are joined and decompressed at once, the filters of the rows are undone in place,
// and a table for each channel gives the linear value of every sample. Sizes are checked against
// the file's before memory is allocated.
#include "codec/png.h"
#include "codec/codec.h"
#include "codec/deflate.h"
#include "codec/png_color.h"
#include "codec/report.h"
#include "codec/rgbx_png.h"
#include "codec/upright.h"

#include <stdio.h>
#include <string.h>

// A picture, or one of the seven passes of an interlaced picture: the pixels from (x, y) on, every
// x_step-th column and every y_step-th row.
typedef struct pass {
    int x, y, x_step, y_step;
    size_t width, height, row; // size in pixels, and bytes of a row without its filter byte
} pass;

enum { PASSES = 7 };

typedef struct png_file {
    kiln_context *context;
    const char *name;
    ki_asker asker;
    ki_reader reader;
    ki_crc32_table crc;
    int width, height, depth, color, channels;
    bool interlaced, has_palette;
    uint8_t palette[256][3];
    pass passes[PASSES];
    int pass_count;
    const uint8_t *packed; // content of all IDAT chunks, joined
    uint8_t *joined;       // memory of the joined content if there are several IDAT chunks
    size_t packed_size;
    uint64_t raw_size; // number of bytes that the IDAT data must decompress to
    uint8_t *raw;
    ki_png_meaning meaning;
    ki_from_rgbx *forced; // what the samples mean, whatever the file says; NULL for what it says
    // table[c]: the linear value of every possible sample of channel c; pixels: the picture, three
    // floats a pixel
    float *table[3], *pixels;
} png_file;

// Fails because the file is damaged, or because the caller has stopped the reading.
static kiln_result damaged(const png_file *f, kiln_error *error, const char *what)
{
    if (ki_was_stopped(&f->asker))
        return ki_fail_cancelled(error, "reading");
    return ki_fail(error, KILN_ERROR_FORMAT, "%s: the PNG is damaged: %s", f->name, what);
}

// ------------------------------------------------------------------------------------------ chunks

static uint32_t read_u32_high_first(ki_reader *r)
{
    return __builtin_bswap32(ki_read_u32(r));
}

typedef struct chunk {
    char type[5];
    const uint8_t *bytes;
    size_t size;
    bool intact; // true: the chunk's CRC is right
} chunk;

// Reads the next chunk. Returns false where the file ends, or if the caller wants to stop.
static bool next_chunk(png_file *f, chunk *c)
{
    ki_reader *r = &f->reader;
    *c = (chunk){.size = read_u32_high_first(r)};
    const uint8_t *type = ki_read_bytes(r, 4);
    c->bytes = ki_read_bytes(r, c->size);
    uint32_t sum = read_u32_high_first(r);
    if (r->failed)
        return false;
    memcpy(c->type, type, 4);
    c->intact = ki_checksum_agrees(ki_crc32_long(&f->asker, &f->crc, type, c->size + 4), sum);
    return !ki_was_stopped(&f->asker);
}

static bool is(const chunk *c, const char *type)
{
    return !memcmp(c->type, type, 4);
}

static bool good_depth(int color, int depth)
{
    bool whole = depth == 8 || depth == 16;
    switch (color) {
    case 0:
        return whole || depth == 1 || depth == 2 || depth == 4;
    case KI_PNG_COLOR | KI_PNG_PALETTE:
        return depth == 1 || depth == 2 || depth == 4 || depth == 8;
    case KI_PNG_COLOR:
    case KI_PNG_ALPHA:
    case KI_PNG_COLOR | KI_PNG_ALPHA:
        return whole;
    default:
        return false;
    }
}

static kiln_result read_head(png_file *f, kiln_error *error)
{
    chunk c;
    if (!ki_read_bytes(&f->reader, 8) || !next_chunk(f, &c))
        return damaged(f, error, "the file ends too early");
    if (!is(&c, "IHDR") || c.size != 13 || !c.intact)
        return damaged(f, error, "its first chunk is not an IHDR of 13 bytes with a correct CRC");
    ki_reader r = ki_reader_make(c.bytes, c.size);
    uint32_t width = read_u32_high_first(&r), height = read_u32_high_first(&r);
    f->depth = ki_read_u8(&r);
    f->color = ki_read_u8(&r);
    int compression = ki_read_u8(&r), filter = ki_read_u8(&r), interlace = ki_read_u8(&r);
    if (!width || !height || !good_depth(f->color, f->depth) || compression || filter ||
        interlace > 1)
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: the PNG is damaged: %u x %u pixels of %d bits, colour type %d, "
                       "compression %d, filters %d, interlacing %d",
                       f->name, width, height, f->depth, f->color, compression, filter, interlace);
    if (width > KILN_MAX_SIZE || height > KILN_MAX_SIZE)
        return ki_fail(error, KILN_ERROR_UNSUPPORTED, "%s: the picture is %u x %u, the limit is %d",
                       f->name, width, height, KILN_MAX_SIZE);
    f->width = (int)width;
    f->height = (int)height;
    f->interlaced = interlace;
    bool three = f->color == KI_PNG_COLOR || f->color == (KI_PNG_COLOR | KI_PNG_ALPHA);
    f->channels = (three ? 3 : 1) + (f->color & KI_PNG_ALPHA ? 1 : 0);
    return KILN_OK;
}

// Reads the palette. Entries that the file lacks are black.
static bool read_palette(png_file *f, const chunk *c)
{
    if (!(f->color & KI_PNG_PALETTE))
        return true;
    size_t most = (size_t)3 << f->depth;
    if (f->has_palette || !c->size || c->size % 3 || c->size > sizeof f->palette)
        return false;
    f->has_palette = true;
    memcpy(f->palette, c->bytes, c->size < most ? c->size : most);
    return true;
}

// Joins the data of consecutive IDAT chunks, of which `c` is the first.
static kiln_result join_data(png_file *f, chunk *c, kiln_error *error)
{
    ki_reader first = f->reader;
    f->packed = c->bytes;
    chunk next = *c;
    int count = 0;
    for (bool more = true; more && is(&next, "IDAT"); more = next_chunk(f, &next)) {
        if (!next.intact)
            return damaged(f, error, "the CRC of a chunk is wrong");
        f->packed_size += next.size;
        count++;
    }
    if (ki_was_stopped(&f->asker))
        return ki_fail_cancelled(error, "reading");
    if (count == 1)
        return KILN_OK;
    f->joined = ki_alloc_raw(f->context, f->packed_size + 1, 1);
    if (!f->joined)
        return ki_fail_memory(f->context, error, f->name, f->packed_size);
    f->packed = f->joined;
    size_t at = 0;
    f->reader = first;
    for (next = *c; count > 0 && next.bytes; count--) {
        if (!ki_may_go_on(&f->asker))
            return ki_fail_cancelled(error, "reading");
        memcpy(f->joined + at, next.bytes, next.size);
        at += next.size;
        if (count > 1 && !next_chunk(f, &next))
            return ki_fail_cancelled(error, "reading");
    }
    return KILN_OK;
}

// Reads all chunks up to the last IDAT chunk.
static kiln_result read_chunks(png_file *f, kiln_error *error)
{
    chunk c;
    for (;;) {
        if (!next_chunk(f, &c))
            return damaged(f, error, "the file ends too early");
        // a capital first letter marks a critical chunk, which a reader must understand
        bool critical = !(c.type[0] & 32);
        if (!critical)
            continue;
        if (!c.intact)
            return damaged(f, error, "the CRC of a chunk is wrong");
        if (is(&c, "IDAT"))
            break;
        if (!is(&c, "PLTE") || !read_palette(f, &c))
            return damaged(f, error,
                           is(&c, "PLTE")   ? "its palette has a wrong size"
                           : is(&c, "IEND") ? "it has no chunk IDAT"
                                            : "it has a critical chunk that PNG does not define");
    }
    if (f->color & KI_PNG_PALETTE && !f->has_palette)
        return damaged(f, error, "its palette is missing");
    return join_data(f, &c, error);
}

// ------------------------------------------------------------------------------------------ passes

static size_t steps(int size, int from, int step)
{
    return size > from ? (size_t)((size - from + step - 1) / step) : 0;
}

static void add_pass(png_file *f, int x, int y, int x_step, int y_step)
{
    pass p = {x, y, x_step, y_step, steps(f->width, x, x_step), steps(f->height, y, y_step), 0};
    if (!p.width || !p.height)
        return;
    p.row = (p.width * (size_t)(f->channels * f->depth) + 7) / 8;
    f->passes[f->pass_count++] = p;
    f->raw_size += (uint64_t)p.height * (p.row + 1);
}

static void find_passes(png_file *f)
{
    if (!f->interlaced) {
        add_pass(f, 0, 0, 1, 1);
        return;
    }
    // Passes of Adam7, as first column, first row, column step and row step. The first pass has one
    // of the 64 pixels of each 8 x 8 square, the last pass every second row.
    static const uint8_t from[PASSES][4] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                            {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
    for (int i = 0; i < PASSES; i++)
        add_pass(f, from[i][0], from[i][1], from[i][2], from[i][3]);
}

// ----------------------------------------------------------------------------------------- filters

// Undo the filters Sub, Up, Average and Paeth of a row of `size` bytes with `step` bytes a pixel.
// With a constant step the compiler keeps the bytes of a pixel in separate registers.
static inline void undo_sub(uint8_t *row, size_t size, size_t step)
{
    for (size_t i = step; i < size; i++)
        row[i] = (uint8_t)(row[i] + row[i - step]);
}

static void undo_up(uint8_t *restrict row, const uint8_t *restrict above, size_t size)
{
    for (size_t i = 0; i < size; i++)
        row[i] = (uint8_t)(row[i] + above[i]);
}

static inline void undo_average(uint8_t *restrict row, const uint8_t *restrict above, size_t size,
                                size_t step)
{
    for (size_t i = 0; i < step && i < size; i++)
        row[i] = (uint8_t)(row[i] + above[i] / 2);
    for (size_t i = step; i < size; i++)
        row[i] = (uint8_t)(row[i] + (row[i - step] + above[i]) / 2);
}

static inline void undo_paeth(uint8_t *restrict row, const uint8_t *restrict above, size_t size,
                              size_t step)
{
    for (size_t i = 0; i < step && i < size; i++)
        row[i] = (uint8_t)(row[i] + above[i]);
    for (size_t i = step; i < size; i++)
        row[i] = (uint8_t)(row[i] + ki_png_paeth(row[i - step], above[i], above[i - step]));
}

static inline bool undo_filter(int filter, uint8_t *row, const uint8_t *above, size_t size,
                               size_t step)
{
    if (filter == KI_PNG_SUB)
        undo_sub(row, size, step);
    else if (filter == KI_PNG_UP)
        undo_up(row, above, size);
    else if (filter == KI_PNG_AVERAGE)
        undo_average(row, above, size, step);
    else if (filter == KI_PNG_PAETH)
        undo_paeth(row, above, size, step);
    return filter < KI_PNG_FILTERS;
}

enum { ROUND = 1 << 22 }; // number of pixels between two reports of progress

// Undoes the filters of all rows of a pass, each of which follows its filter byte. `zeros` is a row
// of zeros that stands for the row above the first.
static kiln_result undo_filters(const png_file *f, uint8_t *raw, const pass *p, size_t step,
                                const uint8_t *zeros, kiln_error *error)
{
    const uint8_t *above = zeros;
    bool good = true;
    size_t rows = 1 + ROUND / p->width;
    for (size_t y = 0; good && y < p->height; y++, raw += p->row + 1) {
        if (y % rows == rows - 1 && !ki_go_on(f->context))
            return ki_fail_cancelled(error, "reading");
        if (step == 3)
            good = undo_filter(raw[0], raw + 1, above, p->row, 3);
        else if (step == 4)
            good = undo_filter(raw[0], raw + 1, above, p->row, 4);
        else
            good = undo_filter(raw[0], raw + 1, above, p->row, step);
        above = raw + 1;
    }
    return good ? KILN_OK : damaged(f, error, "a row has a filter that PNG does not define");
}

// ------------------------------------------------------------------------------------------ pixels

// Fills the tables with the linear value of every possible sample. The first table owns the memory
// of the three.
static bool make_tables(png_file *f)
{
    int count = f->color & KI_PNG_PALETTE ? 256 : 1 << f->depth;
    f->table[0] = ki_alloc_raw(f->context, 3 * (size_t)count, sizeof(float));
    for (int c = 0; f->table[0] && c < 3; c++) {
        f->table[c] = f->table[0] + (size_t)c * (size_t)count;
        ki_file_color_fill(&f->meaning.color, c, f->table[c], count);
    }
    return f->table[0] != NULL;
}

// Returns sample i of a row, of `depth` bits, whose samples are stored in each byte from the
// highest bit on.
static inline unsigned sample(const uint8_t *row, size_t i, int depth)
{
    if (depth == 8)
        return row[i];
    if (depth == 16)
        return (unsigned)(row[2 * i] << 8 | row[2 * i + 1]);
    size_t bit = i * (size_t)depth;
    return (unsigned)(row[bit / 8] >> (8 - depth - (int)(bit % 8))) & ((1U << depth) - 1);
}

// Converts a row of a pass to three floats a pixel. The row's pixels are `step` floats apart in the
// picture.
static inline void put_row(const png_file *f, const uint8_t *row, size_t width, int depth,
                           float *rgb, size_t step)
{
    size_t channels = (size_t)f->channels;
    bool grey = channels < 3;
    for (size_t x = 0; x < width; x++, rgb += step) {
        if (f->color & KI_PNG_PALETTE) {
            const uint8_t *entry = f->palette[sample(row, x, depth)];
            for (int c = 0; c < 3; c++)
                rgb[c] = f->table[c][entry[c]];
            continue;
        }
        for (size_t c = 0; c < 3; c++)
            rgb[c] = f->table[c][sample(row, x * channels + (grey ? 0 : c), depth)];
    }
}

// Decodes a row of texels that kiln stored as radiance in four bytes (RGBM, RGBD or RGBP).
static void unpack_row(const png_file *f, const uint8_t *row, size_t width, float *rgb, size_t step)
{
    for (size_t x = 0; x < width; x++, rgb += step, row += 4) {
        const float stored[4] = {(float)row[0] / 255, (float)row[1] / 255, (float)row[2] / 255,
                                 (float)row[3] / 255};
        f->meaning.unpack(stored, rgb);
    }
}

static void put_pass(const png_file *f, const pass *p, const uint8_t *raw, size_t begin, size_t end)
{
    size_t line = 3 * (size_t)f->width;
    for (size_t y = begin; y < end; y++) {
        const uint8_t *row = raw + y * (p->row + 1) + 1;
        float *rgb = f->pixels + ((size_t)p->y + y * (size_t)p->y_step) * line + 3 * (size_t)p->x;
        size_t step = 3 * (size_t)p->x_step;
        if (f->meaning.unpack)
            unpack_row(f, row, p->width, rgb, step);
        else if (f->depth == 8)
            put_row(f, row, p->width, 8, rgb, step);
        else
            put_row(f, row, p->width, f->depth, rgb, step);
    }
}

static kiln_result put_all(png_file *f, kiln_error *error)
{
    const uint8_t *raw = f->raw;
    for (int i = 0; i < f->pass_count; i++) {
        const pass *p = &f->passes[i];
        size_t rows = 1 + ROUND / p->width;
        for (size_t y = 0; y < p->height; y += rows) {
            size_t done = (size_t)(raw - f->raw) + y * (p->row + 1);
            if (!ki_progress(f->context, "reading", (double)done / (double)f->raw_size))
                return ki_fail_cancelled(error, "reading");
            put_pass(f, p, raw, y, p->height - y < rows ? p->height : y + rows);
        }
        raw += p->height * (p->row + 1);
    }
    return KILN_OK;
}

static kiln_result inflate(const png_file *f, kiln_error *error)
{
    kiln_result result =
        ki_inflate_long(&f->asker, f->packed, f->packed_size, f->raw, (size_t)f->raw_size, true);
    if (result == KILN_ERROR_CANCELLED)
        return ki_fail_cancelled(error, "reading");
    return result == KILN_OK ? result
                             : damaged(f, error,
                                       "its data does not inflate to the picture's size or has a "
                                       "wrong Adler-32 sum");
}

static kiln_result unpack(png_file *f, kiln_error *error)
{
    // Deflate makes at most 1032 bytes of one byte, so that a short file cannot ask for memory for
    // a huge picture.
    if (f->raw_size / 1032 > f->packed_size)
        return damaged(f, error, "its data is too short for its size");
    size_t size = (size_t)f->raw_size, step = (size_t)(f->channels * f->depth + 7) / 8;
    f->raw = size == f->raw_size ? ki_alloc_raw(f->context, size, 1) : NULL;
    uint8_t *zeros = ki_alloc(f->context, (size_t)f->width * step, 1);
    kiln_result result =
        f->raw && zeros ? inflate(f, error) : ki_fail_memory(f->context, error, f->name, size);
    uint8_t *raw = f->raw;
    for (int i = 0; result == KILN_OK && i < f->pass_count; i++) {
        result = undo_filters(f, raw, &f->passes[i], step, zeros, error);
        raw += f->passes[i].height * (f->passes[i].row + 1);
    }
    ki_free(zeros);
    return result;
}

static kiln_result read_pixels(png_file *f, kiln_image *image, kiln_error *error)
{
    kiln_result result = read_chunks(f, error);
    if (result != KILN_OK)
        return result;
    find_passes(f);
    result = unpack(f, error);
    if (result != KILN_OK)
        return result;
    size_t texels = (size_t)f->width * (size_t)f->height;
    f->pixels = ki_alloc_raw(f->context, texels * 3, sizeof(float));
    if (!f->pixels || !make_tables(f))
        return ki_fail_memory(f->context, error, f->name, texels * 3 * sizeof(float));
    kiln_image linear = {f->width, f->height, 3, f->pixels, NULL};
    result = put_all(f, error);
    if (result == KILN_OK)
        result = ki_file_color_finish(f->context, &f->meaning.color, &linear, error);
    if (result != KILN_OK)
        return result;
    *image = (kiln_image){f->width, f->height, 3, f->pixels, f->pixels};
    f->pixels = NULL;
    result = ki_turn_upright(f->context, f->meaning.orientation, image, error);
    if (result != KILN_OK)
        kiln_image_free(image);
    return result;
}

static void describe(const png_file *f, kiln_file_info *info)
{
    bool color = f->color & KI_PNG_COLOR;
    snprintf(info->format, sizeof info->format, "png");
    snprintf(info->encoding, sizeof info->encoding, "%d bits %s%s, %s%s", f->depth,
             f->color & KI_PNG_PALETTE ? "palette"
             : color                   ? "rgb"
                                       : "grey",
             f->color & KI_PNG_ALPHA ? " with alpha" : "", f->meaning.name,
             f->interlaced ? ", interlaced" : "");
    bool exchanged = f->meaning.orientation >= 5;
    info->width = exchanged ? f->height : f->width;
    info->height = exchanged ? f->width : f->height;
    info->channel_count = color ? 3 : 1;
    info->level_count = 1;
}

// Finds what the samples mean. Radiance in four bytes needs four channels of 8 bits.
static kiln_result read_meaning(png_file *f, const uint8_t *bytes, size_t size,
                                kiln_load_report *report, kiln_error *error)
{
    kiln_result result =
        ki_png_read_meaning(f->context, bytes, size, f->name, &f->meaning, report, error);
    if (result != KILN_OK)
        return result;
    f->meaning.unpack = f->forced ? f->forced : f->meaning.unpack;
    if (f->meaning.unpack && (f->depth != 8 || f->channels != 4))
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: says that its texels are %s, which has four channels of 8 bits, but "
                       "the picture has %d channels of %d bits",
                       f->name, f->meaning.name, f->channels, f->depth);
    if ((f->color & KI_PNG_ALPHA || f->meaning.transparent) && !f->meaning.unpack)
        ki_note(report, KILN_NOTE_CHOICE, false, "alpha was ignored: every pixel counts as opaque");
    return KILN_OK;
}

kiln_result ki_png_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, kiln_image *image, kiln_file_info *info,
                          kiln_load_report *report, kiln_error *error)
{
    return ki_png_decode_as(context, bytes, size, name, NULL, image, info, report, error);
}

kiln_result ki_png_decode_as(kiln_context *context, const uint8_t *bytes, size_t size,
                             const char *name, ki_from_rgbx *forced, kiln_image *image,
                             kiln_file_info *info, kiln_load_report *report, kiln_error *error)
{
    if (image)
        *image = (kiln_image){0};
    png_file *f = ki_alloc(context, 1, sizeof *f);
    if (!f)
        return ki_fail_memory(context, error, name, sizeof *f);
    f->context = context;
    f->name = name;
    f->asker = ki_asker_make(context);
    f->forced = forced;
    f->reader = ki_reader_make(bytes, size);
    ki_crc32_fill(&f->crc);
    kiln_result result = read_head(f, error);
    if (result == KILN_OK)
        result = read_meaning(f, bytes, size, report, error);
    if (result == KILN_OK && info)
        describe(f, info);
    if (result == KILN_OK && image)
        result = read_pixels(f, image, error);
    ki_free(f->joined);
    ki_free(f->raw);
    ki_free(f->table[0]);
    ki_file_color_free(&f->meaning.color);
    ki_free(f->pixels);
    ki_free(f);
    return result;
}

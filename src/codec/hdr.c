// Radiance HDR files (RGBE). In: the bytes of a file, flat or run-length encoded in the old or the
// new way, in any of the eight orientations. Out: RGB floats, rows from top to bottom; or from such
// floats, a file with new run-length encoding. Lines are found first and then decoded on all
// threads.
//
// A value is mantissa / 256 * 2^(exponent - 128), divided by the product of the header's EXPOSURE
// lines, which gives the original radiance.
#include "codec/codec.h"
#include "codec/decimal.h"
#include "codec/file_info.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NEW_RUNS_LEAST = 8, NEW_RUNS_MOST = 32767 };

typedef struct hdr_file {
    const char *name;
    const uint8_t *bytes;
    size_t size;
    int width, height;           // size of the upright picture
    int line_count, line_length; // number and length of lines as stored
    bool columns;                // true: a stored line is a column of the picture
    bool flip_line, flip_order;  // true: reversed along each line; reversed order of the lines
    double exposure;
    size_t *line_start;
    int task_count;
    uint8_t *texels; // texels of the line that each task decodes
    float *pixels;
    float scale[256];
} hdr_file;

// ------------------------------------------------------------------------------------------ header

// Reads the next line without its end into `line`, at most `room` - 1 characters. Returns false at
// the end of the file.
static bool next_line(ki_reader *r, char *line, size_t room)
{
    size_t length = 0;
    while (ki_reader_left(r)) {
        char c = (char)ki_read_u8(r);
        if (c == '\n') {
            if (length && line[length - 1] == '\r')
                length--;
            line[length] = 0;
            return true;
        }
        if (length + 1 < room)
            line[length++] = c;
    }
    return false;
}

// Reads the resolution, for example "-Y 512 +X 1024", which names the slower axis first.
static kiln_result read_resolution(hdr_file *f, const char *line, kiln_error *error)
{
    char sign[2], axis[2];
    int count[2];
    char trailing;
    if (sscanf(line, "%c%c %9d %c%c %9d%c", &sign[0], &axis[0], &count[0], &sign[1], &axis[1],
               &count[1], &trailing) != 6 ||
        !((axis[0] == 'Y' && axis[1] == 'X') || (axis[0] == 'X' && axis[1] == 'Y')) ||
        (sign[0] != '-' && sign[0] != '+') || (sign[1] != '-' && sign[1] != '+'))
        return ki_fail(
            error, KILN_ERROR_FORMAT,
            "%s: the HDR resolution line is \"%.40s\", it must be like \"-Y 512 +X 1024\"", f->name,
            line);
    f->columns = axis[0] == 'X';
    f->line_count = count[0];
    f->line_length = count[1];
    f->width = f->columns ? count[0] : count[1];
    f->height = f->columns ? count[1] : count[0];
    if (f->width < 1 || f->height < 1 || f->width > KILN_MAX_SIZE || f->height > KILN_MAX_SIZE)
        return ki_fail(error,
                       f->width < 1 || f->height < 1 ? KILN_ERROR_FORMAT : KILN_ERROR_UNSUPPORTED,
                       "%s: the picture is %d x %d, the limit is %d", f->name, f->width, f->height,
                       KILN_MAX_SIZE);
    // In this format Y grows upwards and X to the right.
    f->flip_order = f->columns ? sign[0] == '-' : sign[0] == '+';
    f->flip_line = f->columns ? sign[1] == '+' : sign[1] == '-';
    return KILN_OK;
}

static kiln_result read_header(hdr_file *f, ki_reader *r, kiln_file_info *info, kiln_error *error)
{
    char line[256];
    bool ended = false;
    f->exposure = 1;
    while (next_line(r, line, sizeof line)) {
        if (!line[0]) {
            ended = true;
            break;
        }
        if (!strncmp(line, "FORMAT=", 7) && strcmp(line + 7, "32-bit_rle_rgbe") != 0)
            return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                           "%s: the HDR format is \"%.40s\", kiln reads 32-bit_rle_rgbe only",
                           f->name, line + 7);
        if (!strncmp(line, "EXPOSURE=", 9)) {
            double value = 0;
            ki_parse_number(line + 9, &value);
            if (!(value > 0) || !(value < 1e30) || !(f->exposure * value > 1e-30) ||
                !(f->exposure * value < 1e30))
                return ki_fail(
                    error, KILN_ERROR_FORMAT,
                    "%s: the HDR header has the line \"%.40s\", which is no usable exposure",
                    f->name, line);
            f->exposure *= value;
        }
        if (info && !strncmp(line, "SOFTWARE=kiln ", 14))
            ki_copy_printable(info->writer, sizeof info->writer, line + 9);
    }
    if (!ended || !next_line(r, line, sizeof line))
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: the HDR header does not end within the file's %zu bytes", f->name,
                       f->size);
    return read_resolution(f, line, error);
}

// ----------------------------------------------------------------------------------------- texels

static bool has_new_runs(const hdr_file *f, const uint8_t *at, size_t left)
{
    return f->line_length >= NEW_RUNS_LEAST && f->line_length <= NEW_RUNS_MOST && left >= 4 &&
           at[0] == 2 && at[1] == 2 && (at[2] << 8 | at[3]) == f->line_length;
}

// Decodes one line of `line_length` texels to four bytes each, or only finds the end of the line if
// `texels` is NULL. Returns the number of bytes read, 0 if the data are damaged.
static size_t read_new_runs(const hdr_file *f, const uint8_t *at, size_t left, uint8_t *texels)
{
    size_t in = 4;
    for (int c = 0; c < 4; c++) {
        for (int x = 0; x < f->line_length;) {
            if (left - in < 2)
                return 0;
            int code = at[in++];
            int count = code > 128 ? code - 128 : code;
            if (count == 0 || count > f->line_length - x ||
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

// Decodes a line of the old encoding, four bytes for each texel. The texel (1, 1, 1, n) repeats the
// previous texel n times. If several such texels follow one another, the second counts n * 256
// times, and so on.
static size_t read_old_runs(const hdr_file *f, const uint8_t *at, size_t left, uint8_t *texels)
{
    size_t in = 0;
    int shift = 0;
    for (int x = 0; x < f->line_length;) {
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
        if (x == 0 || count > f->line_length - x)
            return 0;
        for (int i = 0; texels && i < count; i++)
            memcpy(texels + 4 * (size_t)(x + i), texels + 4 * (size_t)(x - 1), 4);
        x += (int)count;
        shift += 8;
    }
    return in;
}

static size_t read_line(const hdr_file *f, size_t start, uint8_t *texels)
{
    const uint8_t *at = f->bytes + start;
    size_t left = f->size - start;
    return has_new_runs(f, at, left) ? read_new_runs(f, at, left, texels)
                                     : read_old_runs(f, at, left, texels);
}

static void decode_line(const hdr_file *f, int index, uint8_t *texels)
{
    memset(texels, 0, 4 * (size_t)f->line_length);
    read_line(f, f->line_start[index], texels);
    int order = f->flip_order ? f->line_count - 1 - index : index;
    ptrdiff_t step = f->columns ? 3 * (ptrdiff_t)f->width : 3;
    float *to = f->pixels +
                (f->columns ? 3 * (ptrdiff_t)order : 3 * (ptrdiff_t)order * (ptrdiff_t)f->width);
    if (f->flip_line) {
        to += step * (f->line_length - 1);
        step = -step;
    }
    for (int x = 0; x < f->line_length; x++, to += step) {
        const uint8_t *t = texels + 4 * (size_t)x;
        float scale = f->scale[t[3]];
        for (int c = 0; c < 3; c++) {
            float value = (float)t[c] * scale;
            to[c] = value < FLT_MAX ? value : FLT_MAX;
        }
    }
}

// Task of one thread: decodes a share of the lines. The task has its own memory for the texels of a
// line, because a line of 32767 texels would not fit on the stack of a WebAssembly thread.
static void decode_lines(void *data, int task)
{
    const hdr_file *f = data;
    uint8_t *texels = f->texels + 4 * (size_t)f->line_length * (size_t)task;
    int end = (int)((int64_t)f->line_count * (task + 1) / f->task_count);
    for (int i = (int)((int64_t)f->line_count * task / f->task_count); i < end; i++)
        decode_line(f, i, texels);
}

static kiln_result decode_all(kiln_context *context, hdr_file *f, kiln_error *error)
{
    enum { TASKS = 64 };
    for (int e = 1; e < 256; e++) {
        double scale = ldexp(1, e - 136) / f->exposure;
        f->scale[e] = scale < (double)FLT_MAX ? (float)scale : FLT_MAX;
    }
    f->task_count = ki_min(TASKS, f->line_count);
    f->texels = ki_alloc_raw(context, (size_t)f->task_count, 4 * (size_t)f->line_length);
    if (!f->texels)
        return ki_fail_memory(context, error, f->name,
                              4 * (size_t)f->task_count * (size_t)f->line_length);
    ki_parallel_for(context, f->task_count, decode_lines, f);
    return KILN_OK;
}

kiln_result ki_hdr_decode(kiln_context *context, const uint8_t *bytes, size_t size,
                          const char *name, kiln_image *image, kiln_file_info *info,
                          kiln_load_report *report, kiln_error *error)
{
    (void)report;
    if (image)
        *image = (kiln_image){0};
    hdr_file f = {.name = name, .bytes = bytes, .size = size};
    ki_reader r = ki_reader_make(bytes, size);
    kiln_result result = read_header(&f, &r, info, error);
    if (result != KILN_OK)
        return result;
    size_t start = (size_t)(r.at - bytes);
    if (info) {
        bool runs = has_new_runs(&f, r.at, ki_reader_left(&r));
        bool flat = size - start == 4 * (size_t)f.width * (size_t)f.height;
        snprintf(info->format, sizeof info->format, "hdr");
        snprintf(info->encoding, sizeof info->encoding, "rgbe, %s",
                 runs   ? "rle"
                 : flat ? "uncompressed"
                        : "old rle");
        info->width = f.width;
        info->height = f.height;
        info->channel_count = 3;
        info->level_count = 1;
    }
    if (!image)
        return KILN_OK;

    // Finds where the lines begin before memory for the texels is allocated.
    size_t count = 3 * (size_t)f.width * (size_t)f.height;
    f.line_start = ki_alloc_raw(context, (size_t)f.line_count, sizeof *f.line_start);
    if (!f.line_start) {
        result = ki_fail_memory(context, error, name, (size_t)f.line_count * sizeof *f.line_start);
        goto done;
    }
    for (int y = 0; y < f.line_count; y++) {
        f.line_start[y] = start;
        size_t taken = read_line(&f, start, NULL);
        if (!taken) {
            result = ki_fail(error, KILN_ERROR_FORMAT, "%s: line %d of %d is damaged, at byte %zu",
                             name, y, f.line_count, start);
            goto done;
        }
        start += taken;
    }
    f.pixels = ki_alloc_raw(context, count, sizeof(float));
    if (!f.pixels) {
        result = ki_fail_memory(context, error, name, count * sizeof(float));
        goto done;
    }
    result = decode_all(context, &f, error);
    if (result != KILN_OK)
        goto done;
    *image = (kiln_image){f.width, f.height, 3, f.pixels, f.pixels};
    f.pixels = NULL;
done:
    ki_free(f.line_start);
    ki_free(f.texels);
    ki_free(f.pixels);
    return result;
}

// ----------------------------------------------------------------------------------------- writing

// Converts a texel. The exponent is that of the largest channel; mantissas are rounded to the
// nearest byte.
static void to_rgbe(const float rgb[3], uint8_t rgbe[4])
{
    float c[3], most = 0;
    for (int i = 0; i < 3; i++) {
        c[i] = rgb[i] > 0 ? rgb[i] : 0;
        // 255 / 256 * 2^127, the largest value of RGBE.
        c[i] = c[i] < 0x1.fep126F ? c[i] : 0x1.fep126F;
        most = c[i] > most ? c[i] : most;
    }
    int e = 0;
    (void)frexpf(most, &e);
    double scale = ldexp(1, 8 - e);
    if ((double)most * scale >= 255.5) {
        e++;
        scale /= 2;
    }
    if (most <= 0 || e < -127) {
        memset(rgbe, 0, 4);
        return;
    }
    for (int i = 0; i < 3; i++)
        rgbe[i] = (uint8_t)((double)c[i] * scale + 0.5);
    rgbe[3] = (uint8_t)(e + 128);
}

// Writes runs of four or more equal bytes as runs, and other bytes literally.
static void write_runs(ki_writer *w, const uint8_t *bytes, int count)
{
    for (int x = 0; x < count;) {
        int run = 1;
        while (run < 127 && x + run < count && bytes[x + run] == bytes[x])
            run++;
        if (run >= 4) {
            ki_write_u8(w, (uint8_t)(128 + run));
            ki_write_u8(w, bytes[x]);
            x += run;
            continue;
        }
        int end = x + 1;
        while (end < count && end - x < 128 &&
               !(end + 3 < count && bytes[end] == bytes[end + 1] && bytes[end] == bytes[end + 2] &&
                 bytes[end] == bytes[end + 3]))
            end++;
        ki_write_u8(w, (uint8_t)(end - x));
        ki_write(w, bytes + x, (size_t)(end - x));
        x = end;
    }
}

kiln_result ki_hdr_encode(const float *pixels, int width, int height, ki_writer *writer,
                          kiln_error *error)
{
    ki_write_text(writer, "#?RADIANCE\nSOFTWARE=kiln %s\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n",
                  kiln_version(), height, width);
    bool runs = width >= NEW_RUNS_LEAST && width <= NEW_RUNS_MOST;
    uint8_t *planes = ki_alloc_raw(writer->context, (size_t)width, 4);
    kiln_result result = KILN_OK;
    for (int y = 0; planes && y < height; y++) {
        if (y % 16 == 0 && !ki_go_on(writer->context)) {
            result = ki_fail_cancelled(error, "writing");
            break;
        }
        const float *line = pixels + 3 * (size_t)y * (size_t)width;
        for (int x = 0; x < width; x++) {
            uint8_t texel[4];
            to_rgbe(line + 3 * (size_t)x, texel);
            for (int c = 0; c < 4; c++)
                planes[runs ? c * width + x : 4 * x + c] = texel[c];
        }
        if (!runs) {
            ki_write(writer, planes, 4 * (size_t)width);
            continue;
        }
        const uint8_t start[4] = {2, 2, (uint8_t)(width >> 8), (uint8_t)width};
        ki_write(writer, start, 4);
        for (int c = 0; c < 4; c++)
            write_runs(writer, planes + (size_t)c * (size_t)width, width);
    }
    bool good = planes && !writer->failed;
    ki_free(planes);
    return good ? result
                : ki_fail_memory(writer->context, error, "an HDR file",
                                 writer->size + 4 * (size_t)width);
}

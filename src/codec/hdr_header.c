// The header of Radiance HDR files. In: lines of text. Out: the picture's size and orientation, and
// what its values must be divided and multiplied by to be radiance in Rec. 709. Lines are taken as
// Radiance's own reader takes them (header.c, resolu.c and color.h of Radiance): a line counts if
// it begins with its keyword, EXPOSURE and COLORCORR may stand several times and are multiplied,
// and blanks may stand around each value.
#include "codec/hdr.h"

#include "codec/decimal.h"
#include "codec/file_info.h"
#include "codec/report.h"

#include <math.h>
#include <string.h>

typedef struct header_reader {
    kiln_context *context;
    const char *name;
    size_t size; // number of bytes of the file
    ki_reader *r;
    ki_hdr_header *header;
    kiln_file_info *info;
    // product of the header's lines EXPOSURE, and of its lines COLORCORR for each channel
    double exposure, correction[3];
    double aspect; // width of a pixel divided by its height
    bool has_primaries;
    ki_primaries primaries;
    kiln_load_report *report;
} header_reader;

// Reads the next line without its end into `line`, at most `room` - 1 characters. Returns false at
// the end of the file.
static bool next_line(ki_reader *r, char *line, size_t room)
{
    size_t left = ki_reader_left(r);
    const uint8_t *end = left ? memchr(r->at, '\n', left) : NULL;
    if (!end)
        return false;
    size_t length = (size_t)(end - r->at);
    const uint8_t *text = ki_read_bytes(r, length + 1);
    if (length && text[length - 1] == '\r')
        length--;
    if (length >= room)
        length = room - 1;
    memcpy(line, text, length);
    line[length] = 0;
    return true;
}

// ------------------------------------------------------------------------------------- resolution

static const char *skip_blanks(const char *text)
{
    while (*text == ' ' || *text == '\t' || *text == '\r')
        text++;
    return text;
}

// Reads a sign, an axis and a size of at most nine digits, for example "-Y 512". Returns a pointer
// to the text after the size, or NULL if the text is no such thing.
static const char *read_axis(const char *text, char *sign, char *axis, int *count)
{
    int digits = 0;
    text = skip_blanks(text);
    if ((text[0] != '-' && text[0] != '+') || (text[1] != 'X' && text[1] != 'Y'))
        return NULL;
    *sign = text[0];
    *axis = text[1];
    *count = 0;
    for (text = skip_blanks(text + 2); *text >= '0' && *text <= '9' && digits < 9; digits++)
        *count = 10 * *count + (*text++ - '0');
    return digits ? text : NULL;
}

// Reads the line with the resolution, for example "-Y 512 +X 1024". The axis that is named first is
// that along which the lines follow one another.
static kiln_result read_resolution(ki_hdr_header *h, const char *name, const char *line,
                                   kiln_error *error)
{
    char sign[2], axis[2];
    int count[2];
    const char *at = read_axis(line, &sign[0], &axis[0], &count[0]);
    at = at ? read_axis(at, &sign[1], &axis[1], &count[1]) : NULL;
    if (!at || *skip_blanks(at) || axis[0] == axis[1]) {
        char shown[41];
        ki_copy_printable(shown, sizeof shown, line);
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: the HDR resolution line is \"%s\", it must be like \"-Y 512 +X 1024\"",
                       name, shown);
    }
    h->columns = axis[0] == 'X';
    h->line_count = count[0];
    h->line_length = count[1];
    h->width = h->columns ? count[0] : count[1];
    h->height = h->columns ? count[1] : count[0];
    if (h->width < 1 || h->height < 1 || h->width > KILN_MAX_SIZE || h->height > KILN_MAX_SIZE)
        return ki_fail(error,
                       h->width < 1 || h->height < 1 ? KILN_ERROR_FORMAT : KILN_ERROR_UNSUPPORTED,
                       "%s: the picture is %d x %d, the limit is %d", name, h->width, h->height,
                       KILN_MAX_SIZE);
    // In this format Y grows upwards and X to the right, so that an axis +Y or -X must be reversed.
    h->flip_order = h->columns ? sign[0] == '-' : sign[0] == '+';
    h->flip_line = h->columns ? sign[1] == '+' : sign[1] == '-';
    return KILN_OK;
}

// ------------------------------------------------------------------------------------------ lines

static kiln_result bad_line(const header_reader *h, const char *line, const char *what,
                            kiln_error *error)
{
    char shown[81];
    ki_copy_printable(shown, sizeof shown, line);
    return ki_fail(error, KILN_ERROR_FORMAT,
                   "%s: the HDR header has the line \"%s\", which is no %s", h->name, shown, what);
}

// Reads `count` numbers that are separated by blanks. Returns false if there are fewer numbers.
static bool read_numbers(const char *text, double *values, int count)
{
    for (int i = 0; text && i < count; i++)
        text = ki_parse_number(text, &values[i]);
    return text != NULL;
}

// Multiplies *product by a number of the header that scales radiance. The number 0, which some
// programs write for an unknown exposure, is taken as 1.
static bool multiply(header_reader *h, double value, const char *keyword, double *product)
{
    if (value == 0) {
        ki_note(h->report, KILN_NOTE_ASSUMPTION, true, "the header's %s of 0 was taken as 1",
                keyword);
        return true;
    }
    *product *= value;
    return value > 0 && value < 1e30 && *product > 1e-30 && *product < 1e30;
}

static kiln_result read_exposure(header_reader *h, const char *line, const char *text,
                                 kiln_error *error)
{
    double value;
    return read_numbers(text, &value, 1) && multiply(h, value, "EXPOSURE", &h->exposure)
               ? KILN_OK
               : bad_line(h, line, "usable exposure", error);
}

static kiln_result read_correction(header_reader *h, const char *line, const char *text,
                                   kiln_error *error)
{
    double values[3];
    bool good = read_numbers(text, values, 3);
    for (int c = 0; good && c < 3; c++)
        good = multiply(h, values[c], "COLORCORR", &h->correction[c]);
    return good ? KILN_OK : bad_line(h, line, "usable colour correction", error);
}

static kiln_result read_primaries(header_reader *h, const char *line, const char *text,
                                  kiln_error *error)
{
    ki_matrix3 unused;
    h->has_primaries = true;
    return read_numbers(text, h->primaries.xy, 8) &&
                   ki_rec709_from_rgb(&h->primaries, NULL, &unused)
               ? KILN_OK
               : bad_line(h, line, "set of primaries that spans its white", error);
}

// Reads the height of a pixel divided by its width. Several such lines multiply.
static kiln_result read_aspect(header_reader *h, const char *line, const char *text,
                               kiln_error *error)
{
    double value;
    if (!read_numbers(text, &value, 1) || !(value > 1e-6 && value < 1e6))
        return bad_line(h, line, "usable shape of pixels", error);
    h->aspect /= value;
    return KILN_OK;
}

// Notes a line GAMMA, which Radiance does not know, but the files of some programs have.
static kiln_result read_gamma(header_reader *h, const char *line, const char *text,
                              kiln_error *error)
{
    double value;
    (void)error;
    if (!read_numbers(text, &value, 1) || value != 1)
        ki_note(h->report, KILN_NOTE_ASSUMPTION, true,
                "the header's line \"%s\" was ignored: values were taken as linear light", line);
    return KILN_OK;
}

// Notes the last view type, such as -vtv, of a line VIEW. None of Radiance's views (man rpict) is a
// panorama of equal angles. A line without a type states the place of the camera only.
static kiln_result read_view(header_reader *h, const char *line, const char *text,
                             kiln_error *error)
{
    static const struct {
        char letter;
        const char *name;
    } types[] = {{'v', "a perspective view"},     {'l', "a parallel view"},
                 {'c', "a cylindrical panorama"}, {'h', "a hemispherical fisheye"},
                 {'a', "an angular fisheye"},     {'s', "a planisphere"}};
    const char *at = NULL;
    (void)line;
    (void)error;
    while ((text = strstr(text, "-vt")) != NULL)
        at = text += 3;
    for (size_t i = 0; at && i < sizeof types / sizeof *types; i++)
        if (*at == types[i].letter)
            ki_note(h->report, KILN_NOTE_ASSUMPTION, false,
                    "the header's VIEW says that the picture is %s (-vt%c), which was ignored: the "
                    "layout does not follow from VIEW",
                    types[i].name, *at);
    return KILN_OK;
}

static kiln_result read_format(header_reader *h, const char *line, const char *text,
                               kiln_error *error)
{
    char word[41];
    (void)line;
    ki_copy_printable(word, sizeof word, skip_blanks(text));
    word[strcspn(word, " ")] = 0;
    h->header->xyz = !strcmp(word, "32-bit_rle_xyze");
    if (h->header->xyz || !strcmp(word, "32-bit_rle_rgbe"))
        return KILN_OK;
    return ki_fail(error, KILN_ERROR_UNSUPPORTED,
                   "%s: the HDR format is \"%s\", kiln reads 32-bit_rle_rgbe and 32-bit_rle_xyze",
                   h->name, word);
}

static kiln_result read_line(header_reader *h, const char *line, kiln_error *error)
{
    static const struct {
        const char *keyword;
        kiln_result (*read)(header_reader *h, const char *line, const char *text,
                            kiln_error *error);
    } rows[] = {{"FORMAT=", read_format},
                {"EXPOSURE=", read_exposure},
                {"COLORCORR=", read_correction},
                {"PRIMARIES=", read_primaries},
                {"PIXASPECT=", read_aspect},
                {"GAMMA=", read_gamma},
                {"VIEW=", read_view}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        size_t length = strlen(rows[i].keyword);
        if (!strncmp(line, rows[i].keyword, length))
            return rows[i].read(h, line, line + length, error);
    }
    if (h->info && !strncmp(line, "SOFTWARE=kiln ", 14))
        ki_copy_printable(h->info->writer, sizeof h->info->writer, line + 9);
    return KILN_OK;
}

// ----------------------------------------------------------------------------------------- values

static void note_primaries(const header_reader *h)
{
    const double *xy = h->primaries.xy;
    ki_note(h->report, KILN_NOTE_CONVERSION, false,
            "colours were converted to Rec. 709 from the primaries (%.4g, %.4g), (%.4g, %.4g), "
            "(%.4g, %.4g) and the white (%.4g, %.4g)",
            xy[0], xy[1], xy[2], xy[3], xy[4], xy[5], xy[6], xy[7]);
}

// Sets the divisor and the colour matrix by which the file's values become radiance in Rec. 709.
// Adds a note to h->report about each of the two that changes values.
static void find_conversion(const header_reader *h)
{
    ki_hdr_header *to = h->header;
    const double *correction = h->correction;
    for (int c = 0; c < 3; c++)
        to->divisor[c] = h->exposure * correction[c];
    if (h->exposure != 1)
        ki_note(h->report, KILN_NOTE_CONVERSION, false,
                "values were divided by the header's exposure of %.6g", h->exposure);
    if (correction[0] != 1 || correction[1] != 1 || correction[2] != 1)
        ki_note(h->report, KILN_NOTE_CONVERSION, false,
                "values were divided by the header's colour correction of %.6g, %.6g and %.6g",
                correction[0], correction[1], correction[2]);
    if (to->xyz) {
        to->converts = ki_rec709_from_xyz(ki_white_e, &to->to_rec709);
        ki_note(h->report, KILN_NOTE_CONVERSION, false,
                "colours were converted to Rec. 709 from CIE XYZ, whose white is X = Y = Z");
    } else if (h->has_primaries) {
        to->converts = ki_rec709_from_rgb(&h->primaries, NULL, &to->to_rec709) &&
                       !ki_matrix_is_identity(&to->to_rec709);
        if (to->converts)
            note_primaries(h);
    }
}

static kiln_result read_lines(header_reader *h, kiln_error *error)
{
    // number of header lines after which the caller is asked whether to go on
    enum { LINES = 1 << 16 };
    char line[256];
    kiln_result result = KILN_OK;
    bool more = next_line(h->r, line, sizeof line);
    for (size_t i = 0; more && line[0] && result == KILN_OK; i++) {
        if (i % LINES == 0 && !ki_go_on(h->context))
            return ki_fail_cancelled(error, "reading");
        result = read_line(h, line, error);
        more = next_line(h->r, line, sizeof line);
    }
    if (result != KILN_OK)
        return result;
    if (!more || !next_line(h->r, line, sizeof line))
        return ki_fail(error, KILN_ERROR_FORMAT,
                       "%s: the HDR header does not end within the file's %zu bytes", h->name,
                       h->size);
    return read_resolution(h->header, h->name, line, error);
}

kiln_result ki_hdr_read_header(kiln_context *context, ki_reader *r, const char *name,
                               ki_hdr_header *header, kiln_file_info *info,
                               kiln_load_report *report, kiln_error *error)
{
    header_reader h = {.context = context,
                       .name = name,
                       .size = ki_reader_left(r),
                       .r = r,
                       .header = header,
                       .info = info,
                       .exposure = 1,
                       .aspect = 1,
                       .correction = {1, 1, 1},
                       .report = report};
    *header = (ki_hdr_header){0};
    kiln_result result = read_lines(&h, error);
    if (result != KILN_OK)
        return result;
    find_conversion(&h);
    ki_note_pixel_aspect(report, "the header's PIXASPECT", h.aspect);
    return result;
}

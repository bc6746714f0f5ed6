// ICC profiles (ICC.1:2022) of displays and of RGB colour spaces. In: the bytes of a profile. Out:
// for each channel the curve from a sample to linear light, and the matrix to Rec. 709. Method: the
// profile's tags rTRC, gTRC and bTRC are the curves, rXYZ, gXYZ and bXYZ the columns of the matrix
// to XYZ relative to D50, which the Bradford transform adapts to D65. A tag cicp takes precedence,
// since it names PQ and HLG, whose values other tags cannot hold.
#include "codec/icc.h"

#include "codec/file_info.h"
#include "codec/report.h"
#include "image/pack.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { HEADER = 128, TAG = 12, TAGS_MOST = 1024 };

typedef struct icc_file {
    const uint8_t *bytes;
    size_t size;
} icc_file;

static uint32_t u32_at(const uint8_t *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

// Returns a number that is stored with 16 bits before and 16 bits after the binary point.
static double fixed_at(const uint8_t *at)
{
    return (double)(int32_t)u32_at(at) / 65536;
}

// Returns the data of a profile's tag, or NULL if the profile has no such tag of at least `least`
// bytes.
static const uint8_t *find_tag(const icc_file *f, const char *name, size_t least, size_t *size)
{
    uint32_t count = u32_at(f->bytes + HEADER);
    for (uint32_t i = 0; i < count && i < TAGS_MOST; i++) {
        size_t at = HEADER + 4 + (size_t)i * TAG;
        if (f->size - at < TAG || at > f->size)
            return NULL;
        const uint8_t *tag = f->bytes + at;
        size_t offset = u32_at(tag + 4), length = u32_at(tag + 8);
        if (memcmp(tag, name, 4) != 0)
            continue;
        if (offset > f->size || length > f->size - offset || length < least)
            return NULL;
        *size = length;
        return f->bytes + offset;
    }
    return NULL;
}

static bool has_tag(const icc_file *f, const char *name)
{
    size_t size;
    return find_tag(f, name, 0, &size) != NULL;
}

// ---------------------------------------------------------------------------------------- curves

// Reads a curve of type "para", which has one of five functions. Each function stores some of the
// numbers g, a, b, c, d, e and f, in this order.
static bool read_parametric(const uint8_t *data, size_t size, ki_curve *curve)
{
    static const size_t counts[5] = {1, 3, 4, 5, 7};
    double p[7] = {1, 1, 0, 0, 0, 0, 0};
    unsigned function = size >= 12 ? (unsigned)(data[8] << 8 | data[9]) : 5;
    if (function > 4 || size < 12 + 4 * counts[function])
        return false;
    for (size_t i = 0; i < counts[function]; i++)
        p[i] = fixed_at(data + 12 + 4 * i);
    *curve = (ki_curve){.kind = KI_CURVE_PARAMETRIC, .g = p[0], .a = p[1], .b = p[2]};
    // up to the x at which a x + b is 0 the curve is 0 or a constant
    if (function == 1 || function == 2) {
        curve->d = p[1] != 0 ? -p[2] / p[1] : 0;
        curve->e = curve->f = function == 2 ? p[3] : 0;
    } else if (function > 2) {
        curve->c = p[3];
        curve->d = p[4];
        curve->e = p[5];
        curve->f = p[6];
    }
    return curve->g > 0 && curve->g < 100;
}

static bool read_curve(const icc_file *f, const char *name, ki_curve *curve)
{
    size_t size;
    const uint8_t *data = find_tag(f, name, 12, &size);
    if (!data)
        return false;
    if (!memcmp(data, "para", 4))
        return read_parametric(data, size, curve);
    size_t count = u32_at(data + 8);
    if (memcmp(data, "curv", 4) != 0 || count > (size - 12) / 2)
        return false;
    *curve = (ki_curve){.kind = KI_CURVE_PARAMETRIC, .g = 1, .a = 1};
    if (count == 1)
        curve->g = (double)(data[12] << 8 | data[13]) / 256;
    else if (count > 1)
        *curve = (ki_curve){.kind = KI_CURVE_TABLE, .table = data + 12, .count = count};
    return true;
}

// Returns whether a curve gives the linear values of sRGB with differences of at most 5e-4, which
// the rounding of numbers in profiles explains.
static bool is_srgb(const ki_curve *curve)
{
    for (int i = 0; i <= 64; i++) {
        double x = i / 64.0, wanted = (double)ki_linear_from_srgb((float)x);
        if (fabs(ki_curve_linear(curve, x) - wanted) > 5e-4)
            return false;
    }
    return true;
}

// ------------------------------------------------------------------------------------------ names

// Copies the profile's description to `name`, as far as its characters are ASCII.
static void read_name(const icc_file *f, char name[KI_COLOR_NAME])
{
    char text[KI_COLOR_NAME] = "";
    size_t size = 0, at = 0, step = 1;
    const uint8_t *data = find_tag(f, "desc", 28, &size);
    if (data && !memcmp(data, "desc", 4)) {
        at = 12;
    } else if (data && !memcmp(data, "mluc", 4)) { // the text is UTF-16, high byte first
        at = u32_at(data + 24);
        step = 2;
    }
    for (size_t i = 0; at && i + 1 < sizeof text && at < size && size - at >= step; i++, at += step)
        text[i] = step == 2 && data[at] ? '?' : (char)data[at + step - 1];
    ki_copy_printable(name, KI_COLOR_NAME, text);
    if (!name[0])
        snprintf(name, KI_COLOR_NAME, "without a name");
}

// ---------------------------------------------------------------------------------------- profile

static bool read_column(const icc_file *f, const char *name, int c, ki_matrix3 *to_xyz)
{
    size_t size;
    const uint8_t *data = find_tag(f, name, 20, &size);
    for (int i = 0; data && i < 3; i++)
        to_xyz->m[i][c] = fixed_at(data + 8 + 4 * (size_t)i);
    return data && !memcmp(data, "XYZ ", 4);
}

static bool read_matrix(const icc_file *f, ki_file_color *color)
{
    ki_matrix3 to_xyz, to_rgb;
    if (!read_column(f, "rXYZ", 0, &to_xyz) || !read_column(f, "gXYZ", 1, &to_xyz) ||
        !read_column(f, "bXYZ", 2, &to_xyz) || !ki_rec709_from_xyz(ki_white_d50, &to_rgb))
        return false;
    color->to_rec709 = ki_matrix_multiply(&to_rgb, &to_xyz);
    color->converts = true;
    return true;
}

// Clears `converts` if the profile's matrix is the identity but for the rounding of numbers in
// profiles, and replaces curves that give the values of sRGB by {0}.
static void simplify(ki_file_color *color)
{
    double most = 0;
    for (int i = 0; i < 9; i++)
        most = fmax(most, fabs(color->to_rec709.m[i / 3][i % 3] - (i % 4 == 0)));
    color->converts = color->converts && most > 2e-3;
    for (int c = 0; c < 3; c++)
        if (is_srgb(&color->curve[c]))
            color->curve[c] = (ki_curve){0};
}

static bool read_cicp(const icc_file *f, ki_file_color *color)
{
    char what[KI_COLOR_NAME];
    size_t size;
    const uint8_t *data = find_tag(f, "cicp", 12, &size);
    return data && ki_file_color_set_cicp(color, data + 8, what);
}

static bool read_rgb(const icc_file *f, ki_file_color *color)
{
    return read_matrix(f, color) && read_curve(f, "rTRC", &color->curve[0]) &&
           read_curve(f, "gTRC", &color->curve[1]) && read_curve(f, "bTRC", &color->curve[2]);
}

static bool read_grey(const icc_file *f, ki_file_color *color)
{
    ki_curve curve;
    if (!read_curve(f, "kTRC", &curve))
        return false;
    ki_file_color_set_curve(color, &curve);
    return true;
}

static const char *read_profile(const icc_file *f, ki_file_color *color)
{
    if (f->size < HEADER + 4 || memcmp(f->bytes + 36, "acsp", 4) != 0)
        return "is damaged";
    bool grey = !memcmp(f->bytes + 16, "GRAY", 4);
    if (!grey && memcmp(f->bytes + 16, "RGB ", 4) != 0)
        return "is not of RGB or grey";
    if (!read_cicp(f, color) && !(grey ? read_grey(f, color) : read_rgb(f, color)))
        return has_tag(f, "A2B0") ? "has only look-up tables of several dimensions"
                                  : "has no curves and matrix";
    return NULL;
}

void ki_icc_read(uint8_t *profile, size_t size, ki_file_color *color, kiln_load_report *report)
{
    const icc_file f = {profile, size};
    ki_file_color read = {.profile = profile};
    char name[KI_COLOR_NAME] = "without a name";
    const char *fault = read_profile(&f, &read);
    if (size >= HEADER + 4)
        read_name(&f, name);
    if (fault) {
        ki_note(report, KILN_NOTE_ASSUMPTION, true,
                "the ICC profile \"%s\" %s, so sRGB was assumed", name, fault);
        ki_file_color_free(&read);
    } else {
        simplify(&read);
    }
    bool srgb = !read.converts && !read.hlg;
    for (int c = 0; c < 3; c++)
        srgb = srgb && read.curve[c].kind == KI_CURVE_SRGB;
    if (srgb)
        ki_file_color_free(&read);
    else
        ki_note(report, KILN_NOTE_CONVERSION, false,
                "values were converted to linear Rec. 709 by the ICC profile \"%s\"", name);
    *color = read;
}
